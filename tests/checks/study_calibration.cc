#include <filesystem>

#include "check.h"
#include "folders.h"
#include "study_results.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Moduli of a rod of two materials from the frequencies of its modes in
     * closed form, Z_1 cot(omega L_1 / c_1) = Z_2 tan(omega L_2 / c_2) with the
     * impedances Z; they grow with the root of both moduli together.
     */
    class CalibrationOfRod : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"rod"}, communicator);
        const ParameterFile study = study_file(file, "study_rod", "rod");
        const auto          found = results_of(study, communicator);
        const auto         &lines = found.at("calibration").at("lines");
        verdicts.is_true("three numbers for each of two entries",
                         lines.size() == 6);
        std::array<double, 3> sums{};
        for (unsigned int i = 0; i < 6; ++i)
          {
            verdicts.is_true("found", lines.at(i).at("verdict") == "found");
            if (i % 3 == 0)
              verdicts.near(lines.at(i).at("number").get<std::string>() +
                              " [GPa]",
                            1e-9 * lines.at(i).at("found").get<double>(),
                            i == 0 ? 20. : 30.,
                            0.01);
            sums[i % 3] +=
              lines.at(i).at("change over that of the number").get<double>();
          }
        for (const double sum : sums)
          verdicts.near("change over that of both moduli", sum, 0.5, 0.01);

        // of a run beside the result
        const auto summary =
          read_summary(found.at("runs").back().at("folder").get<std::string>());
        const auto &shapes = summary.at("modes").at("measured shapes");
        const auto  shape  = [&](const std::string &name,
                               const unsigned int mode,
                               const double       criterion) {
          verdicts.is_true(name + ": mode", shapes.at(name).at("mode") == mode);
          verdicts.near("  modal assurance criterion",
                        shapes.at(name).at("modal assurance criterion [-]"),
                        criterion,
                        1e-3);
        };
        shape("lowest", 1, 1.);
        shape("next", 2, 1.);
        shape("third", 3, 1.);
        shape("coarse", 2, 0.999551);

        // one frequency for two moduli; and the second modulus of a material
        // that is not in the rod
        is_refused(study,
                   "Study/Calibration/Measured=modes/modes/0/frequency "
                   "[Hz] = 7.5",
                   verdicts,
                   communicator);
        is_refused(study,
                   "Study/Calibration/Fitted=Materials/sand/Density",
                   verdicts,
                   communicator);
        is_refused(study,
                   "Modes/Measured shapes=lowest: nowhere z 1",
                   verdicts,
                   communicator);

        // two moduli of the rock cannot be distinguished
        remove_folders({"alike"}, communicator);
        const auto alike =
          results_of(study.with({"Output/Folder=alike",
                                 "Study/Calibration/Fitted=Materials/rock/"
                                 "Density; Materials/rock/Young's modulus",
                                 "Mesh/box/Layers=rock",
                                 "Materials/Names=rock"}),
                     communicator);
        verdicts.is_true("density and modulus of a uniform rod",
                         alike.at("calibration")
                             .at("lines")
                             .at(0)
                             .at("verdict")
                             .get<std::string>()
                             .rfind("the measured numbers do not", 0) == 0);
      }

    private:
      static void
      is_refused(const ParameterFile &study,
                 const std::string   &change,
                 Verdicts            &verdicts,
                 const MPI_Comm       communicator)
      {
        bool refused = false;
        try
          {
            Study(study.with({change}), {}, communicator);
          }
        catch (const UserError &)
          {
            refused = true;
          }
        verdicts.is_true("refused: " + change, refused);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<CalibrationOfRod>
      registered("calibration of a rod",
                 "Moduli from frequencies and shapes in closed form.");
  } // namespace
} // namespace Voussoir
