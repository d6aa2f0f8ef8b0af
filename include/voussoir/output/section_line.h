#ifndef voussoir_output_section_line_h
#define voussoir_output_section_line_h

#include <voussoir/grid/face_distance.h>
#include <voussoir/output/stress_points.h>

namespace Voussoir
{
  /** Requested position of a section through the dam. */
  struct SectionRequest
  {
    std::string name;

    /** A place near the upstream face [m]. */
    dealii::Point<3> position;

    /** Only x and z are given: the place is sought along the river. */
    bool along_river;
  };

  /** Reads "crown: 0 250; left: 210 -40 180"; @p place names the entry. */
  std::vector<SectionRequest>
  parse_sections(const std::string &text, const std::string &place);

  /**
   * A horizontal line through the dam, from the point of its upstream face that
   * is nearest to a wanted one, along the horizontal direction of the face's
   * normal there, to the downstream face; with Gauss points for integrals over
   * it, cell by cell. The same on all ranks but for the points, of which each
   * rank has those in its cells. Where the line runs along the border of cells,
   * their mean counts.
   */
  struct SectionLine
  {
    /** Throws UserError where there is no such line.
     *  @param faces the upstream and the downstream faces
     *  @param place names the entry with the request */
    SectionLine(const Discretization                          &discretization,
                const SectionRequest                          &request,
                const std::array<std::vector<FaceCorners>, 2> &faces,
                const std::string                             &place);

    std::string          name;
    dealii::Point<3>     upstream;  // its point on the face [m]
    dealii::Tensor<1, 3> normal;    // horizontal, pointing upstream
    dealii::Tensor<1, 3> arch;      // horizontal tangent, z x normal
    double               thickness; // [m]

    /** An integration point of this rank. */
    struct LinePoint
    {
      StressPoints::Place place;
      double              coordinate; // from the middle, positive upstream [m]
      double              weight;     // [m]
    };
    std::vector<LinePoint> points;

    /** Throws a UserError with this reason. */
    using Refuse = std::function<void(const std::string &)>;

  private:
    void
    place_points(const Discretization &discretization, const Refuse &refuse);
  };
} // namespace Voussoir

#endif
