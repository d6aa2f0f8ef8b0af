#ifndef voussoir_constraints_interface_law_h
#define voussoir_constraints_interface_law_h

#include <voussoir/base/registry.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** Internal variables of a point of an interface. */
  struct InterfaceHistory
  {
    double opening = 0.; // largest so far, with the initial gap [m]
    double slip    = 0.; // accumulated length of its path [m]
    double tip     = 1.; // factor on the strength of a bond ahead of a crack

    bool
    is_cracked() const
    {
      return opening > 0. || slip > 0.;
    }
  };

  /** Resistance of a point of an interface. */
  struct InterfaceStrength
  {
    double tension  = 0.; // of the bond [Pa]
    double bond     = 0.; // cohesion of the bond, across an opening too [Pa]
    double cohesion = 0.; // while the interface is closed [Pa]
    double friction = 0.; // coefficient
  };

  /**
   * The strength of an interface (joint, slip plane, dam-rock contact). A
   * closed interface resists any pressure p, tension up to `tension`, and shear
   * up to
   *   bond + cohesion + friction <p> ;
   * an open one, tension up to `tension` and shear up to `bond`. An opened bond
   * unloads along the secant to zero opening.
   *
   * A law is a class with its entries and this function; one file and one line
   * of registration add a law.
   */
  class InterfaceLaw
  {
  public:
    virtual ~InterfaceLaw() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Refuses entries that contradict each other; @p place names their
     *  section. */
    virtual void
    check(const std::string &) const
    {}

    /** Whether the cracks of a bond propagate from their tips. */
    virtual bool
    grows_from_tips() const
    {
      return false;
    }

    /** Factor on the strength of an intact point beside a cracked one.
     *  @param distance between them [m]
     *  @param young_modulus of the softer side [Pa] */
    virtual double
    tip_strength(const double /*distance*/,
                 const double /*young_modulus*/) const
    {
      return 1.;
    }

    /** Strength in the step that follows this history. */
    virtual InterfaceStrength
    strength(const InterfaceHistory &history) const = 0;
  };
} // namespace Voussoir

#endif
