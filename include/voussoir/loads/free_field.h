#ifndef voussoir_loads_free_field_h
#define voussoir_loads_free_field_h

#include <voussoir/fem/discretization.h>
#include <voussoir/fem/leap_frog.h>
#include <voussoir/loads/ground_motion.h>
#include <voussoir/materials/solid.h>

#include <deal.II/base/tensor.h>

namespace Voussoir
{
  enum class WaveEntrance
  {
    absorbing_boundary,
    rigid_base
  };

  inline OptionNames<WaveEntrance>
  option_names(const WaveEntrance)
  {
    return {{WaveEntrance::absorbing_boundary, "absorbing boundary"},
            {WaveEntrance::rigid_base, "rigid base"}};
  }


  enum class WaveType
  {
    vertical,
    oblique_p,
    oblique_sv,
    oblique_sh
  };

  inline OptionNames<WaveType>
  option_names(const WaveType)
  {
    return {{WaveType::vertical, "vertical"},
            {WaveType::oblique_p, "oblique P"},
            {WaveType::oblique_sv, "oblique SV"},
            {WaveType::oblique_sh, "oblique SH"}};
  }


  /** The entries of the section "Wave field". */
  struct WaveParameters
  {
    WaveEntrance enters_through    = WaveEntrance::absorbing_boundary;
    WaveType     type              = WaveType::vertical;
    double       angle             = 15.;
    double       azimuth           = 0.;
    double       maximum_frequency = 25.;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /** What a free field must know of an absorbing boundary. */
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
  };

  /** A vertical face of the boundary: where it reaches and of what it is. */
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
   * The motion that the ground would make without canyon and dam, at the nodes
   * of the absorbing boundary.
   */
  class FreeField
  {
  public:
    virtual ~FreeField() = default;

    /** Evaluates the field at this time; called for each step in turn. */
    virtual void
    advance(const double time) = 0;

    /** Numbers from which the next step goes on, the same on all ranks. */
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

  class AbsorbingBoundary;

  /**
   * The free field of a case, from what the sections "Ground motion" and "Wave
   * field" say.
   */
  std::unique_ptr<FreeField>
  make_free_field(const AbsorbingBoundary             &boundary,
                  const Discretization                &discretization,
                  const std::vector<const Material *> &materials,
                  const QuadratureRule                 quadrature,
                  const Damping                       &damping,
                  const WaveParameters                &wave,
                  const MotionPlace                    given_at,
                  GroundMotionSignals                &&motion,
                  const LeapFrog                      &leap_frog,
                  const double                         duration);
} // namespace Voussoir

#endif
