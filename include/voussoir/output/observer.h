#ifndef voussoir_output_observer_h
#define voussoir_output_observer_h

#include <voussoir/base/keyed_values.h>
#include <voussoir/base/log.h>
#include <voussoir/base/registry.h>
#include <voussoir/fem/damping.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/state.h>
#include <voussoir/loads/rigid_base.h>
#include <voussoir/materials/solid.h>
#include <voussoir/output/names.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  class CentralDifference;
  class Contact;
  class Projection;
  class Reservoir;
  class WaterMotion;

  /** Parts of a case that observers may read before the run. */
  struct ObservedModel
  {
    const Solid     &solid;
    const Contact   *interfaces; // before any load acts; or null
    const Reservoir *reservoir;  // of compressible water; or null

    /** Constraints of the case, without its interfaces. */
    const std::vector<std::pair<std::string, std::unique_ptr<Projection>>>
      &constraints;

    ResultNames names;
    double      end_time;          // [s]
    double      carried_frequency; // highest that the mesh carries well [Hz]

    /** Whether displacements are relative to a rigid base that moves. */
    bool base_moves;

    /** Records results that cannot be written. */
    Log &log;

    /** Interval of samples that miss at most 1.2 % of an extreme at the highest
     *  frequency that the mesh carries [s]: 20 in a period. */
    double
    resolving_interval() const
    {
      return 0.05 / carried_frequency;
    }

    /** Interval of samples for extremes of results that are written at this
     *  interval [s]. */
    double
    sampling_interval(const double interval) const
    {
      return std::min(interval, resolving_interval());
    }

    /** Warns of extremes that are sampled at a coarser interval [s], set by the
     *  entry at @p place. */
    void
    warn_of_coarse_sampling(const double       interval,
                            const std::string &place) const;
  };

  /** Input of the stress at a point, in a run or in a static stage. */
  struct StressModel
  {
    const Discretization                &discretization;
    const std::vector<const Material *> &materials; // by number
    const InternalForce                 &internal_force;
    const Damping                       &damping;
    const MaterialMemory                &material_memory;
    const InitialState                  &initial;
    double                               time_step; // [s]
  };

  /** Parts of a run that observers may read besides the state. */
  struct ObservedRun : ObservedModel
  {
    const InternalForce     &internal_force; // with the moduli of the run
    const Damping           &damping;
    const MaterialMemory    &material_memory;
    const InitialState      &initial;
    const WaterMotion       *water;   // or null
    const Contact           *contact; // or null
    const RigidBase         &base;    // to which the state is relative
    const CentralDifference &scheme;  // the time integration of the state
    std::string              folder;
    double                   time_step; // [s]

    /** When it starts [s], and whether it continues there with the files of a
     * run that was interrupted. */
    double start_time = 0.;
    bool   restarted  = false;

    operator StressModel() const
    {
      return {solid.discretization,
              solid.materials,
              internal_force,
              damping,
              material_memory,
              initial,
              time_step};
    }
  };

  /**
   * A writer of one kind of results: a section of the parameter file under
   * "Output", called after each step and at the end. `keep` declares its state
   * from one step to the next, which checkpoints store.
   */
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Interval of its lines [s]; the time step becomes an integer fraction of
     *  it if that costs little; 0: not needed. */
    virtual double
    record_interval() const
    {
      return 0.;
    }

    /** Throws UserError for entries that do not fit the model. */
    virtual void
    check(const ObservedModel &) const
    {}

    /** Begins a run, and discards the results of an earlier one. The members of
     *  @p run must live until its end. Not called if the run has no output
     *  folder. */
    void
    begin(const ObservedRun &run);

    /** Called for the initial state and after each step; after a restart called
     *  first for the state of the checkpoint again. */
    virtual void
    observe(const State &state) = 0;

    /** Writes the remaining results and adds to the summary. */
    void
    finish(const State &state, nlohmann::json &summary);

    /** State for a checkpoint: numbers, of which those of the first rank count,
     *  own vectors and own numbers of cells or points, by name; files are
     *  written up to here. Called on all ranks. */
    nlohmann::json
    save();

    void
    load(const nlohmann::json &saved);

    std::map<std::string, Vector *>
    checkpoint_vectors();

    std::map<std::string, KeyedValues>
    checkpoint_values();

  protected:
    /** Initializes the observer for a run, and declares its state. */
    virtual void
    prepare() = 0;

    /** Flushes samples that wait in memory into the state and the files; called
     *  on all ranks, before a checkpoint and at the end. */
    virtual void
    flush()
    {}

    virtual void
    conclude(const State &state, nlohmann::json &summary) = 0;

    /** The run that has begun. */
    const ObservedRun &
    run() const
    {
      return *observed;
    }

    MPI_Comm
    communicator() const
    {
      return observed->solid.grid().communicator();
    }

    /** Adds to the state a finite value that JSON can represent. */
    template <typename T>
    void
    keep(const std::string           &name,
         T                           &value,
         const std::common_type_t<T> &initial)
    {
      value = initial;
      keep(
        name,
        [&value] { return nlohmann::json(value); },
        [&value](const nlohmann::json &saved) { saved.get_to(value); });
    }

    /** The same for a value with functions that save and load it. */
    void
    keep(const std::string                                 &name,
         const std::function<nlohmann::json()>             &save,
         const std::function<void(const nlohmann::json &)> &load);

    /** The same for a nodal vector, which becomes zero. */
    void
    keep(const std::string &name, Vector &vector);

    /** The same for numbers of cells or points, by name. */
    void
    keep(const std::function<std::map<std::string, KeyedValues>()> &values);

  private:
    struct Kept
    {
      std::function<nlohmann::json()>             save;
      std::function<void(const nlohmann::json &)> load;
    };

    std::unique_ptr<const ObservedRun> observed;
    std::map<std::string, Kept>        kept;
    std::map<std::string, Vector *>    kept_vectors;
    std::vector<std::function<std::map<std::string, KeyedValues>()>>
      kept_values;
  };

  /** Steps at which output with this interval [s] is due: every n-th, with n
   *  such that the interval is nearest to the given one. At an interval of 0
   *  each step. */
  class Schedule
  {
  public:
    Schedule() = default;
    Schedule(const double interval, const double time_step);

    bool
    due(const unsigned long long step) const;

  private:
    unsigned long long steps = 1;
  };
} // namespace Voussoir

#endif
