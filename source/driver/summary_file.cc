#include <voussoir/driver/summary_file.h>

namespace Voussoir
{
  void
  write_summary(const std::string &folder,
                nlohmann::json     summary,
                const std::string &verdict,
                Log               &log)
  {
    const auto missing = log.missing_files();
    if (dealii::Utilities::MPI::this_mpi_process(log.communicator()) != 0)
      return;
    summary["verdict"]  = verdict;
    summary["warnings"] = log.warnings();
    if (!missing.empty())
      summary["files not written"] = missing;
    const std::string name = folder + "/summary.json";
    log.attempted(name, write_file(name, summary.dump(2) + '\n'));
  }
} // namespace Voussoir
