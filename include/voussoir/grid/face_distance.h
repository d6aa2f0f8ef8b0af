#ifndef voussoir_grid_face_distance_h
#define voussoir_grid_face_distance_h

#include <voussoir/grid/grid.h>

#include <deal.II/numerics/rtree.h>

namespace Voussoir
{
  /** In deal.II's order [m]. */
  using FaceCorners = std::array<dealii::Point<3>, 4>;

  /** All faces of some sets, each checked, of all ranks; @p place names the
   *  entry. */
  std::vector<FaceCorners>
  gather_faces(const Grid                     &grid,
               const std::vector<std::string> &sets,
               const std::string              &place);

  /**
   * Distance of points to the faces of some face sets. Every rank holds all
   * faces, in a search tree.
   */
  class FaceDistance
  {
  public:
    /** @param sets face sets, each checked; @p place names the entry. */
    FaceDistance(const Grid                     &grid,
                 const std::vector<std::string> &sets,
                 const std::string              &place);

    /**
     * Distance to the nearest face [m]; exact to plane faces. A warped face
     * counts as four triangles that meet in its centre.
     */
    double
    operator()(const dealii::Point<3> &point) const;

  private:
    std::vector<std::array<dealii::Point<3>, 5>> faces; // around, and centre

    /** Boxes around the faces, with their numbers. */
    dealii::RTree<std::pair<dealii::BoundingBox<3>, unsigned int>> boxes;
  };

  /**
   * Distance of points of a surface to some face sets within the surface: to
   * the edges at which it meets them, and to the nearest face of the sets if it
   * does not meet them; zero where it is one of their faces. A face that leans
   * towards the surface is nearer to its points than its edge.
   */
  class EdgeDistance
  {
  public:
    /** @param surface its faces on all ranks
     *  @param sets each checked; @p place names their entry */
    EdgeDistance(const Grid                     &grid,
                 const std::vector<FaceCorners> &surface,
                 const std::vector<std::string> &sets,
                 const std::string              &place);

    /** [m] */
    double
    operator()(const dealii::Point<3> &point) const;

  private:
    FaceDistance                                 to_faces;
    std::vector<std::array<dealii::Point<3>, 2>> edges;
    double                                       touching; // closer: zero [m]
  };
} // namespace Voussoir

#endif
