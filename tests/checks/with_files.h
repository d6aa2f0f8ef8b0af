#ifndef voussoir_tests_with_files_h
#define voussoir_tests_with_files_h

#include <voussoir/base/parameter_file.h>

#include <filesystem>
#include <fstream>

#include "check.h"

namespace Voussoir
{
  /** A silent simulation that writes its files anew into the folder of the
   *  case. */
  inline std::unique_ptr<Simulation>
  make_simulation_with_files(const Case    &parameters,
                             const MPI_Comm communicator)
  {
    RunOptions options;
    options.quiet     = true;
    options.overwrite = true;
    return std::make_unique<Simulation>(parameters, options, communicator);
  }


  /** summary.json of a run; null if there is none. */
  inline nlohmann::json
  read_summary(const std::string &folder)
  {
    std::ifstream  file(folder + "/summary.json");
    nlohmann::json summary;
    if (file)
      file >> summary;
    return summary;
  }


  /** Runs the case with this change, with its files in this folder; returns the
   *  warnings of its summary. */
  inline nlohmann::json
  warnings_of(const ParameterFile &file,
              const std::string   &change,
              const std::string   &folder,
              const MPI_Comm       communicator)
  {
    const auto parameters =
      make_case(file.with({"Output/Folder=" + folder, change}));
    make_simulation_with_files(*parameters, communicator)->run.march();
    return read_summary(folder).at("warnings");
  }


  /** The time that a warning names [s]. */
  inline double
  time_in(const std::string &warning)
  {
    return std::stod(warning.substr(warning.find("t = ") + 4));
  }


  /** A case of prm/, changed; @p changes are "Section/Entry=value" separated by
   *  ";", @p file is that of the test. */
  inline ParameterFile
  shipped_file(const ParameterFile &file,
               const std::string   &name,
               const std::string   &changes,
               const std::string   &folder)
  {
    auto list = split_list(changes, ';');
    list.push_back("Output/Folder=" +
                   (std::filesystem::current_path() / folder).string());
    return ParameterFile(file.folder() + "/../../prm/" + name + ".prm", list);
  }
} // namespace Voussoir

#endif
