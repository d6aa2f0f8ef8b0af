#include <voussoir/base/error.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/kept_states.h>
#include <voussoir/driver/stored_static_state.h>
#include <voussoir/files/state_file.h>

#include <filesystem>

namespace Voussoir
{
  namespace fs = std::filesystem;

  KeptStates::KeptStates(const Model        &model,
                         const ResultFolder &folder,
                         Log                &log)
    : model(model)
    , log(log)
  {
    const std::string &kept = model.parameters.static_state.kept;
    if (!folder.exists() || kept.empty())
      return;
    identity = static_identity_of(model.parameters);
    file     = fs::path(folder.path()).parent_path() / kept /
           (checksum(identity.dump()) + ".h5");
  }


  std::optional<StaticState>
  KeptStates::find() const
  {
    if (file.empty() || !damage_of_state(file, log.communicator()).empty() ||
        read_state_header(file, log.communicator()).at("identity") != identity)
      return {};
    log.line("Static state taken from ",
             file,
             ", where a run with the same mesh, materials, interfaces, "
             "boundaries and static loads has kept it");
    return read_static_state(model, file);
  }


  void
  KeptStates::keep(const StaticState &static_state) const
  {
    if (file.empty())
      return;
    const bool first =
      dealii::Utilities::MPI::this_mpi_process(log.communicator()) == 0;
    std::error_code ignored;
    FileLock        lock;
    bool            mine = true;
    if (first)
      {
        fs::create_directories(fs::path(file).parent_path(), ignored);
        mine = lock.take(file + ".lock");
        if (mine)
          remove_unfinished(fs::path(file).parent_path(),
                            fs::path(file).filename());
      }
    if (!dealii::Utilities::MPI::broadcast(log.communicator(), mine))
      return;
    try
      {
        store_static_state(model, static_state, file, identity);
        log.line("Static state kept in ", file, " for later runs");
      }
    catch (const UserError &error)
      {
        log.warn("the static state is not kept for later runs: ", error.what());
      }
    if (first)
      fs::remove(file + ".lock", ignored);
  }
} // namespace Voussoir
