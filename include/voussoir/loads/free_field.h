#ifndef voussoir_loads_free_field_h
#define voussoir_loads_free_field_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Voussoir
{
  /** Data of an absorbing boundary for a free field. */
  struct BoundaryGeometry
  {
    /** Positions of the nodes [m]. */
    std::vector<dealii::Point<3>> nodes;

    /** One quadrature point's part of the traction integral at a node. */
    struct Contribution
    {
      unsigned int         node;
      dealii::Point<3>     point;
      dealii::Tensor<1, 3> area; // outward normal times shape function times dA
      double               middle; // height of the face's middle [m]
    };
    std::vector<Contribution> contributions;

    /** Whether the field must not depend on the partition, bit for bit. */
    bool reproducible = false;
  };

  /** A vertical face of the boundary: its extent and its material. */
  struct SideFace
  {
    double           lower, upper; // [m]
    double           area;         // [m2]
    unsigned int     material;
    dealii::Point<3> middle;

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &lower &upper &area &material &middle;
    }
  };

  /**
   * The motion of the ground without canyon and dam, at the nodes
   * of the absorbing boundary.
   */
  class FreeField
  {
  public:
    virtual ~FreeField() = default;

    /** Evaluates the field at this time; called for each step in turn. */
    virtual void
    advance(const double time) = 0;

    /** State from which the next step continues, the same on all ranks. */
    virtual std::vector<double>
    save() const
    {
      return {};
    }

    virtual void
    load(const std::vector<double> &)
    {}

    /** Of each node: displacement [m], velocity [m/s], and the integral of the
     *  traction over its part of the boundary [N]. */
    std::vector<dealii::Tensor<1, 3>> displacement, velocity, force;
  };
} // namespace Voussoir

#endif
