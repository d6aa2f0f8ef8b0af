#ifndef voussoir_constraints_contact_equations_h
#define voussoir_constraints_contact_equations_h

#include <voussoir/constraints/contact_law_line.h>
#include <voussoir/constraints/solution_line.h>

#include <array>
#include <vector>

namespace Voussoir
{
  /**
   * The equations H(x, t) = 0 of the contact of points that share nodes (see
   * contact_homotopy.h), each point on a segment of its law's line, in stick or
   * slip. The unknowns x are, for each point, the place z on its law's line and
   * the trial y = F_t - stiffness g_t of the shear; the last unknown is t.
   *
   * Units are such that the largest gap without forces and the largest diagonal
   * entry of the Delassus operator are one.
   */
  struct ContactEquations
  {
    using Vector = Dense::Vector;

    /** @param cap limit of strength in place of infinity */
    ContactEquations(const std::vector<double>               &given_delassus,
                     const std::vector<dealii::Tensor<1, 3>> &given_gaps,
                     const std::vector<ContactLimits>        &limits,
                     const double                             round_off_of_gaps,
                     const double                             cap);

    /** Force and gap of a point, with derivatives by its unknowns and t. */
    struct State
    {
      dealii::Tensor<1, 3>                force, gap;
      std::array<dealii::Tensor<1, 3>, 4> force_by, gap_by;
    };

    /** Where a piece of the path ends: t is one, or a point leaves its segment
     *  or changes between stick and slip. */
    struct End
    {
      enum Kind
      {
        time,
        opening,
        closing,
        shear
      } kind;
      unsigned int point;
    };

    State
    state(const unsigned int k, const Vector &x) const;

    std::vector<State>
    states(const Vector &x) const;

    /** Largest shear of a point. */
    double
    limit(const unsigned int k, const Vector &x) const;

    /** Gaps that the compliance of the points causes, to be removed. */
    Vector
    softening(const Vector &x) const;

    /** H, with the terms of the homotopy or without them. */
    Vector
    residual(const Vector &x, const bool of_homotopy) const;

    /** The solutions of the linearised equations. */
    Dense::Line
    linearize(const Vector &x) const;

    std::vector<End>
    ends() const;

    /** Positive on the present piece. */
    double
    way_to(const End &end, const Vector &x, Vector &gradient) const;

    double
    way_to(const End &end, const Vector &x) const;

    const unsigned int           n; // forces
    Vector                       delassus, gaps;
    std::vector<ContactLawPoint> points;
    double                       force_unit = 1.;

    // the gaps of the path are wider by (1 - t) widening + shift, the bonds
    // weaker by (1 - t) bond_slope
    Vector widening, shift;
    double bond_slope = 0., softness = 0.;
  };
} // namespace Voussoir

#endif
