#ifndef voussoir_driver_simulation_h
#define voussoir_driver_simulation_h

#include <voussoir/base/log.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/driver/case.h>
#include <voussoir/fem/stable_step.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/output/checkpoint.h>
#include <voussoir/output/energy.h>
#include <voussoir/time/central_difference.h>

#include <deal.II/base/timer.h>

namespace Voussoir
{
  /** How the command line wants a case to be run. */
  struct RunOptions
  {
    bool restart   = false;
    bool overwrite = false;
    bool quiet     = false;

    /** No output folder: for tests that look at the state themselves. */
    bool no_output = false;

    /** Set up for checks only: no static state, no modes. */
    bool validate = false;
  };

  /**
   * A case set up and run. The constructor builds everything in the order of
   * dependence, which is the order of the members; `run()` is the time loop.
   */
  class Simulation
  {
  public:
    Simulation(Case             &parameters,
               const RunOptions &options,
               const MPI_Comm    communicator);

    /** Steps to the end time. */
    void
    run();

    Case                               &parameters;
    const RunOptions                    options;
    Log                                 log;
    dealii::TimerOutput                 timer;
    const std::string                   folder;      // empty: no output
    CoarseMesh                          coarse_mesh; // until the grid is made
    CoarseMesh                          water_mesh;  // split off the other
    const std::vector<unsigned int>     coarse_materials;
    Damping                             damping;
    const std::vector<const Material *> materials;
    const Grid                          grid;
    const Discretization                discretization;
    const LumpedMass                    mass;
    const InternalForce                 internal_force;
    NodalTerms                          terms;
    AbsorbingBoundary                   boundary;
    std::unique_ptr<Reservoir>          reservoir;    // compressible, or null
    GroundMotionSignals                 base_signals; // of a rigid base
    nlohmann::json                      static_summary;
    std::vector<Projection *>           projections;
    std::unique_ptr<Contact>            contact;       // null: no interfaces
    std::vector<const Load *>           running_loads; // in no static stage
    const InitialState                  initial;
    const Modes                         modes;
    double                              undamped_step = 0.;
    const double                        largest_step;
    const double                        time_step;
    CentralDifference                   scheme;
    State                               state;
    Checkpoint                          checkpoint;
    const ObservedModel                 model;

    /** Energy balance at the state. */
    EnergyBalance energy;

    nlohmann::json
    summary() const;

    unsigned long long
    n_steps() const;

    /** Index of a cell's material. */
    unsigned int
    material_of(const Grid::Cell &cell) const;

  private:
    void
    report_start();

    /** Makes the output folder and its files. */
    void
    open_output();

    /** Refuses a checkpoint of other physics or of a finished run. */
    void
    check_checkpoint();

    bool
    rigid_base() const;

    /** Displacement, velocity and acceleration of a rigid base. */
    std::array<dealii::Tensor<1, 3>, 3>
    base_motion(const double time) const;

    double
    find_largest_step();

    double
    choose_time_step();

    InitialState
    find_initial_state();

    Modes
    find_natural_modes();

    void
    write_modes();

    void
    prepare_loads();

    void
    prepare_reservoir();

    void
    report_mesh();

    void
    report_step();

    void
    prepare_ground_motion();

    void
    observe();

    /** Keeps what a picture of the last good state needs. */
    void
    keep_last_good();

    /** What the clock asks for: progress, checkpoint, stop on request. */
    void
    attend();

    void
    report_progress();

    /** [MDOF-steps/s] */
    double
    throughput(const double seconds) const;

    std::map<std::string, Vector *>
    checkpoint_vectors();

    std::map<std::string, KeyedValues>
    checkpoint_values();

    /** All entries that must agree between a checkpoint and its restart. */
    nlohmann::json
    physics() const;

    std::vector<double>
    accumulated_work() const;

    std::string
    timer_table() const;

    void
    write_checkpoint();

    void
    read_checkpoint();

    void
    finish();

    [[noreturn]] void
    abort_run(const std::string &reason);

    State              last_good; // without memory
    dealii::Timer      clock, since_report, since_checkpoint;
    unsigned long long first_step   = 0;
    double             loop_seconds = 0.;
  };
} // namespace Voussoir

#endif
