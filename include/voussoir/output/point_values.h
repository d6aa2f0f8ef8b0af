#ifndef voussoir_output_point_values_h
#define voussoir_output_point_values_h

#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /** A place with a name. */
  struct NamedPoint
  {
    std::string      name;
    dealii::Point<3> position; // [m]
  };

  /** Reads "crest: 0 0 289; base: 0 0 0"; @p place names the entry. */
  std::vector<NamedPoint>
  parse_points(const std::string &text, const std::string &place);

  /**
   * Interpolation of nodal vectors at points of the mesh. Every rank holds the
   * share of its own nodes; the sum over the ranks is the value.
   */
  class PointValues
  {
  public:
    /** Refuses a point outside the mesh; @p place names the entry. */
    PointValues(const Discretization &         discretization,
                const std::vector<NamedPoint> &points,
                const std::string &            place);

    /** This rank's share of the value at each point. */
    std::vector<dealii::Tensor<1, 3>>
    share(const Vector &vector) const;

  private:
    struct Weight
    {
      unsigned int point, node;
      double       weight;
    };
    const unsigned int  n_points;
    std::vector<Weight> weights;
  };
} // namespace Voussoir

#endif
