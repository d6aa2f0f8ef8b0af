#ifndef voussoir_analysis_static_state_h
#define voussoir_analysis_static_state_h

#include <voussoir/base/log.h>
#include <voussoir/base/option.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/loads/boundary_parameters.h>
#include <voussoir/loads/load.h>
#include <voussoir/materials/solid.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** The loads of a case by their names. */
  using NamedLoads = std::vector<std::pair<std::string, const Load *>>;

  enum class StaticSupports
  {
    fixed,
    roller,
    springs
  };

  inline OptionNames<StaticSupports>
  option_names(const StaticSupports)
  {
    return {{StaticSupports::fixed, "fixed"},
            {StaticSupports::roller, "roller"},
            {StaticSupports::springs, "springs"}};
  }


  /** The entries of the section "Static state". */
  struct StaticParameters
  {
    std::string    stages;
    StaticSupports supports   = StaticSupports::fixed;
    unsigned int   increments = 4; // of a stage that depends on its path
    double         tolerance  = 1e-8;
    double         rest       = 1e-6;
    std::string    kept       = "static_states"; // folder
    std::string    points; // whose displacements are results of each stage
    std::string    faces;  // whose stresses are

    /** Loads that are not active. */
    std::vector<std::string> left_out;

    void
    declare(dealii::ParameterHandler &prm);

    /** A stage that has active loads. */
    struct Stage
    {
      std::string              name; // of the combination of all loads so far
      std::vector<std::string> loads;

      /** Name of the stage, or its loads if it has no name. */
      std::string
      title() const;
    };

    std::vector<Stage>
    stage_list() const;

    /** Names of the loads of each stage. */
    std::vector<std::vector<std::string>>
    stage_names() const;

    /** Refuses stages of unknown loads, loads named twice, loads that need a
     *  stage and have none, and interfaces grouted after no stage. */
    void
    check(const NamedLoads           &loads,
          const InterfacesParameters &interfaces) const;
  };

  /** Refuses points and faces of results that the mesh does not have. Called on
   *  all ranks. */
  void
  check_stage_results(const Discretization   &discretization,
                      const StaticParameters &parameters);

  /** Input of the static stages. */
  struct StaticModel
  {
    const Solid              &solid;
    const BoundaryParameters &boundaries;
    const NodalTerms         &terms;
    Contact                  *contact; // or null
  };

  /**
   * The state under the loads that act before the earthquake: stages one
   * after the other, each with the loads it names. The run takes over this
   * state by hand_over().
   *
   * Each stage is first solved in one increment with elastic materials, by
   * multigrid, with interfaces in Newton steps. Where materials crack or yield
   * under its loads, these and the temperature grow in increments, as cracks
   * and plastic flow depend on the path, and equilibrium is searched for with
   * the laws of the materials (see EquilibriumSearch). Where this search fails,
   * equilibrium is found by dynamic relaxation, which at the end of a stage
   * also checks whether a state with interfaces is in equilibrium. An increment
   * is halved while the return mapping of the materials differs between one
   * step and two. An interface is grouted at the end of the stage that names
   * its load.
   *
   * Throws LostEquilibrium if no equilibrium is found.
   *
   * @param summary resultants of loads and reactions, iterations, by stage
   */
  InitialState
  find_static_state(const StaticModel      &model,
                    const StaticParameters &parameters,
                    const NamedLoads       &loads,
                    Log                    &log,
                    nlohmann::json         &summary);

  /**
   * Prepares a static state for the dynamic model: finds the force that
   * balances it there, and converts the internal variables of the materials to
   * the moduli of that model. Reactions of supports that are fixed in the
   * static stages only are part of the force, so that without an earthquake
   * nothing moves. Forces of contact are no part of it, as the run finds them
   * by itself. Without static stages nothing is done.
   *
   * @param internal_force that of the run
   * @return dissipation of the laws in the static state on this rank [J]: zero,
   * if these take over the internal variables unchanged
   */
  double
  hand_over(InitialState        &state,
            const InternalForce &internal_force,
            const NodalTerms    &terms);
} // namespace Voussoir

#endif
