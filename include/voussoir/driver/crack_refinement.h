#ifndef voussoir_driver_crack_refinement_h
#define voussoir_driver_crack_refinement_h

#include <voussoir/driver/result_folder.h>
#include <voussoir/grid/refine_where.h>

namespace Voussoir
{
  /** Refuses entries of "Mesh/Refine where" that do not fit the rest. */
  void
  check_refinement(const Case &parameters);

  /** Whether the linear run that the case asks for has still to be made; called
   *  on all ranks. */
  bool
  awaits_linear_run(const Case &parameters, const MPI_Comm communicator);

  /** Folder of the run from which the demand is taken; empty: of none. */
  std::string
  demand_folder(const Case &parameters);

  /** Longest edge of each material where it may crack, from its fracture
   *  energy; infinite for a material without [m]. */
  std::vector<double>
  crack_edges(const Case &parameters);

  /** Cells of that run whose demand exceeds the threshold; null: the case names
   *  no such run. */
  std::shared_ptr<const CellsAndRing>
  stressed_cells(const Case &parameters, const CoarseMesh &mesh);

  /** The same for summary.json; null: none. */
  nlohmann::json
  summary_of_refinement(const Case              &parameters,
                        const RefinementSummary &summary);

  /** Which cells were refined and why; empty: none are wanted. */
  std::string
  describe_refinement(const Case &parameters, const RefinementSummary &summary);

  /**
   * Makes the linear run that "Demand of = linear run" asks for, unless an
   * earlier run of the same case has left it: the case on its unrefined mesh,
   * in which materials that crack are linear elastic. Called on all ranks.
   *
   * @return the options of the run itself, which does not restart if the linear
   *   run had not ended
   */
  RunOptions
  after_linear_run(const Case       &parameters,
                   const RunOptions &options,
                   const MPI_Comm    communicator);
} // namespace Voussoir

#endif
