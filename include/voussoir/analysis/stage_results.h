#ifndef voussoir_analysis_stage_results_h
#define voussoir_analysis_stage_results_h

#include <voussoir/analysis/point_stresses.h>
#include <voussoir/analysis/stage_stresses.h>
#include <voussoir/analysis/static_state.h>

#include <memory>

namespace Voussoir
{
  /** Item of a list of points: of a face set "upstream face", the lowest point
   *  under the crown, and the upper edge above that point and at the quarters.
   */
  constexpr char usual_points_of_stages[] = "usual";

  /** Results of a static stage at named points, of the body and of its
   *  interfaces. */
  class StageResults
  {
  public:
    /** Called on all ranks. */
    StageResults(const Discretization   &discretization,
                 const StaticParameters &parameters);

    /** Adds displacements and stresses of the points, the largest displacement
     *  of all nodes with its place, stresses on faces, and opening, slip and
     *  forces of each surface of @p contact, which may be null. Called on all
     *  ranks.
     *  @param model with the initial state of this stage */
    void
    describe(const StressModel &model,
             const Contact     *contact,
             nlohmann::json    &report) const;

  private:
    const Discretization                     &discretization;
    const std::vector<NamedPoint>             points;
    const std::unique_ptr<const PointWeights> weights; // null without points
    const StageStresses                       stresses;
    const PointStresses                       point_stresses;
  };

  /** Points, faces and interfaces of a stage in lines of the log. */
  std::string
  description_of_stage(const nlohmann::json &report);
} // namespace Voussoir

#endif
