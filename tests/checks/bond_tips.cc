#include "contact_sums.h"
#include "crack_line.h"
#include "slice_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double width = 99., height = 207., slit = 18.; // [m]


    /** A plate, one cell of size h thick, with a slit from its left side at
     *  half its height; the face sets "slit" and "ligament" cut it in two. */
    void
    write_plate(const std::string &name, const double h)
    {
      const unsigned int columns = std::lround(width / h),
                         rows    = 2 * std::lround(0.5 * height / h);
      SliceMesh mesh(columns, rows);
      for (unsigned int j = 0; j < rows; ++j)
        for (unsigned int i = 0; i < columns; ++i)
          {
            mesh.add_cell(1, i, j);
            mesh.add_side(4, i, j, 0);
          }
      for (unsigned int i = 0; i < columns; ++i)
        {
          mesh.add_level(2, i, 0);
          mesh.add_level(3, i, rows);
          mesh.add_level((i + 0.5) * h < slit ? 5 : 6, i, rows / 2);
        }
      mesh.write(name,
                 {{3, "plate"},
                  {2, "bottom"},
                  {2, "top"},
                  {2, "side"},
                  {2, "slit"},
                  {2, "ligament"}},
                 h,
                 [&](const unsigned int i, const unsigned int j) {
                   return std::pair{i * h, j * height / rows};
                 });
    }


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
        // by "tests/data/notched_plate_reference.py linear" with elements of
        // 0.25 and 0.125 m
        constexpr double fictitious_crack = 0.401e6, fracture_energy = 350.;
        for (const double h : sizes)
          {
            std::ostringstream size;
            size << ", cells of " << h << " m";
            const std::string mesh =
              std::filesystem::current_path() / ("bond" + size.str() + ".msh");
            if (Utilities::MPI::this_mpi_process(communicator) == 0)
              write_plate(mesh, h);
            MPI_Barrier(communicator);
            const auto parameters =
              make_case(file.with({"Mesh/file/File=" + mesh}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Pull pull       = march_under_pull(*simulation, 0.05);
            constexpr unsigned int ligament = 1; // surface
            verdicts.near("stress at which the crack runs" + size.str(),
                          1e-6 * pull.largest / (width * h),
                          1e-6 * fictitious_crack,
                          0.08,
                          "MPa");
            verdicts.near("energy of the bond per area" + size.str(),
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
  } // namespace
} // namespace Voussoir
