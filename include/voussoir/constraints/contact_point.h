#ifndef voussoir_constraints_contact_point_h
#define voussoir_constraints_contact_point_h

#include <voussoir/constraints/interface_law.h>

#include <deal.II/base/tensor.h>

#include <array>

namespace Voussoir
{
  enum class ContactStatus : unsigned char
  {
    open,
    sliding, // closed, shear at its limit
    sticking // closed
  };

  /** What a contact point bears in a step, as forces. */
  struct ContactLimits
  {
    double tension = 0., bond = 0., cohesion = 0.; // [N]
    double friction = 0.;
    double opening  = 0.;    // largest so far, an intact bond has none [m]
    bool   locked   = false; // no slip (shear keys)

    // friction follows the pressure with a delay (see ContactPoint): what it
    // bears under that of before [N], and its part of that of now
    double lasting = 0., at_once = 1.;

    /** Normal force at which it opens [N]; an opened bond has its tension open
     *  only. */
    double
    opening_force() const
    {
      return opening > 0. ? 0. : -tension;
    }

    /** Largest shear force of a closed point without pressure, less its bond
     *  [N], and how this grows with the pressure. */
    double
    without_pressure() const
    {
      return cohesion + lasting;
    }

    double
    with_pressure() const
    {
      return at_once * friction;
    }

    /** Largest shear force under this normal force [N]. */
    double
    shear(const bool open, const double normal_force) const;
  };

  /**
   * Flexibility of the two nodes of a point, in the frame of its normal n and
   * the tangents t1, t2: a force F on the second node and -F on the first move
   * them by D F against each other in a step [m/N].
   */
  struct Flexibility
  {
    /** @param full symmetric; singular where nodes are held */
    explicit Flexibility(const dealii::Tensor<2, 3> &full);

    dealii::Tensor<2, 3> full, inverse; // of its range, if singular

    /** Eigenvalues and vectors of the tangential part. */
    std::array<double, 2>               tangential;
    std::array<dealii::Tensor<1, 2>, 2> axes;
  };

  /** Forces between the two nodes of a point, n, t1, t2, on the second [N];
   *  pressure is positive. */
  struct ContactForce
  {
    dealii::Tensor<1, 3> force;
    ContactStatus        status = ContactStatus::open;
  };

  /**
   * Solves the contact of one point exactly: the gap after the step is
   *   g = b + D F ,
   * its normal part with the limits of pressure (g_n >= 0), bond and shear.
   *
   * @param b gap without this force; its tangential part is the slip since the
   *   last stick
   */
  ContactForce
  solve_contact(const dealii::Tensor<1, 3> &b,
                const Flexibility          &flexibility,
                const ContactLimits        &limits);

  /** The same for D = @p flexibility times the identity. */
  ContactForce
  solve_contact(const dealii::Tensor<1, 3> &b,
                const double                flexibility,
                const ContactLimits        &limits);
} // namespace Voussoir

#endif
