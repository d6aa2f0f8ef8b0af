#ifndef voussoir_analysis_load_path_h
#define voussoir_analysis_load_path_h

#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/relaxation.h>
#include <voussoir/analysis/secant_steps.h>
#include <voussoir/analysis/static_cracks.h>
#include <voussoir/analysis/static_state.h>
#include <voussoir/output/observer.h>

#include <deal.II/base/timer.h>

namespace Voussoir
{
  /** Loads that grow along a static stage. */
  struct StaticLoads
  {
    Vector              force;       // [N]
    Vector              temperature; // change [K]
    std::vector<double> uplift;      // at the points of the interfaces [Pa]

    /** Linear interpolation to other loads; without round-off at a share of
     *  one. */
    StaticLoads
    grown_to(const StaticLoads &end, const double share) const;
  };


  /**
   * The equilibrium of the static model while its loads grow, stage by stage:
   * in load increments where materials crack or yield; see find_static_state.
   */
  class LoadPath
  {
  public:
    /** @param state at the end of the path so far, without displacement at
     *   first; displacement, force of the materials and their internal
     *   variables follow the path, the temperature is that of the loads */
    LoadPath(const StaticModel      &model,
             const StaticParameters &parameters,
             InitialState           &state,
             Log                    &log);

    /** Sets up the equations. */
    void
    set_up();

    /** Effort of a stage. */
    struct Effort
    {
      unsigned int iterations   = 0; // of the linear equations
      unsigned int increments   = 0;
      unsigned int damped_steps = 0; // of dynamic relaxation
      bool         by_multigrid = true;
    };

    /** Begins a stage with these loads. */
    void
    begin_stage(const std::vector<std::string> &loads);

    /** Moves the state from the equilibrium under some loads to that under
     *  others; its force becomes that of the supports. */
    Effort
    follow(const StaticLoads &start, const StaticLoads &end);

    /** Sets up the equations again after a change of the ties. */
    void
    ties_have_changed();

    StressModel
    stress_model() const;

    /** Energy that materials have dissipated so far, on all ranks [J]. */
    double
    dissipation() const;

  private:
    /** Forces of the loads and the free thermal strain [N]. */
    Vector
    total_force(const StaticLoads &loads) const;

    /** The linear equations, with the parts tied where they touch now. */
    void
    make_solver();

    /** Applies the loads of a stage in increments. */
    void
    find_path(const StaticLoads &start, const StaticLoads &end);

    /** Equilibrium with these loads.
     *  @param is_trial whether the search may end once materials are known to
     *    crack or yield */
    void
    find_equilibrium(const StaticLoads &loads, const bool is_trial);

    /** Number of equal increments of the loads of a stage, over all of them, in
     *  which the materials remain elastic on a straight path from the
     *  displacement @p before with the internal variables @p memory to the
     *  present one. */
    double
    elastic_share(const Vector         &before,
                  const MaterialMemory &memory,
                  const StaticLoads    &start,
                  const StaticLoads    &end) const;

    /** Difference of the forces of the materials at the end of an increment
     *  between one step of the laws and two, over the loads.
     *  @param before displacement, @p memory before the increment
     *  @param middle, @p end of the increment */
    double
    error_of_return_mapping(const Vector      &before,
                            MaterialMemory     memory,
                            const StaticLoads &middle,
                            const StaticLoads &end) const;

    /** Sums up the dissipation of the materials in an increment over several
     *  steps of the laws: under multiaxial stress a single step would evaluate
     *  the energy of a crack at the end of the step only.
     *  @param before displacement, @p memory before the increment
     *  @param begin, @p end of the increment */
    void
    count_losses(const Vector         &before,
                 const MaterialMemory &memory,
                 const StaticLoads    &begin,
                 const StaticLoads    &end);

    /** Equilibrium of elastic materials. */
    void
    find_elastic_equilibrium(const Vector &force);

    /** Equilibrium with contact or with internal variables: by multigrid;
     *  dynamic relaxation finds it where multigrid does not, and checks that
     *  parts between interfaces are in equilibrium.
     *  @param memory of the materials; null: they are elastic */
    void
    search_equilibrium(const Vector &force, MaterialMemory *memory);

    /** Updates the internal variables of the materials to this state, and
     *  where they crack or yield restores equilibrium.
     *  @param before contact at the beginning of the increment
     *  @param is_trial see find_equilibrium */
    void
    crack_and_yield(const Vector                    &force,
                    const std::vector<ContactPoint> &before,
                    const bool                       is_trial);

    /** The present state of the interfaces' points, or none. */
    std::vector<ContactPoint>
    contact_points() const;

    /** By dynamic relaxation. */
    void
    relax(const Vector &force, MaterialMemory &memory);

    /** Energy that materials have dissipated in this state, on all ranks [J].
     */
    double
    dissipation(const MaterialMemory &memory) const;

    /** Whether materials have dissipated more than this [J] on any rank, that
     *  is, have cracked or yielded since. */
    bool
    dissipated(const MaterialMemory &memory, const double before = 0.) const;

    /** Reports the progress of the search, of which this share is done. */
    void
    report_progress(const double share, const std::string &text);

    const StaticModel                      &model;
    const StaticParameters                 &parameters;
    InitialState                           &state;
    Log                                    &log;
    const std::vector<const Material *>     materials; // of the static state
    const InternalForce                     internal_force;
    const bool                              on_springs;
    const dealii::AffineConstraints<double> constraints;
    const Damping                           damping; // none
    StaticCracks                            cracks;
    std::unique_ptr<ElasticSolver>          solver;
    std::unique_ptr<Relaxation>
                          relaxation;    // with contact or internal variables
    SecantSteps           secants;       // along this stage
    std::string           stage;         // its loads
    unsigned int          number = 0;    // of this stage
    Vector                before;        // displacement before it [m]
    Effort                effort;        // of this stage
    dealii::Timer         since_start;   // of its path
    std::array<double, 2> increment;     // of its loads
    double                accuracy = 0.; // residual over loads; 0: of a stage
    bool                  may_be_halved = false; // the increment

    // false if the increment is to be halved, as the search has found no
    // equilibrium
    bool is_found = true;
  };
} // namespace Voussoir

#endif
