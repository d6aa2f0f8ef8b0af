#ifndef voussoir_analysis_stage_results_h
#define voussoir_analysis_stage_results_h

#include <voussoir/analysis/stage_stresses.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/fem/point_weights.h>

#include <memory>

namespace Voussoir
{
  /** Results of a static stage at named points, of the body and of its
   *  interfaces. */
  class StageResults
  {
  public:
    /**
     * Called on all ranks.
     *
     * @param points as the entry has them; if it is empty the upstream edge of
     *   the crest in the middle of its length and at its quarters, or none
     *   where there is no face set "upstream face"
     * @param face_sets see StageStresses
     */
    StageResults(const Discretization &discretization,
                 const std::string    &points,
                 const std::string    &face_sets);

    /** Adds displacements of the points, the largest one of all nodes with its
     *  place, stresses on faces, and opening, slip and forces of each surface
     *  of @p contact, which may be null. Called on all ranks.
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
  };

  /** Points, faces and interfaces of a stage in lines of the log. */
  std::string
  description_of_stage(const nlohmann::json &report);
} // namespace Voussoir

#endif
