#include <voussoir/fem/notches.h>

#include "check.h"
#include "crack_line.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double width = 99., height = 207., depth = 18., head = 9.; // [m]

    enum class Shape
    {
      slit,
      corner,
      vee
    };


    std::string
    name_of(const Shape shape)
    {
      return shape == Shape::slit   ? "slit" :
             shape == Shape::corner ? "corner" :
                                      "V-shaped notch";
    }


    /** The left side at an elevation, that of a V whose solid fills 225 degrees
     *  [m]. */
    double
    left_side(const double z)
    {
      return std::max(0.,
                      depth - std::abs(z - 108.) *
                                std::tan(22.5 * numbers::PI / 180.));
    }


    /** Elevation of the lower side of a slit or of the lower edge of a notch
     *  27 m high, whose upper edge is the second number [m]. */
    std::pair<double, double>
    edges_of(const Shape shape)
    {
      return shape == Shape::slit ? std::pair{108., 108.} :
                                    std::pair{90., 117.};
    }


    /** Writes a plate, one cell of size h thick, with a notch from its left
     *  side and a head of another material, whose ends are face sets. */
    void
    write_plate(const std::string &name, const Shape shape, const double h)
    {
      const unsigned int columns = std::lround(width / h),
                         rows    = std::lround(height / h),
                         all     = std::lround((height + head) / h),
                         inside  = std::lround(depth / h);
      const auto [lower, upper]  = edges_of(shape);
      SliceMesh mesh(columns, all);
      if (shape == Shape::slit)
        mesh.cut(inside, std::lround(lower / h));
      for (unsigned int j = 0; j < all; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          if (shape == Shape::vee || i >= inside || (j + 0.5) * h < lower ||
              (j + 0.5) * h > upper)
            {
              mesh.add_cell(j < rows ? 1 : 2, i, j);
              mesh.add_side(3, i, j, 0);
            }
      mesh.add_ends(4, rows);
      mesh.add_bottom_and_top(5, 6);
      mesh.write(name,
                 {{3, "plate"},
                  {3, "head"},
                  {2, "side"},
                  {2, "ends"},
                  {2, "bottom"},
                  {2, "top"}},
                 h,
                 [&](const unsigned int i, const unsigned int j) {
                   const double left =
                     shape == Shape::vee ? left_side(j * h) : 0.;
                   return std::pair{left + i * (width - left) / columns, j * h};
                 });
    }


    /** The stress at which a first crack begins at a slit, at a corner of 270
     *  degrees and at a V whose solid fills 225 degrees, in the static state or
     *  under a slow pull. */
    class Notches : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Sizes", sizes, "Of the cells [m].");
        prm.add_parameter("Slit",
                          slit,
                          "Allowed error at the slit; 0: it is left out.");
        prm.add_parameter("At rest", at_rest, "Under a force, without motion.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // roots of sin(k w) + k sin(w) = 0: Williams 1952
        constexpr double degree = numbers::PI / 180.;
        verdicts.near("order of the singularity at 270 degrees",
                      order_of_singularity(270. * degree),
                      0.4555163,
                      1e-6);
        verdicts.near("order of the singularity at 225 degrees",
                      order_of_singularity(225. * degree),
                      0.3264168,
                      1e-6);
        verdicts.near("order of the singularity at a slit",
                      order_of_singularity(360. * degree),
                      0.5,
                      1e-12);
        verdicts.below("order of the singularity on a flat face",
                       order_of_singularity(180. * degree),
                       1e-12);

        refine_one_side(file, verdicts, communicator);

        // by tests/data/plate_corner_reference.py
        for (const double h : sizes)
          {
            if (slit > 0.)
              find(file, Shape::slit, h, 0.378, slit, verdicts, communicator);
            find(file, Shape::corner, h, 0.559, 0.12, verdicts, communicator);
            find(file, Shape::vee, h, 0.474, 0.12, verdicts, communicator);
          }
      }

    private:
      /** Angles are the same where edges hang, in coarse cells and fine ones.
       */
      static void
      refine_one_side(const ParameterFile &file,
                      Verdicts            &verdicts,
                      const MPI_Comm       communicator)
      {
        const std::string entry = entry_of_mesh(
          "plate, refined at one side of a corner.msh",
          [](const std::string &mesh) { write_plate(mesh, Shape::corner, 9.); },
          communicator);
        const auto   parameters  = make_case(file.with(
          {entry, "Mesh/Local refinement=box 18 -9 117 27 18 126: 1"}));
        const auto   simulation  = make_simulation(*parameters, communicator);
        unsigned int found       = 0;
        double       error       = 0.;
        bool         into_a_cell = true;
        for (const Notch &at : notches_of_cells(simulation->model.grid))
          if (at.angle > 0.)
            {
              ++found;
              into_a_cell = into_a_cell && !at.is_between_cells;
              keep_largest(error,
                           std::abs(at.angle / (1.5 * numbers::PI) - 1.));
            }
        verdicts.is_true("they point into a cell",
                         Utilities::MPI::min(int(into_a_cell), communicator) ==
                           1);
        // three at the lower corner, four at the upper one
        verdicts.near("cells at two corners, one with hanging edges",
                      Utilities::MPI::sum(found, communicator),
                      7.,
                      1e-12);
        verdicts.below("angle at them: error",
                       Utilities::MPI::max(error, communicator),
                       1e-8);
      }

      void
      find(const ParameterFile &file,
           const Shape          shape,
           const double         h,
           const double         reference,
           const double         allowed,
           Verdicts            &verdicts,
           const MPI_Comm       communicator) const
      {
        std::ostringstream name;
        name << "first crack at a " << name_of(shape) << ", cells of " << h
             << " m";
        const std::string entry = entry_of_mesh(
          "plate, " + name.str() + ".msh",
          [&](const std::string &mesh) { write_plate(mesh, shape, h); },
          communicator);
        double stress = 0.;
        if (at_rest)
          stress = largest_standing_pull(
            file, entry, 0.8 * reference, 0.04 * reference, communicator);
        else
          {
            const auto parameters = make_case(file.with({entry}));
            const auto simulation = make_simulation(*parameters, communicator);
            stress =
              1e-6 * march_under_pull(*simulation, 0.05).largest / (width * h);
          }
        verdicts.near(name.str(), stress, reference, allowed, "MPa");
      }

      std::vector<double> sizes   = {9., 3.};
      double              slit    = 0.12;
      bool                at_rest = false;
    };

    // Reference: other program
    const Registry<Check>::Add<Notches>
      registered("notches", "First crack at a slit, a corner and a V.");
  } // namespace
} // namespace Voussoir
