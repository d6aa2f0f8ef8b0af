#ifndef voussoir_constraints_contact_homotopy_h
#define voussoir_constraints_contact_homotopy_h

#include <voussoir/constraints/contact_point.h>

#include <vector>

namespace Voussoir
{
  /** Forces of points that share nodes. */
  struct ContactForces
  {
    std::vector<ContactForce> points;

    /** Largest difference between the gaps that these forces cause and those
     * that the laws admit under the forces, over the largest penetration or
     * slip without forces; one if no solution was found. */
    double residual;
  };

  /** Forces with a larger residual do not solve their contact. */
  constexpr double unsolved_contact = 1e-9;

  /**
   * Solves the contact of points that share nodes: the gaps after the step are
   *   g = b + W F .
   *
   * The law of a point is that of `solve_contact`. Where a point opens, the
   * line of normal force over opening has a corner; there the cohesion falls
   * from its full value to zero, so that a point that would open with full
   * cohesion and close without any stays closed with a part of it. Opening,
   * normal force and limit of the shear are then continuous functions of one
   * number z, and slip and shear continuous functions of their trial: 3 n
   * equations H(x) = 0 in as many unknowns.
   *
   * These equations have a solution. Let the gaps be wider by (1 - t) K, and
   * let the shear resistance of bonds across an opening be t times as large.
   * For large K all points are then open at t = 0, which is the only solution.
   * All solutions are bounded: the state before the step is admissible (nothing
   * penetrates or slips), and from there the forces can do no more work than
   * the bonds store, so that in the norm of the masses the nodes are not much
   * farther from the predicted motion than in that state. Hence a connected set
   * of solutions leads from t = 0 to t = 1 (Leray and Schauder).
   *
   * It is a curve of smooth pieces, on each of which every point is open or
   * closed and sticks or slips. The curve is followed from piece to piece in
   * the direction in which the determinant keeps its sign, as in Lemke's
   * algorithm for the linear case; it may turn back in t, since Coulomb
   * friction may have several solutions.
   *
   * W is singular where nodes are fixed or the contact constraints are linearly
   * dependent; forces are then not bounded, but the motion still is. The points
   * get a small compliance, whose effect on the solution is then removed by
   * iteration (proximal point method). Round-off may lose the path; it is then
   * sought from other starts.
   *
   * @param delassus    W, the Delassus operator, row by row [m/N]
   * @param gaps        b; their tangential parts are the slip since the last
   *   stick
   * @param round_off of gaps; a residual of this size counts as solved
   */
  ContactForces
  solve_contact(const std::vector<double>               &delassus,
                const std::vector<dealii::Tensor<1, 3>> &gaps,
                const std::vector<ContactLimits>        &limits,
                const double                             round_off);
} // namespace Voussoir

#endif
