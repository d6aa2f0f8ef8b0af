#ifndef voussoir_analysis_equilibrium_search_h
#define voussoir_analysis_equilibrium_search_h

#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/secant_steps.h>
#include <voussoir/analysis/static_cracks.h>

#include <functional>
#include <optional>

namespace Voussoir
{
  /**
   * Search for the static equilibrium of bodies that crack or yield and of
   * interfaces, on the multigrid solver.
   *
   * Interfaces: semi-smooth Newton steps under multipliers of contact that are
   * updated in turn (Alart and Curnier 1991). The shear limit of sliding points
   * follows their pressure; the tangent omits this, and so stays symmetric.
   * Materials: secant steps from the elastic stiffness; every evaluation of the
   * materials starts from their internal variables before the search, so that
   * damage of iterates is not kept.
   */
  class EquilibriumSearch
  {
  public:
    /** Effort of a search. */
    struct Effort
    {
      bool         found      = false;
      unsigned int iterations = 0;  // of the linear equations
      unsigned int steps      = 0;  // of Newton
      double       residual   = 0.; // over the loads

      StaticContact::Change contact; // by the last update of the multipliers
    };

    /** Receives the share of the search that is done and a text on its state.
     */
    using Report = std::function<void(const double, const std::string &)>;

    /**
     * @param solver    with the interfaces, if there are any
     * @param cracks    in cells
     * @param springs   of the absorbing boundary, or null if it is fixed
     * @param tolerance of the residual over the loads; that of the change of
     *   contact forces over all of these is ten times as large
     * @param patience  number of steps in which the residual has to halve
     * @param secants of earlier searches on the same path, kept for the next;
     *   if there are any, interfaces are near their equilibrium from the start
     * @param report    called after each step
     */
    EquilibriumSearch(ElasticSolver       &solver,
                      const InternalForce &internal_force,
                      StaticCracks        &cracks,
                      const NodalTerms    *springs,
                      const Vector        &force,
                      const double         tolerance,
                      const unsigned int   patience,
                      SecantSteps         &secants,
                      const Report        &report);

    /**
     * @param displacement start of the search; the equilibrium if it was found,
     *   else unchanged, as are contact and internal variables
     * @param memory       internal variables of the materials; null: they are
     * elastic
     */
    Effort
    find(Vector &displacement, MaterialMemory *memory);

  private:
    /** Looks for an equilibrium until no crack has a new tip in it; its full
     *  accuracy is asked for once a coarse one has no new tip. */
    void
    follow_cracks();

    /** Finds new tips of cracks, in cells and along interfaces; returns whether
     *  any rank has some. */
    bool
    find_tips();

    /** Updates of the multipliers until the equilibrium is found.
     *  @param aim for the residual over the loads */
    void
    approach(const double aim);

    /** Steps until the equilibrium under these multipliers is found to an
     *  accuracy; at least one, unless a tenth of the aim is met already, as
     *  forces of contact may be small beside the loads. */
    void
    balance(const double accuracy, const double aim);

    /** One step, to where the residual does no more work along the step. */
    void
    step();

    /** Residual at a displacement: external less internal forces, springs and
     *  contact included, on free entries. */
    void
    find_residual();

    /** Norm of the residual over that of the loads. */
    double
    imbalance() const;

    /** Whether the residual has halved within the last `patience` steps. */
    bool
    is_worth_it() const;

    void
    report_progress() const;

    ElasticSolver       &solver;
    StaticContact       *contact; // null without interfaces
    const InternalForce &internal_force;
    StaticCracks        &cracks;
    const NodalTerms    *springs;
    const Vector        &force;
    const double         tolerance;
    const unsigned int   patience;
    SecantSteps         &secants;
    const Report         report;
    double               size; // of the force on free entries

    Vector                       *displacement = nullptr;
    MaterialMemory               *memory       = nullptr;
    MaterialMemory                memory_before;
    std::optional<MaterialMemory> before_tips; // none: no new tips
    Vector                        residual, change, taken;
    Effort                        effort;
    double                        first_imbalance = 0.;
    double       least_imbalance = std::numeric_limits<double>::max();
    unsigned int last_gain       = 0; // step of the least imbalance
  };
} // namespace Voussoir

#endif
