#ifndef voussoir_constraints_contact_solver_h
#define voussoir_constraints_contact_solver_h

#include <voussoir/constraints/contact_points.h>

#include <cmath>

namespace Voussoir
{
  /**
   * Contact of clusters of coincident nodes at the end of a step: finds the
   * forces that keep the predicted motion from penetration and from any slip
   * and opening that the laws do not admit. The solution is exact, without
   * penalty: a cluster of two nodes is solved in closed form; others by their
   * dense system if nothing slips or opens, else by projected Gauss-Seidel over
   * their points and, where that converges slowly, Newton's iteration; where
   * these do not converge, by homotopy (see contact_homotopy.h).
   *
   * Keeps the Delassus operators of points and the compliances of nodes from
   * the last `prepare_step`.
   */
  class ContactSolver
  {
  public:
    /**
     * @param inverse_mass of each node: a momentum p changes its velocity by
     *   H p; zero where fixed
     */
    void
    prepare_step(ContactPoints                           &contact,
                 const std::vector<dealii::Tensor<2, 3>> &inverse_mass,
                 const double                             time_step);

    /** Statistics of a solve. */
    struct Effort
    {
      double       penetration = 0.; // largest after the step [m]
      double       residual    = 0.; // change of force in the last sweep, rel.
      unsigned int sweeps      = 0;  // largest
      unsigned long long all_sweeps = 0, clusters = 0; // with sweeps
      unsigned long long paths = 0; // clusters that needed an iteration
      unsigned long long unsolved =
        0; // clusters whose forces violate their laws
    };

    /**
     * @param displacement predicted motion of the nodes; corrected
     * @param force        on the nodes [N]
     */
    Effort
    solve(ContactPoints                     &contact,
          std::vector<dealii::Tensor<1, 3>> &displacement,
          std::vector<dealii::Tensor<1, 3>> &force);

    /** Share of the bars at a point in dt^2 lambda / 4, which must stay below
     *  one for stability. */
    double
    bar_share_of_stable_step(const ContactPoints &contact,
                             const unsigned int   point) const;

  private:
    using Points = std::vector<ContactPoint>;

    struct Cluster : ContactPoints::Cluster
    {
      // Delassus operator of all points, and its pseudo-inverse: the forces
      // that close all points without slip are minus the stiffness times the
      // gaps
      std::vector<double> delassus, stiffness;

      // forces over the root of the area, orthonormal, that move no node
      std::vector<std::vector<double>> self_equilibrated;
    };

    /** The gap less the slip at the last stick, which the contact force has to
     * remove. */
    static dealii::Tensor<1, 3>
    gap_to_hold(const ContactPoint         &point,
                const dealii::Tensor<1, 3> &relative);

    /** Size of the tangential part; std::hypot guards against overflow, at ten
     * times the cost. */
    static double
    tangential_norm(const dealii::Tensor<1, 3> &v)
    {
      return std::sqrt(v[1] * v[1] + v[2] * v[2]);
    }

    /** Finds the contact force of a point from the gap without this force;
     *  before its interface is grouted the force is zero. */
    void
    solve_point(ContactPoint               &point,
                const unsigned int          number,
                const dealii::Tensor<1, 3> &gap);

    /** Finds the contact forces of a cluster. */
    void
    solve_cluster(Points                                  &points,
                  const Cluster                           &cluster,
                  const std::vector<dealii::Tensor<1, 3>> &displacement,
                  Effort                                  &effort);

    /** Finds the gaps of a cluster without its contact forces; returns whether
     *  all its points stuck in the step before. */
    bool
    find_gaps(const Points                            &points,
              const Cluster                           &cluster,
              const std::vector<dealii::Tensor<1, 3>> &displacement);

    /** Tries the forces that keep all points of a cluster closed and sticking;
     * returns whether these are within the limits. */
    bool
    hold_all(Points &points, const Cluster &cluster);

    /** Adds the effect of a force on a point to the motion of a cluster's
     * nodes. */
    void
    add_to_moves(const Cluster              &cluster,
                 const ContactPoint         &point,
                 const dealii::Tensor<1, 3> &force);

    /** Change of a point's gap by the motion of the cluster's nodes. */
    dealii::Tensor<1, 3>
    relative_move(const Cluster &cluster, const ContactPoint &point) const;

    /** Finds the motion of a cluster's nodes under the forces of its points. */
    void
    find_moves(const Points &points, const Cluster &cluster);

    /** Changes by a sweep over the points of a cluster. */
    struct Sweep
    {
      double change  = 1.; // largest of a force [N]
      double largest = 0.; // force [N]
      double moved   = 1.; // by the largest change [m]
    };

    /** Solves the points of a cluster one after the other. */
    Sweep
    sweep(Points &points, const Cluster &cluster);

    /** Finds the forces of a cluster for which the sweeps have failed.
     *  @param size of the displacement of its nodes */
    void
    follow_path(Points        &points,
                const Cluster &cluster,
                const double   size,
                Effort        &effort);

    /** A sweep after Newton's iteration, which is undone if this sweep changes
     *  more than the one @p before. */
    Sweep
    sweep_after_jump(Points        &points,
                     const Cluster &cluster,
                     const Sweep   &before);

    /** Newton's iteration for the forces of a cluster together. */
    void
    iterate_newton(Points        &points,
                   const Cluster &cluster,
                   const double   largest_force);

    /** Delassus operator of a point times a force in its frame [m]. */
    dealii::Tensor<1, 3>
    relative_motion(const unsigned int          number,
                    const dealii::Tensor<1, 3> &force) const;

    /** Compliance of a node times a force [m]. */
    dealii::Tensor<1, 3>
    motion(const unsigned int node, const dealii::Tensor<1, 3> &force) const;

    /** One step of Newton's iteration; returns the largest change of a
     *  component, or zero if the linear system is singular [N]. */
    double
    newton_step(Points &points, const Cluster &cluster);

    void
    make_matrices(const Points &points, Cluster &cluster) const;

    /** Replaces the forces of a cluster by those of the most even stresses
     *  with the same motion, as far as the laws admit.
     *  @param smallest_slip below which a point sticks [m] */
    void
    remove_self_equilibrated(Points        &points,
                             const Cluster &cluster,
                             const double   smallest_slip);

    /** Updates the history of a point, whose interface is grouted, by the
     * motion after the step; returns the penetration. */
    double
    update(ContactPoints                           &contact,
           ContactPoint                            &point,
           const std::vector<dealii::Tensor<1, 3>> &displacement);

    std::vector<Cluster> clusters; // of several points

    double time_step = 0.;
    // compliance of a node: inverse mass times the time step squared [m/N];
    // where it is no multiple of the identity, minus one and in the full matrix
    std::vector<double>               node_compliance, point_delassus;
    std::vector<dealii::Tensor<2, 3>> node_matrix;
    std::vector<DelassusOperator>     point_operator;
    std::vector<unsigned int>         operator_of_point;

    // of the present cluster: gaps without contact forces, motion of its nodes,
    // forces that may come to be those of its points
    std::vector<dealii::Tensor<1, 3>> gaps, moves;
    std::vector<ContactForce>         candidates;
  };
} // namespace Voussoir

#endif
