#ifndef voussoir_tests_study_results_h
#define voussoir_tests_study_results_h

#include <voussoir/driver/study.h>

#include <fstream>

namespace Voussoir
{
  /** The case of a test, a separate file beside that of the test. */
  inline ParameterFile
  study_file(const ParameterFile &file,
             const std::string   &name,
             const std::string   &folder)
  {
    return ParameterFile(file.folder() + "/../data/" + name + ".prm",
                         {"Output/Folder=" + folder});
  }


  inline nlohmann::json
  study_json(const std::string &folder)
  {
    std::ifstream in(folder + "/study.json");
    return nlohmann::json::parse(in);
  }


  inline nlohmann::json
  results_of(const ParameterFile &file, const MPI_Comm communicator)
  {
    RunOptions options;
    options.quiet = true;
    Study(file, options, communicator).run();
    MPI_Barrier(communicator);
    return study_json(file.given("Output/Folder"));
  }
} // namespace Voussoir

#endif
