#ifndef voussoir_analysis_point_stresses_h
#define voussoir_analysis_point_stresses_h

#include <voussoir/fem/point_weights.h>
#include <voussoir/output/face_mesh.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * Stresses at named points in a static stage: the mean over the cells that
   * meet there. As stresses jump between materials, it is over the cells of one
   * material: one with faces of the dam if there is any, with the arch and
   * cantilever directions of the nearest node of the faces; else the first of
   * the case.
   */
  class PointStresses
  {
  public:
    /** Called on all ranks.
     *  @param faces of the dam, not level anywhere; none: no directions */
    PointStresses(const Discretization                &discretization,
                  const std::vector<NamedPoint>       &points,
                  const std::vector<const FaceMesh *> &faces);

    /** Adds principal, arch and cantilever stress to each point by its name.
     *  Called on all ranks.
     *  @param model with the initial state of this stage */
    void
    describe(const StressModel &model, nlohmann::json &report) const;

  private:
    /** Cells that meet at the points. */
    void
    find_places(const Discretization         &discretization,
                const std::set<unsigned int> &materials_of_faces);

    /** Arch and cantilever directions at points that have them. */
    void
    find_directions(const std::vector<const FaceMesh *> &faces);

    const std::vector<NamedPoint>    points;
    std::vector<StressPoints::Place> places; // on this rank
    std::vector<unsigned int>        point_of_place;

    struct Found
    {
      double n_places = 0.; // on all ranks
      bool   has_directions;

      dealii::Tensor<1, 3> arch, cantilever;
    };

    std::vector<Found> found; // of each point
  };
} // namespace Voussoir

#endif
