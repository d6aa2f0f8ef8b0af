#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A rigid block on a level plane that moves by a_x = A s along it and by
     * a_z = r A s upwards, with s = sin(2 pi (t - 0.1 s)): its safety against
     * sliding, as if it moved with the base, is
     *   f (g + a_z) / |a_x| ,
     * which passes through one where s = f g / (A (1 - f r)), and is least at
     * s = 1. The mobilised ratio of the contact forces is at most one.
     */
    class BlockDrivingSafety : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        compare("it stands", 0.6, 0., 0.6, file, verdicts, communicator);
        compare("once", 0.4, 0., 0.35, file, verdicts, communicator);
        compare("twice", 0.4, 0., 0.6, file, verdicts, communicator);
        compare("twice, with vertical motion",
                0.35,
                0.5,
                0.6,
                file,
                verdicts,
                communicator);
      }

    private:
      static void
      compare(const std::string   &name,
              const double         friction,
              const double         rise,
              const double         end,
              const ParameterFile &file,
              Verdicts            &verdicts,
              const MPI_Comm       communicator)
      {
        const auto parameters = make_case(file.with(
          {"Interfaces/plane/Friction coefficient=" + std::to_string(friction),
           "Constraints/base/Displacement=1, 0, " + std::to_string(rise),
           "Time/End time=" + std::to_string(end)}));
        make_simulation_with_files(*parameters, communicator)->run.march();
        const auto summary = read_summary(parameters->output.folder);
        const auto block   = summary.at("interfaces").at("blocks").at("block");

        constexpr double g = 9.81, A = 4.905;
        const double     least = friction * (g + rise * A) / A,
                     at_one    = friction * g / (A * (1. - friction * rise));
        verdicts.heading(name);
        verdicts.near("  smallest safety",
                      block.at("smallest safety"),
                      least,
                      0.02);
        const auto &driving = block.at("forces at the smallest safety [N]")
                                .at("driving, with inertia");
        constexpr double mass = 4000.;
        verdicts.near("  weight [MN]",
                      block.at("weight [MN]"),
                      1e-6 * mass * g,
                      1e-9);
        verdicts.near("  then driven along the plane by [N]",
                      driving.at(0),
                      -mass * A,
                      0.02);
        verdicts.near("  and upwards [N]",
                      driving.at(2),
                      -mass * (g + rise * A),
                      0.02);
        const CsvTable table(parameters->output.folder + "/interfaces.csv");
        const auto     times = table.numbers("time [s]");
        std::vector<double> safety; // an empty cell is infinite
        for (const std::string &text : table.texts("block block safety [-]"))
          safety.push_back(text.empty() ?
                             std::numeric_limits<double>::infinity() :
                             std::stod(text));
        std::vector<double> crossings;
        // the load is applied before 0.1 s; a line has the mean over the last
        // whole 8 ms, and is 4 to 12 ms later than their middle
        for (std::size_t i = 1; i < times.size(); ++i)
          if (times[i - 1] > 0.15 && (safety[i] < 1.) != (safety[i - 1] < 1.))
            crossings.push_back(times[i]);
        std::vector<double> expected;
        if (least < 1.)
          for (const double phase :
               {std::asin(at_one), numbers::PI - std::asin(at_one)})
            if (const double time = 0.1 + phase / (2. * numbers::PI);
                time < end)
              expected.push_back(time);
        verdicts.is_true("  so often through one",
                         crossings.size() == expected.size());
        for (std::size_t i = 0; i < std::min(crossings.size(), expected.size());
             ++i)
          verdicts.near("  at the time [s]", crossings[i], expected[i], 0.06);
        verdicts.near("  largest mobilised ratio",
                      block.at("largest mobilised ratio"),
                      std::min(1., 1. / least),
                      0.02);
        const auto &line =
          summary.at("engineering results").at("block: safety against sliding");
        verdicts.is_true(least < 1. ? "  it is to be judged" : "  that is met",
                         line.at("met") == (least < 1. ? nlohmann::json() :
                                                         nlohmann::json(true)));
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<BlockDrivingSafety>
      registered("block driving safety",
                 "A block on a shaken plane: driving force over resistance.");
  } // namespace
} // namespace Voussoir
