#ifndef voussoir_fem_point_weights_h
#define voussoir_fem_point_weights_h

#include <voussoir/fem/discretization.h>

#include <optional>

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

  /** Place of a point in the reference cell, if the point is in or on this
   *  cell. */
  std::optional<dealii::Point<3>>
  unit_place(const Discretization       &discretization,
             const Discretization::Cell &cell,
             const dealii::Point<3>     &point);

  /**
   * Interpolation weights at points of the mesh. Every rank has the weights of
   * its own nodes; the sum over the ranks is the value at the point. If results
   * are reproducible, each node has a part of its own: the parts of a point are
   * the same on any partition, and are summed last and in order.
   */
  class PointWeights
  {
  public:
    /** Refuses a point outside the mesh; @p place names the entry. */
    PointWeights(const Discretization          &discretization,
                 const std::vector<NamedPoint> &points,
                 const std::string             &place);

    struct Weight
    {
      unsigned int point, part, node;
      double       weight;
    };
    std::vector<Weight> items;

    /** Parts of each point. */
    unsigned int n_parts = 1;

    /** This rank's share of the value of a nodal vector at each point, part by
     *  part. */
    std::vector<dealii::Tensor<1, 3>>
    share(const Vector &vector) const;

    /** The values at the points, on all ranks, which must call this
     *  together. */
    std::vector<dealii::Tensor<1, 3>>
    value(const Vector &vector) const;

  private:
    const unsigned int n_points;
    const MPI_Comm     communicator;
  };
} // namespace Voussoir

#endif
