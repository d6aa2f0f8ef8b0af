#include <voussoir/driver/study.h>

#include <filesystem>
#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The case of a test, which is a file of its own beside it. */
    ParameterFile
    study_file(const ParameterFile &file,
               const std::string   &name,
               const std::string   &folder)
    {
      return ParameterFile(file.folder() + "/../data/" + name + ".prm",
                           {"Output/Folder=" + folder});
    }


    nlohmann::json
    results_of(const ParameterFile &file, const MPI_Comm communicator)
    {
      RunOptions options;
      options.quiet = true;
      Study(file, options, communicator).run();
      MPI_Barrier(communicator);
      std::ifstream in(file.given("Output/Folder") + "/study.json");
      return nlohmann::json::parse(in);
    }


    void
    remove(const std::string &name, const MPI_Comm communicator)
    {
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        std::filesystem::remove_all(name);
      MPI_Barrier(communicator);
    }


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
        remove("limit", communicator);
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
        verdicts.above("  its upper end over the limit", meets / limit, 1.);
        verdicts.above("  the limit over its lower end", limit / fails, 1.);
      }

    private:
      std::string name;
      double      limit = 0.;
    };


    /**
     * Settlement rho g H^2 / 2 E of columns of other stiffness and density; a
     * run that is missing is done again, and no other one.
     */
    class StudyOfColumns : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove("columns", communicator);
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
        remove(lost + ".json", communicator);
        remove(lost, communicator);
        verdicts.is_true("again: the same results",
                         results_of(study, communicator) == found);
        verdicts.is_true("  the missing run is there",
                         std::filesystem::exists(lost + "/summary.json"));
        verdicts.is_true("  others were not done again",
                         std::filesystem::last_write_time(
                           kept + "/summary.json") == age);
      }
    };

    const Registry<Check>::Add<StudyLimit>
      limit("study limit", "A limit that is known in closed form.");
    const Registry<Check>::Add<StudyOfColumns>
      columns("study of columns", "Crossed values, and a study resumed.");
  } // namespace
} // namespace Voussoir
