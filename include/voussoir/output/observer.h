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
  class WaterMotion;

  /** What observers may see of a case besides its state. */
  struct ObservedModel
  {
    const Solid          &solid;
    const InternalForce  &internal_force; // with the moduli of the run
    const Damping        &damping;
    const MaterialMemory &material_memory;
    const InitialState   &initial;
    const WaterMotion    *water;   // or null
    const Contact        *contact; // or null
    std::string           folder;
    double                time_step; // [s]
    double                end_time;  // [s]
    double carried_frequency;        // highest that the mesh carries well [Hz]

    /** Between two looks that miss no more than 1.2 % of an extreme of what
     *  oscillates as fast as the mesh carries [s]: 20 in a period. */
    double
    resolving_interval() const
    {
      return 0.05 / carried_frequency;
    }

    /** Between two looks for extremes of what is written at this interval
     *  [s]. */
    double
    looking_interval(const double interval) const
    {
      return std::min(interval, resolving_interval());
    }

    /** Warns of extremes that are looked for at an interval which the entry at
     *  @p place sets coarser than that [s]. */
    void
    warn_of_coarse_looks(const double interval, const std::string &place) const;

    /** The ground, to which the state is relative where it moves. */
    const RigidBase &base;

    ResultNames names;

    /** Takes note of results that cannot be written. */
    Log &log;

    /** Constraints of the case, interfaces not among them. */
    const std::vector<std::pair<std::string, std::unique_ptr<Projection>>>
      &constraints;

    /** What marches the state; null before there is a run. */
    const CentralDifference *scheme = nullptr;
  };

  /**
   * Something that watches the run: a section of the parameter file under
   * "Output", called after each step and at the end.
   */
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Between two lines of its record [s], which the time step is fitted to if
     *  it costs little; 0: any step will do. */
    virtual double
    record_interval() const
    {
      return 0.;
    }

    /** Refuses entries that do not fit the model with a UserError. */
    virtual void
    check(const ObservedModel &model) const = 0;

    /**
     * Begins a run: nothing of an earlier one is left, be it finished or not,
     * on this model or another. Not called if the run has no output folder.
     *
     * @param model      of which what is needed later must be copied; what it
     *   refers to stays until the end of the run
     * @param start_time of this run [s]
     * @param restarted  whether to continue the files of a run that was
     *   interrupted at the start time; `load` and the values of the checkpoint
     *   follow
     */
    virtual void
    prepare(const ObservedModel &model,
            const double         start_time,
            const bool           restarted) = 0;

    /** Called for the initial state and after each step; after a restart
     *  first for the state of the checkpoint, once more. */
    virtual void
    observe(const State &state) = 0;

    /** Writes what is left and adds to the summary. */
    virtual void
    finish(const State &state, nlohmann::json &summary) = 0;

    /** What else a checkpoint must hold; files are written up to here. Called
     *  on all ranks, the first one's result counts. */
    virtual nlohmann::json
    save()
    {
      return {};
    }

    virtual void
    load(const nlohmann::json &)
    {}

    /** Own vectors that a checkpoint must hold, by name. */
    virtual std::map<std::string, Vector *>
    checkpoint_vectors()
    {
      return {};
    }

    /** Own numbers of cells that a checkpoint must hold, by name. */
    virtual std::map<std::string, KeyedValues>
    checkpoint_values()
    {
      return {};
    }
  };

  /** Steps at which something with this interval [s] is due: every n-th, so
   * that a record has equal intervals, the nearest to the one asked for. At an
   * interval of 0 each step. */
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
