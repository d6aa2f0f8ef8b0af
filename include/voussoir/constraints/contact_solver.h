#ifndef voussoir_constraints_contact_solver_h
#define voussoir_constraints_contact_solver_h

#include <voussoir/constraints/contact_point.h>

#include <deal.II/base/point.h>

#include <cmath>
#include <vector>

namespace Voussoir
{
  /** Where the energy of a surface went since the start [J]; what the contact
   *  did on the bodies is minus the sum. */
  struct ContactEnergy
  {
    double impact = 0., friction = 0., bond = 0., bars = 0., uplift = 0.;
  };

  /** What the points of a surface (one joint, one plane) have in common. */
  struct ContactSurface
  {
    const InterfaceLaw *law = nullptr;

    double key_depth = 0.; // no slip while the opening is below [m]

    // bars across the surface, elastic and perfectly plastic, per area
    double bar_stiffness = 0.; // [Pa/m]
    double bar_strength  = 0.; // [Pa]

    ContactEnergy energy;
  };

  /** A pair of coincident nodes on the two sides of a surface. */
  struct ContactPoint
  {
    unsigned int         surface = 0;
    unsigned int         first = 0, second = 0; // nodes of the solver
    dealii::Tensor<2, 3> frame;       // rows n (first to second), t1, t2
    double               area   = 0.; // [m2]
    double               uplift = 0.; // pressure inside [Pa]

    // before its interface is grouted, its sides move as if the other were not
    // there
    bool joined = true;

    /**
     * Friction follows the pressure p by its mean q, dq/dt = (p - q)/T, over
     * some times T in which waves pass a cell. Under a law without this delay
     * sliding of elastic bodies is ill-posed: waves along the interface grow
     * the faster the shorter they are (Renardy 1992; Ranjith and Rice 2001),
     * and the shortest ones of the mesh shake the sliding body on. Zero where
     * as many points as nodes meet: there a pressure may be exchanged for
     * shear, and what hangs on this choice must not be remembered.
     */
    double delay = 0.; // T [s]

    // gap and slip where its nodes have not moved, in the frame [m]
    dealii::Tensor<1, 3> initial_gap;

    // what a checkpoint must hold, all in the frame
    dealii::Tensor<1, 3> force; // on the second node, without the given one [N]
    dealii::Tensor<1, 2> stick_point; // slip at the last stick [m]
    InterfaceHistory     history;
    double               bar_extension = 0.; // plastic [m]
    double               largest_slip  = 0.; // distance from the start [m]
    double               mean_pressure = 0.; // q, as a force [N]

    // part of a change of the pressure that q follows in a step
    double at_once = 1.;

    // these follow from the motion
    dealii::Tensor<1, 3> gap;      // opening and slip now [m]
    dealii::Tensor<1, 3> velocity; // of the last half step [m/s]
    ContactStatus        status = ContactStatus::sticking;
    ContactLimits        limits;
    double given_force = 0.; // uplift and bars, apart is positive [N]
  };

  /**
   * Contact of clusters of coincident nodes at the end of a step: finds the
   * forces that keep the predicted motion from penetration and from slip and
   * opening that the interfaces resist. Exact, without penalty: a cluster of
   * two nodes in closed form, others by their dense system if nothing slips or
   * opens, else by projected Gauss-Seidel over their points and, where that
   * goes slowly, Newton's iteration. Where these do not converge, by following
   * a path that leads to a solution (see contact_path.h).
   *
   * Knows neither mesh nor ranks: its nodes are those of the clusters of one
   * rank.
   */
  class ContactSolver
  {
  public:
    explicit ContactSolver(const std::vector<ContactSurface> &surfaces);

    /** Adds the points of a cluster, whose nodes are the next @p n_nodes ones.
     *  Clusters of one point come first. */
    void
    add_cluster(const unsigned int               n_nodes,
                const std::vector<ContactPoint> &points);

    unsigned int
    n_nodes() const;

    /**
     * @param inverse_mass of each node: a momentum p changes its velocity by
     *   H p; zero where held
     */
    void
    prepare_step(const std::vector<dealii::Tensor<2, 3>> &inverse_mass,
                 const double                             time_step);

    /** Sets gaps to those of a displacement; keys and bars follow them. */
    void
    find_gaps(const std::vector<dealii::Tensor<1, 3>> &displacement);

    /** Sets gaps and velocities to those of a state. */
    void
    start(const std::vector<dealii::Tensor<1, 3>> &displacement,
          const std::vector<dealii::Tensor<1, 3>> &velocity);

    /** What a solve took. */
    struct Effort
    {
      double       penetration = 0.; // largest after the step [m]
      double       residual    = 0.; // change of force in the last sweep, rel.
      unsigned int sweeps      = 0;  // largest
      unsigned long long all_sweeps = 0, clusters = 0; // with sweeps
      unsigned long long paths    = 0; // clusters that needed one
      unsigned long long unsolved = 0; // clusters whose forces break their laws
    };

    /**
     * @param displacement predicted motion of the nodes; corrected
     * @param force        on the nodes [N]
     */
    Effort
    solve(std::vector<dealii::Tensor<1, 3>> &displacement,
          std::vector<dealii::Tensor<1, 3>> &force);

    std::vector<ContactSurface> surfaces;
    std::vector<ContactPoint>   points;

    /** Evaluates the strengths and bars after the history of a point has been
     *  set. */
    void
    update_limits(ContactPoint &point) const;

    /** Sets q to the pressure of now. */
    void
    catch_up_with_pressure(ContactPoint &point) const;

    /** Lets the bars at a point flow that its gap has stretched too far. */
    void
    yield_bars(ContactPoint &point) const;

    /** All that acts on the second node of a point, in global coordinates [N].
     */
    static dealii::Tensor<1, 3>
    total_force(const ContactPoint &point);

    /** Part that the bars at a point may take of dt^2 lambda / 4, which must
     *  stay below one for stability. */
    double
    bar_share_of_stable_step(const unsigned int point) const;

  private:
    struct Cluster
    {
      unsigned int first_node, n_nodes, first_point, n_points;
      // motion of the points under their forces; the forces that hold all
      // points are minus the stiffness times the gaps
      std::vector<double> flexibility, stiffness;
    };

    /** The gap less the slip at the last stick, which is what the contact force
     *  has to undo. */
    static dealii::Tensor<1, 3>
    gap_to_hold(const ContactPoint         &point,
                const dealii::Tensor<1, 3> &relative);

    /** Size of the tangential part; std::hypot minds overflow, at ten times the
     *  cost. */
    static double
    tangential_norm(const dealii::Tensor<1, 3> &v)
    {
      return std::sqrt(v[1] * v[1] + v[2] * v[2]);
    }

    /** Finds the contact force of a point from the gap without it; there is
     *  none before its interface is grouted. */
    void
    solve_point(const unsigned int number, const dealii::Tensor<1, 3> &gap);

    /** Finds the contact forces of a cluster. */
    void
    solve_cluster(const Cluster                           &cluster,
                  const std::vector<dealii::Tensor<1, 3>> &displacement,
                  Effort                                  &effort);

    /** Finds the gaps of a cluster without its contact forces; returns whether
     *  all its points stuck in the step before. */
    bool
    find_gaps(const Cluster                           &cluster,
              const std::vector<dealii::Tensor<1, 3>> &displacement);

    /** Tries the forces that hold all points of a cluster; returns whether
     *  these are within the limits. */
    bool
    hold_all(const Cluster &cluster);

    /** Adds to the motion of a cluster's nodes what a force on a point does. */
    void
    add_to_moves(const Cluster              &cluster,
                 const ContactPoint         &point,
                 const dealii::Tensor<1, 3> &force);

    /** What the motion of a cluster's nodes does to the gap of a point. */
    dealii::Tensor<1, 3>
    relative_move(const Cluster &cluster, const ContactPoint &point) const;

    /** Finds the motion of a cluster's nodes under the forces of its points. */
    void
    find_moves(const Cluster &cluster);

    /** What a sweep over the points of a cluster changed. */
    struct Sweep
    {
      double change  = 1.; // largest of a force [N]
      double largest = 0.; // force [N]
      double moved   = 1.; // by the largest change [m]
    };

    /** Solves the points of a cluster one after the other. */
    Sweep
    sweep(const Cluster &cluster);

    /** Finds the forces of a cluster that the sweeps did not find.
     *  @param size of the displacement of its nodes */
    void
    follow_path(const Cluster &cluster, const double size, Effort &effort);

    /** The same after Newton's iteration, which is undone if the sweep then
     *  changes more than the one @p before. */
    Sweep
    sweep_after_jump(const Cluster &cluster, const Sweep &before);

    /** Newton's iteration for the forces of a cluster together. */
    void
    iterate_newton(const Cluster &cluster, const double largest_force);

    /** Flexibility of a point times a force in its frame. */
    dealii::Tensor<1, 3>
    relative_motion(const unsigned int          number,
                    const dealii::Tensor<1, 3> &force) const;

    /** Flexibility of a node times a force. */
    dealii::Tensor<1, 3>
    motion(const unsigned int node, const dealii::Tensor<1, 3> &force) const;

    /** One step of it; returns the largest change of a component, or zero if
     *  the linear system is singular [N]. */
    double
    newton_step(const Cluster &cluster);

    void
    make_matrices(Cluster &cluster) const;

    /** Takes the motion after the step into the history, that of a joined
     *  point; returns the penetration. */
    double
    update(ContactPoint                            &point,
           const std::vector<dealii::Tensor<1, 3>> &displacement);

    unsigned int         n_single = 0; // points that are a cluster of their own
    unsigned int         number_of_nodes = 0;
    std::vector<Cluster> clusters; // of several points

    double time_step = 0.;
    // inverse mass times the time step squared [m/N]; where it is no multiple
    // of the identity, minus one and in the full matrix
    std::vector<double>               node_flexibility, point_flexibility;
    std::vector<dealii::Tensor<2, 3>> node_matrix;
    std::vector<Flexibility>          point_matrix;
    std::vector<unsigned int>         matrix_of_point;

    // of the cluster at hand: gaps without contact forces, forces that hold its
    // points, motion of its nodes
    std::vector<dealii::Tensor<1, 3>> gaps, holding, moves;
  };
} // namespace Voussoir

#endif
