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

  /** Resistance of a contact point in a step, as forces. */
  struct ContactLimits
  {
    double tension = 0., bond = 0., cohesion = 0.; // [N]
    double friction = 0.;
    double opening  = 0.;    // largest so far; zero for an intact bond [m]
    bool   locked   = false; // no slip (shear keys)

    // friction follows the pressure with a delay (see ContactPoint): the shear
    // resistance by earlier pressure [N], and the share of the present pressure
    // that counts at once
    double lasting = 0., at_once = 1.;

    /** Normal force at which the point opens [N]; an opened bond resists
     * tension only across its opening. */
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

  /** A pair of coincident nodes on the two sides of a surface. */
  struct ContactPoint
  {
    unsigned int         surface = 0;
    unsigned int         first = 0, second = 0; // nodes of the solver
    dealii::Tensor<2, 3> frame;       // rows n (first to second), t1, t2
    double               area   = 0.; // [m2]
    double               uplift = 0.; // pressure inside [Pa]

    // until its interface is grouted, its two sides move independently
    bool joined = true;

    /**
     * Friction follows the pressure p by its mean q, dq/dt = (p - q)/T, over a
     * few passages T of waves through a cell. Under a law without this delay
     * sliding of elastic bodies is ill-posed: waves along the interface grow
     * the faster the shorter they are (Renardy 1992; Ranjith and Rice 2001),
     * and the shortest ones of the mesh keep shaking the sliding body. Zero
     * where as many points as nodes meet: there pressure and shear are not
     * unique, and the history must not depend on the choice.
     */
    double delay = 0.; // T [s]

    // gap and slip at zero displacement of its nodes, in the frame [m]
    dealii::Tensor<1, 3> initial_gap;

    // state for a checkpoint, all in the frame
    dealii::Tensor<1, 3>
      force; // on the second node, without uplift and bars [N]
    dealii::Tensor<1, 2> stick_point; // slip at the last stick [m]
    InterfaceHistory     history;
    double               bar_extension = 0.; // plastic [m]
    double               largest_slip  = 0.; // distance from the start [m]
    double               mean_pressure = 0.; // q, as a force [N]

    // part of a change of the pressure that q follows in a step
    double at_once = 1.;

    // the following are computed from the motion
    dealii::Tensor<1, 3> gap;      // opening and slip now [m]
    dealii::Tensor<1, 3> velocity; // of the last half step [m/s]
    ContactStatus        status = ContactStatus::sticking;
    ContactLimits        limits;
    double given_force = 0.; // uplift and bars, apart is positive [N]

    /** Largest shear under the earlier pressure [N], with this coefficient of
     * friction. */
    double
    lasting_friction(const double coefficient) const
    {
      return coefficient * (1. - at_once) * mean_pressure;
    }

    /**
     * The history at the present gap, of a point that had @p before at the
     * beginning of a static stage: searching for equilibrium is no path.
     *
     * @param was_bonded whether a bond, which may have broken since, resisted
     *   shear then; an open point without one does not slip
     * @param distance   from the stick point of the beginning [m]
     */
    InterfaceHistory
    history_since(const InterfaceHistory &before,
                  const bool              was_bonded,
                  const double            distance) const;

    /** Share of the strength of an intact bond that the force uses, in tension
     *  or in shear beyond friction. */
    double
    used_bond() const;
  };


  /**
   * Delassus operator D of a point, in the frame of its normal n and the
   * tangents t1, t2: a force F on the second node and -F on the first change
   * the gap by D F in a step [m/N].
   */
  struct DelassusOperator
  {
    /** @param full symmetric; singular where nodes are fixed */
    explicit DelassusOperator(const dealii::Tensor<2, 3> &full);

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
                const DelassusOperator     &delassus,
                const ContactLimits        &limits);

  /** The same for D = @p delassus times the identity. */
  ContactForce
  solve_contact(const dealii::Tensor<1, 3> &b,
                const double                delassus,
                const ContactLimits        &limits);
} // namespace Voussoir

#endif
