#ifndef voussoir_constraints_contact_points_h
#define voussoir_constraints_contact_points_h

#include <voussoir/constraints/contact_point.h>

#include <vector>

namespace Voussoir
{
  /** Energy that a surface has taken since the start [J]; the work of contact
   * on the bodies is minus the sum. */
  struct ContactEnergy
  {
    double impact = 0., friction = 0., bond = 0., bars = 0., uplift = 0.;
  };

  /** Data common to the points of a surface (one joint, one plane). */
  struct ContactSurface
  {
    const InterfaceLaw *law = nullptr;

    double key_depth = 0.;    // no slip while the opening is below [m]
    bool   tied      = false; // once grouted, under any law

    // bars across the surface, elastic and perfectly plastic, per area
    double bar_stiffness = 0.; // [Pa/m]
    double bar_strength  = 0.; // [Pa]

    ContactEnergy energy;
  };


  /**
   * The points of surfaces in contact, which share nodes where surfaces cross:
   * their gaps, their resistance by their laws and the forces of bars. The
   * contact forces are found by ContactSolver in a step of time and by
   * StaticContact in the static state.
   *
   * Independent of mesh and ranks: its nodes are those of the clusters of one
   * rank.
   */
  class ContactPoints
  {
  public:
    explicit ContactPoints(const std::vector<ContactSurface> &surfaces = {});

    /** Adds the points of a cluster, whose nodes are the next @p n_nodes ones.
     *  Clusters of one point come first. */
    void
    add_cluster(const unsigned int               n_nodes,
                const std::vector<ContactPoint> &points);

    unsigned int
    n_nodes() const;

    /** Points that are a cluster of their own, which are the first ones. */
    unsigned int
    n_single() const;

    /** A cluster: nodes and points that are solved together. */
    struct Cluster
    {
      unsigned int first_node, n_nodes, first_point, n_points;
    };

    /** The clusters of several points. */
    const std::vector<Cluster> &
    clusters() const;

    /** Sets gaps to those of a displacement; keys and bars follow the gaps. */
    void
    find_gaps(const std::vector<dealii::Tensor<1, 3>> &displacement);

    /** Sets gaps and velocities to those of a state. */
    void
    start(const std::vector<dealii::Tensor<1, 3>> &displacement,
          const std::vector<dealii::Tensor<1, 3>> &velocity);

    /** Evaluates the strengths and bars after the history of a point has been
     *  set. */
    void
    update_limits(ContactPoint &point) const;

    /** Sets q to the present pressure. */
    void
    catch_up_with_pressure(ContactPoint &point) const;

    /** Lets the bars at a point flow if its gap has stretched them beyond their
     * yield strain. */
    void
    yield_bars(ContactPoint &point) const;

    /** All forces on the second node of a point, in global coordinates [N].
     */
    static dealii::Tensor<1, 3>
    total_force(const ContactPoint &point);

    std::vector<ContactSurface> surfaces;
    std::vector<ContactPoint>   points;

  private:
    unsigned int         number_of_nodes = 0, number_of_single = 0;
    std::vector<Cluster> clusters_of_several;
  };
} // namespace Voussoir

#endif
