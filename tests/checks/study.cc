#include <voussoir/driver/study_statistics.h>

#include "folders.h"
#include "limit_files.h"
#include "study_results.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A search for a limit whose closed form is known. */
    class StudyLimit : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Case", name, "Of tests/data.");
        prm.add_parameter("Limit", limit, "In closed form.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"limit"}, communicator);
        const nlohmann::json found =
          results_of(study_file(file, name, "limit"), communicator)
            .at("limits");
        verdicts.is_true("one limit", found.size() == 1);
        const double fails = found.at(0).at("not met at"),
                     meets = found.at(0).at("met at");
        verdicts.near("middle of the bracket",
                      0.5 * (fails + meets),
                      limit,
                      0.01);
        verdicts.is_true("  which holds the limit",
                         fails <= limit && limit <= meets);
      }

    private:
      std::string name;
      double      limit = 0.;
    };


    /**
     * Settlement rho g H^2 / 2 E of columns of different stiffness and density;
     * only a missing run is repeated.
     */
    class StudyOfColumns : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"columns"}, communicator);
        const ParameterFile study =
          study_file(file, "study_columns", "columns");
        const auto        found  = results_of(study, communicator);
        const std::string number = "static state/stages/*/largest "
                                   "displacement [m]";
        verdicts.is_true("four runs", found.at("runs").size() == 4);
        for (const nlohmann::json &run : found.at("runs"))
          {
            const auto value = [&run](const std::string &entry) {
              return std::stod(run.at("values").at(entry).get<std::string>());
            };
            const double stiffness = value("Materials/stone/Young's modulus"),
                         density   = value("Materials/stone/Density");
            std::ostringstream name;
            name << "E = " << stiffness << " Pa, density " << density
                 << " kg/m3: settlement [m]";
            verdicts.near(name.str(),
                          run.at("quantities").at(number),
                          density * 9.81 * 100. / (2. * stiffness),
                          1e-6);
          }

        const std::string lost = found.at("runs").at(1).at("folder"),
                          kept = found.at("runs").at(2).at("folder");
        const auto age =
          std::filesystem::last_write_time(kept + "/summary.json");
        remove_folders({lost + ".json"}, communicator);
        remove_folders({lost}, communicator);
        verdicts.is_true("again: the same results",
                         results_of(study, communicator) == found);
        verdicts.is_true("  the missing run is there",
                         std::filesystem::exists(lost + "/summary.json"));
        verdicts.is_true("  others were not done again",
                         std::filesystem::last_write_time(
                           kept + "/summary.json") == age);
      }
    };

    /** Runs, the second of which has no static equilibrium, and then runs none
     *  of which has one. */
    class FailingRun : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"failing"}, communicator);
        const ParameterFile study =
          study_file(file, "study_slope", "failing")
            .with({"Study/Limit/Entry=",
                   "Study/Vary=Interfaces/plane/Friction coefficient = 0.5, "
                   "0.1, 0.8",
                   "Study/Quantities=interfaces/surfaces/plane/residual slip "
                   "[mm]"});
        std::string end = "done";
        try
          {
            results_of(study, communicator);
          }
        catch (const IncompleteStudy &error)
          {
            end = error.what();
          }
        verdicts.is_true("of which two are complete, and one was stopped",
                         end.find(
                           "Of 3 runs in \"failing\" 2 are complete, 1 was "
                           "stopped, 0 failed") == 0);
        MPI_Barrier(communicator);
        const nlohmann::json runs = study_json("failing").at("runs");
        verdicts.is_true("three runs", runs.size() == 3);
        for (unsigned int i = 0; i < 3; ++i)
          {
            const bool        slides  = i == 1; // the slope has tan = 0.25
            const std::string verdict = runs.at(i).at("verdict");
            verdicts.is_true(slides ? "the second is reported as stopped" :
                                      "another is complete",
                             (verdict.rfind("stopped: ", 0) == 0) == slides);
            verdicts.is_true("  and has its number or none",
                             runs.at(i).contains("quantities") != slides);
          }
        const auto summary = [&](const unsigned int run) {
          return read_summary(runs.at(run).at("folder"));
        };
        for (const std::string number : {"unknowns", "cells", "time step [s]"})
          verdicts.is_true("  its summary has the " + number,
                           summary(1).at(number) == summary(0).at(number));

        remove_folders({"failing"}, communicator);
        bool refused = false;
        try
          {
            results_of(study.with({"Study/Vary=Interfaces/plane/Friction "
                                   "coefficient = 0.1, 0.05"}),
                       communicator);
          }
        catch (const UserError &)
          {
            refused = true;
          }
        verdicts.is_true("a study without a complete run ends with an error",
                         refused &&
                           std::filesystem::exists("failing/study.json"));
      }
    };


    /**
     * Searches for the limit at which a run is "stopped", for which a mistake
     * in the file and a full disk do not count, and for another limit by a run
     * that is stopped before it.
     */
    class FailedLimit : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const ParameterFile slope = study_file(file, "study_slope", "no_limit"),
                            block =
                              study_file(file, "study_shaken_block", "no_limit")
                                .with({"Study/Limit/Criterion=stopped"});
        const std::string mistake =
          end_of(block.with({"Loads/weight/Face sets=nowhere"}), communicator);
        verdicts.is_true("a mistake in the file: failed",
                         holds(mistake, "failed: ") &&
                           holds(mistake, "nowhere") && !has_limits());
        const std::string disk =
          end_of(block.with(
                   {"Output/Observers=interfaces, histories, full disk",
                    "Output/histories/Points=top: 1 1 1",
                    "Output/histories/Interval=1e-4",
                    "Output/full disk/From=0.1",
                    "Output/full disk/To=9",
                    "Output/full disk/Size=60000"}),
                 communicator);
        verdicts.is_true("a full disk: failed",
                         holds(disk, "failed: ") && holds(disk, "written") &&
                           !has_limits());
        const std::string other =
          end_of(slope.with({"Study/Limit/Criterion=interfaces/surfaces/plane/"
                             "largest slip [mm] > 1e6",
                             "Study/Limit/To=3"}),
                 communicator);
        verdicts.is_true("stopped before another criterion was met: said",
                         holds(other, "stopped: ") &&
                           holds(other, "is unknown") && !has_limits());

        const std::string one_of_two =
          end_of(slope.with(
                   {"Study/Limit/Entry=",
                    "Study/Vary=Interfaces/plane/Friction coefficient = 0.5, "
                    "0.8 & Loads/weight/Cell sets = block, nowhere"}),
                 communicator);
        verdicts.is_true(
          "one of two runs fails: an error, and the other's line",
          holds(one_of_two, "1 is complete, 0 were stopped, 1 failed") &&
            lines_of("no_limit/study.csv") == 3);
      }

    private:
      /** How a study ends. */
      static std::string
      end_of(const ParameterFile &file, const MPI_Comm communicator)
      {
        remove_folders({"no_limit"}, communicator);
        std::string end = "done";
        try
          {
            results_of(file, communicator);
          }
        catch (const UserError &error)
          {
            end = error.what();
          }
        limit_files(RLIM_INFINITY);
        return end;
      }

      static bool
      holds(const std::string &text, const std::string &part)
      {
        return text.find(part) != std::string::npos;
      }

      static bool
      has_limits()
      {
        std::ifstream in("no_limit/study.json");
        return in && nlohmann::json::parse(in).contains("limits");
      }

      static unsigned int
      lines_of(const std::string &name)
      {
        std::ifstream in(name);
        std::string   line;
        unsigned int  n = 0;
        while (std::getline(in, line))
          ++n;
        return n;
      }
    };


    /** Mean and spread, in closed form, and of the settlements rho g H^2 / 2 E
     *  of columns with densities of 2000, 2400 and 3100 kg/m3. */
    class StudyStatistics : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // of four runs one ended early and lies beyond all others
        const Statistics some({1., 2., {}, 4.},
                              std::numeric_limits<double>::infinity());
        verdicts.near("mean of 1, 2, 4", some.mean.value(), 7. / 3., 1e-12);
        verdicts.near("  standard deviation",
                      some.deviation.value(),
                      std::sqrt(7. / 3.),
                      1e-12);
        verdicts.near("  16 % of these and infinity",
                      some.fractiles[0].value(),
                      1.48,
                      1e-12);
        verdicts.near("  median", some.fractiles[1].value(), 3., 1e-12);
        verdicts.is_true("  84 %: not finite", !some.fractiles[2]);

        remove_folders({"spread"}, communicator);
        results_of(study_file(file, "study_columns", "spread")
                     .with({"Study/Vary=Materials/stone/Density = 2000, 2400, "
                            "3100 ; Materials/stone/Young's modulus = 1e9, 4e9",
                            "Study/Spread over=Materials/stone/Density"}),
                   communicator);
        std::ifstream in("spread/study_statistics.csv");
        std::string   line;
        std::getline(in, line);
        verdicts.is_true("heading",
                         line == "Materials/stone/Young's modulus,quantity,"
                                 "runs,ended early,mean,standard deviation,"
                                 "16 %,median,84 %");
        for (const double stiffness : {1e9, 4e9})
          {
            std::getline(in, line);
            const auto   columns = split_list(line);
            const double unit    = 9.81 * 100. / (2. * stiffness);
            verdicts.near("E [Pa]", std::stod(columns.at(0)), stiffness, 1e-12);
            verdicts.near("  mean [m]",
                          std::stod(columns.at(4)),
                          2500. * unit,
                          1e-5);
            // of -500, -100, 600
            verdicts.near("  standard deviation [m]",
                          std::stod(columns.at(5)),
                          std::sqrt(310000.) * unit,
                          1e-5);
            verdicts.near("  16 % [m]",
                          std::stod(columns.at(6)),
                          2128. * unit,
                          1e-5);
            verdicts.near("  84 % [m]",
                          std::stod(columns.at(8)),
                          2876. * unit,
                          1e-5);
          }
      }
    };

    /**
     * A strength reduction by F: cohesion c / F, of an angle of friction
     * atan(tan(phi) / F); strengths that it leaves unchanged are named.
     */
    class StudyOfStrengths : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"strengths"}, communicator);
        const auto found =
          results_of(study_file(file, "study_strengths", "strengths"),
                     communicator);
        for (const nlohmann::json &run : found.at("runs"))
          {
            const std::string divisor =
              run.at("values").at("strength reduction").get<std::string>();
            const double        F = std::stod(divisor);
            const ParameterFile as_run(run.at("folder").get<std::string>() +
                                       "/parameters.prm");
            const auto          value = [&](const std::string &entry) {
              return std::stod(as_run.given("Materials/rock/" + entry));
            };
            verdicts.near("F = " + divisor + ": cohesion [Pa]",
                          value("Cohesion"),
                          1.2e6 / F,
                          1e-5);
            verdicts.near("  tangent of the friction angle",
                          std::tan(value("Friction angle") * numbers::PI /
                                   180.),
                          std::tan(40. * numbers::PI / 180.) / F,
                          1e-5);
            verdicts.near("  tension cut-off [Pa], left as it is",
                          value("Tension cut-off"),
                          6e5,
                          1e-12);
          }
        const nlohmann::json &said = found.at("strength reduction");
        verdicts.is_true("two are said to be divided",
                         said.at("divides") ==
                           nlohmann::json({"Materials/rock/Cohesion",
                                           "Materials/rock/Friction angle"}));
        verdicts.is_true("the rest is said to be left",
                         said.at("leaves as they are") ==
                           nlohmann::json(
                             {"Materials/rock/Tension cut-off = 600000"}));
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<StudyOfStrengths>
      strengths("study of strengths",
                "Strengths that a reduction divides and leaves.");
    // Reference: Voussoir
    const Registry<Check>::Add<FailingRun> failing("study with a failing run",
                                                   "One run that slides away.");
    // Reference: Voussoir
    const Registry<Check>::Add<FailedLimit>
      failed_limit("study of failed runs",
                   "Runs that fail meet no criterion of a limit.");
    // Reference: closed form
    const Registry<Check>::Add<StudyStatistics>
      statistics("study statistics", "Mean and spread over varied entries.");
    // Reference: closed form
    const Registry<Check>::Add<StudyLimit>
      limit("study limit", "A limit that is known in closed form.");
    // Reference: closed form
    const Registry<Check>::Add<StudyOfColumns>
      columns("study of columns", "Crossed values, and a study resumed.");
  } // namespace
} // namespace Voussoir
