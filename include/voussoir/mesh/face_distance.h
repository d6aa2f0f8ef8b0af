#ifndef voussoir_mesh_face_distance_h
#define voussoir_mesh_face_distance_h

#include <voussoir/mesh/grid.h>

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
   * Distance of points to the faces of some face sets, wherever in the mesh
   * both are: all ranks hold all faces, in a search tree.
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
    /** A box around some of the faces, cut into two until they are few. */
    struct Box
    {
      dealii::Point<3> lower, upper;
      unsigned int     begin, end;      // its faces
      unsigned int     second_half = 0; // the first half comes next; 0: uncut
    };

    /** Makes the box of these faces and those inside it. */
    unsigned int
    add_box(const unsigned int begin, const unsigned int end);

    /** Lowers @p nearest to the distance of a face in the box, if it is less.
     */
    void
    search(const unsigned int      box,
           const dealii::Point<3> &point,
           double                 &nearest) const;

    std::vector<std::array<dealii::Point<3>, 5>> faces; // around, and centre
    std::vector<Box>                             boxes;
  };
} // namespace Voussoir

#endif
