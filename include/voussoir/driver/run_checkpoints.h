#ifndef voussoir_driver_run_checkpoints_h
#define voussoir_driver_run_checkpoints_h

#include <voussoir/driver/run_setup.h>
#include <voussoir/output/checkpoint.h>
#include <voussoir/output/energy.h>

namespace Voussoir
{
  /** Writes and reads the checkpoints of a run. */
  class RunCheckpoints
  {
  public:
    /** @param setup,folder,contact,log must live as long as this
     *  @param contact null without interfaces */
    RunCheckpoints(RunSetup           &setup,
                   const ResultFolder &folder,
                   Contact            *contact,
                   Log                &log);

    /** Whether a checkpoint is due after a step, by its simulated time. */
    bool
    are_due(const unsigned long long step) const;

    /** @return whether the checkpoint is written */
    bool
    write(State &state, const EnergyBalance &energy) const;

    /** Restores the state from the checkpoint that the folder names. */
    void
    read(State &state, EnergyBalance &energy) const;

  private:
    /** Energies summed up so far, each rank its own part. */
    std::vector<Sum *>
    sums_of_rank(State &state) const;

    /** The energies that are not summed reproducibly. */
    std::vector<double *>
    plain_sums_of_rank() const;

    /** The numbers that a checkpoint holds; documents are empty. */
    StateContent
    content_of(State &state) const;

    /** Those of the motion; a restart finds those of the setup anew. */
    std::vector<std::string>
    warnings_of_run() const;

    /** Sizes of the growing files, by name in the output folder [bytes]. */
    nlohmann::json
    sizes_of_files() const;

    RunSetup           &setup;
    const Model        &model;
    const ResultFolder &folder;
    Contact *const      contact;
    Log                &log;
    const Checkpoint    files;
    const std::size_t   n_warnings_before;
    const bool          by_time;
    const Schedule      schedule;
  };
} // namespace Voussoir

#endif
