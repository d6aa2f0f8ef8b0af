#ifndef voussoir_analysis_tied_nodes_h
#define voussoir_analysis_tied_nodes_h

#include <voussoir/constraints/contact.h>

namespace Voussoir
{
  /**
   * Coincident nodes on the sides of interfaces that move as one: in each group
   * one node leads and the others follow. With T, which gives the leaders'
   * displacements to the followers, the tied body has the matrices T^T K T and
   * T^T M T.
   */
  class TiedNodes
  {
  public:
    /** Ties the two nodes of each point for which @p is_tied is true. Called on
     *  all ranks. */
    TiedNodes(const Discretization                            &discretization,
              const Contact                                   &contact,
              const std::function<bool(const ContactPoint &)> &is_tied);

    /** These constraints, and those of the followers: a group is constrained in
     *  each direction in which one of its nodes is. Called on all ranks. */
    dealii::AffineConstraints<double>
    added_to(const dealii::AffineConstraints<double> &constraints) const;

    /** T: followers take the values of their leaders. */
    void
    distribute(Vector &displacement) const;

    /** T^T: the values of followers are added to those of their leaders, and
     * set to zero. */
    void
    collect(Vector &force) const;

  private:
    const Discretization &discretization;

    /** Leader of each follower, global nodes, of all ranks. */
    std::map<dealii::types::global_dof_index, dealii::types::global_dof_index>
      leader_of;

    /** First entry of an owned follower and that of its leader in `shared`. */
    struct Follower
    {
      unsigned int entry, leader;
    };
    std::vector<Follower>     followers;
    std::vector<unsigned int> leaders; // first entries of owned leaders

    mutable Vector shared; // only leaders are used
  };
} // namespace Voussoir

#endif
