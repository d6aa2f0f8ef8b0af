#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>

#include "check.h"
#include "cylinder_dam.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The dam of CylinderDam in coarse cells that are refined: where the new
     * nodes lie. With a wedge in the left bank also those on its base plane,
     * which by the wedge's entries passes through a point of the bank on the
     * dam's middle surface; joints beside a wedge have other places.
     */
    class CurvedRefinement : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of the dam's volume.");
        prm.add_parameter("Elevation", elevation, "Of a wedge [m].");
        prm.add_parameter("Dip", dip, "Of its base plane [degrees].");
        prm.add_parameter("Dip direction", direction, "[degrees]");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        const Grid &grid       = simulation->model.grid;

        find_hanging(grid);
        double of_faces = 0., of_joints = 0., of_canyon = 0., of_crest = 0.,
               of_base = 0.;
        for_each_node(grid, "downstream face", [&](const Point<3> &x) {
          keep_largest(of_faces, std::abs(radius(x) - 115.));
        });
        for_each_node(grid, "upstream face", [&](const Point<3> &x) {
          keep_largest(of_faces, std::abs(radius(x) - 125.));
        });
        // four blocks of equal length
        const double right = -std::asin(100. / 120.),
                     left  = std::asin(80. / 120.);
        for (const unsigned int joint : {1, 2, 3})
          for_each_node(
            grid, "joint " + std::to_string(joint), [&](const Point<3> &x) {
              keep_largest(of_joints,
                           120. * std::abs(angle(x) - right -
                                           0.25 * joint * (left - right)));
            });
        for_each_node(grid, "dam-rock interface", [&](const Point<3> &x) {
          const double width = 120. * std::abs(std::sin(angle(x)));
          const double z = 100. * (width - 20.) / (angle(x) < 0. ? 80. : 60.);
          keep_largest(of_canyon, std::abs(std::max(z, 0.) - x[2]));
        });
        for_each_node(grid, "crest", [&](const Point<3> &x) {
          keep_largest(of_crest, std::abs(x[2] - 100.));
        });
        const bool has_wedge = elevation > 0.;
        if (has_wedge)
          for_each_node(grid, "left wedge base", [&](const Point<3> &x) {
            keep_largest(of_base, std::abs(base_plane() * (x - foot())));
          });
        const auto largest = [&](const double value) {
          return Utilities::MPI::max(value, communicator);
        };
        verdicts.below("nodes from the dam's faces [m]",
                       largest(of_faces),
                       1e-9);
        if (has_wedge)
          verdicts.below("from the base plane of its wedge [m]",
                         largest(of_base),
                         1e-6);
        else
          verdicts.below("from the planes of its joints [m]",
                         largest(of_joints),
                         1e-9);
        verdicts.below("from its crest [m]", largest(of_crest), 1e-9);
        // the elevation is found to 1e-9 of the dam's height
        verdicts.below("from the canyon [m]", largest(of_canyon), 1e-6);
        verdicts.below(
          "hanging nodes from the middle of their edge or face [m]",
          largest(of_hanging),
          1e-9);

        verdicts.near(
          "volume", volume(grid), CylinderDam::volume(), tolerance, "m3");
      }

    private:
      static double
      radius(const Point<3> &x)
      {
        return std::hypot(x[0], x[1] - CylinderDam::centre);
      }


      static double
      angle(const Point<3> &x)
      {
        return std::atan2(x[0], x[1] - CylinderDam::centre);
      }


      /** Normal of the base plane. */
      Tensor<1, 3>
      base_plane() const
      {
        const double radians = numbers::PI / 180.;
        return Tensor<1, 3>(
          {-std::sin(dip * radians) * std::cos(direction * radians),
           -std::sin(dip * radians) * std::sin(direction * radians),
           std::cos(dip * radians)});
      }


      /** Where the base plane meets the bank on the middle surface. */
      Point<3>
      foot() const
      {
        const double x = 20. + 60. * elevation / 100.;
        return Point<3>(x,
                        CylinderDam::centre + std::sqrt(120. * 120. - x * x),
                        elevation);
      }


      void
      find_hanging(const Grid &grid)
      {
        const auto add = [&](const auto &parent, const unsigned int v) {
          if (!parent->has_children())
            return;
          Point<3> middle;
          for (const unsigned int i : parent->vertex_indices())
            middle += parent->vertex(i) / double(parent->n_vertices());
          hanging.insert(parent->child(0)->vertex_index(v));
          keep_largest(of_hanging,
                       middle.distance(parent->child(0)->vertex(v)));
        };
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (!cell->is_artificial())
            {
              for (const unsigned int line : cell->line_indices())
                add(cell->line(line), 1);
              for (const unsigned int face : cell->face_indices())
                add(cell->face(face), 3);
            }
      }


      /** All nodes but hanging ones. */
      void
      for_each_node(const Grid                                  &grid,
                    const std::string                           &face_set,
                    const std::function<void(const Point<3> &)> &visit) const
      {
        grid.for_each_face(face_set, [&](const auto &cell, const auto face) {
          for (const unsigned int v : cell->face(face)->vertex_indices())
            if (hanging.count(cell->face(face)->vertex_index(v)) == 0)
              visit(cell->face(face)->vertex(v));
        });
      }


      /** Volume by 2 x 2 x 2 points, exact for trilinear cells. */
      static double
      volume(const Grid &grid)
      {
        const FE_Nothing<3> none;
        const QGauss<3>     gauss(2);
        FEValues<3>         values(none, gauss, update_JxW_values);
        const auto          is_dam = grid.tags_in({"dam"});
        double              sum    = 0.;
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned() && is_dam[cell->material_id()])
            {
              values.reinit(static_cast<Triangulation<3>::cell_iterator>(cell));
              for (const unsigned int q : values.quadrature_point_indices())
                sum += values.JxW(q);
            }
        return Utilities::MPI::sum(sum, grid.communicator());
      }

      double                 tolerance = 0., of_hanging = 0.;
      double                 elevation = 0., dip = 0., direction = 0.;
      std::set<unsigned int> hanging;
    };

    // Reference: closed form
    const Registry<Check>::Add<CurvedRefinement>
      registered("curved refinement", "Nodes of a refined arch dam.");
  } // namespace
} // namespace Voussoir
