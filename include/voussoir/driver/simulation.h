#ifndef voussoir_driver_simulation_h
#define voussoir_driver_simulation_h

#include <voussoir/driver/run.h>

namespace Voussoir
{
  /**
   * A case and one earthquake: everything from the parameter file to the run,
   * made in the order of dependence, which is the order of the members. The
   * linear run that the case may need for its mesh comes first.
   */
  class Simulation
  {
  public:
    /** Throws UserError for a case that cannot be computed, before the static
     *  state is found and before the output folder is made. */
    Simulation(const Case       &parameters,
               const RunOptions &options,
               const MPI_Comm    communicator);

    ~Simulation(); // defined in one file, as it takes long to compile

    Log          log;
    ResultFolder folder;
    Model        model;

  private:
    /** After the linear run that the case may need. */
    Simulation(const RunOptions &options,
               const Case       &parameters,
               const MPI_Comm    communicator);

    RunPlan                   plan;  // until the setup has it
    std::unique_ptr<RunSetup> early; // null if damping waits for the modes
    StaticState               found; // of the static stages

  public:
    const Modes modes;

  private:
    std::unique_ptr<RunSetup> setup; // until the run has it

  public:
    const StaticState static_state; // with the moduli of the run
    Run               run;
  };
} // namespace Voussoir

#endif
