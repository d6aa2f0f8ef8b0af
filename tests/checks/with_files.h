#ifndef voussoir_tests_with_files_h
#define voussoir_tests_with_files_h

#include <fstream>

#include "check.h"

namespace Voussoir
{
  /** A silent simulation that writes its files anew into the folder of the
   *  case. */
  inline std::unique_ptr<Simulation>
  make_simulation_with_files(Case &parameters, const MPI_Comm communicator)
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
} // namespace Voussoir

#endif
