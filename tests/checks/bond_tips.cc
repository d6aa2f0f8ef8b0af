#include "contact_sums.h"
#include "crack_line.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double width = 99., height = 207., slit = 18.; // [m]


    /**
     * A plate, one cell of size h thick, with a slit from its left side at half
     * its height; the face sets "slit" and "ligament" cut it in two.
     *
     * @param head [m] above it, of another material and with face sets at its
     *   ends; 0: none
     */
    void
    write_plate(const std::string &name, const double h, const double head)
    {
      const unsigned int columns = std::lround(width / h),
                         rows    = 2 * std::lround(0.5 * height / h),
                         all     = rows + std::lround(head / h);
      SliceMesh mesh(columns, all);
      for (unsigned int j = 0; j < all; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          {
            mesh.add_cell(j < rows ? 1 : 7, i, j);
            mesh.add_side(4, i, j, 0);
          }
      mesh.add_ends(8, rows);
      mesh.add_bottom_and_top(2, 3);
      for (unsigned int i = 0; i < columns; ++i)
        mesh.add_level((i + 0.5) * h < slit ? 5 : 6, i, rows / 2);
      mesh.write(name,
                 {{3, "plate"},
                  {2, "bottom"},
                  {2, "top"},
                  {2, "side"},
                  {2, "slit"},
                  {2, "ligament"},
                  {3, "head"},
                  {2, "ends"}},
                 h,
                 [&](const unsigned int i, const unsigned int j) {
                   return std::pair{i * h, j * height / rows};
                 });
    }


    std::string
    size_text(const double h)
    {
      std::ostringstream text;
      text << ", cells of " << h << " m";
      return text.str();
    }


    /** Writes a plate in the current folder and returns the entry that reads
     *  it. */
    std::string
    entry_of_plate(const double   h,
                   const double   head,
                   const MPI_Comm communicator)
    {
      return entry_of_mesh(
        "bond" + size_text(h) + ".msh",
        [&](const std::string &name) { write_plate(name, h, head); },
        communicator);
    }


    // by "tests/data/notched_plate_reference.py linear" with elements of 0.25
    // and 0.125 m [MPa]
    constexpr double fictitious_crack = 0.401;


    /** The stress at which a crack runs along an interface from a slit, in
     *  cells of several times E Gf / ft^2. */
    class BondTips : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Sizes", sizes, "Of the cells [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double fracture_energy = 350.;
        for (const double h : sizes)
          {
            const auto parameters =
              make_case(file.with({entry_of_plate(h, 0., communicator)}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Pull pull       = march_under_pull(*simulation, 0.05);
            constexpr unsigned int ligament = 1; // surface
            verdicts.near("stress at which the crack runs" + size_text(h),
                          1e-6 * pull.largest / (width * h),
                          fictitious_crack,
                          0.08,
                          "MPa");
            verdicts.near("energy of the bond per area" + size_text(h),
                          contact_sums(*simulation, ligament).bond_work /
                            (h * (width - slit)),
                          fracture_energy,
                          0.1,
                          "J/m2");
          }
      }

    private:
      std::vector<double> sizes = {9., 4.5, 3.};
    };

    // Reference: other program
    const Registry<Check>::Add<BondTips>
      registered("bond tips",
                 "Crack that runs along an interface from a slit.");


    /** The same in the static state, under a force on a stiff head. */
    class BondTipsAtRest : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Sizes", sizes, "Of the cells [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        constexpr double head = 9.;                      // [m]
        constexpr double step = 0.02 * fictitious_crack; // [MPa]
        for (const double h : sizes)
          verdicts.near(
            "largest stress in equilibrium" + size_text(h),
            largest_standing_pull(file,
                                  entry_of_plate(h, head, communicator),
                                  0.9 * fictitious_crack,
                                  step,
                                  communicator),
            fictitious_crack,
            0.08,
            "MPa");
      }

    private:
      std::vector<double> sizes = {9., 4.5, 3.};
    };

    // Reference: other program
    const Registry<Check>::Add<BondTipsAtRest> registered_at_rest(
      "bond tips at rest",
      "Crack that runs along an interface from a slit in the static state.");
  } // namespace
} // namespace Voussoir
