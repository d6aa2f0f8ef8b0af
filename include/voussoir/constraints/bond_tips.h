#ifndef voussoir_constraints_bond_tips_h
#define voussoir_constraints_bond_tips_h

#include <voussoir/constraints/interface_points.h>

#include <functional>

namespace Voussoir
{
  /**
   * Tips of cracks along bonded interfaces. The cells beside a tip average the
   * high stress there: with the strength of the bond at each node, a crack
   * propagates at too high a load where nodes are not much nearer to each other
   * than E Gf / ft^2. Hence an intact point beside a cracked one has the
   * strength that its law gives this distance (InterfaceLaw::tip_strength), and
   * keeps it when it cracks; all others have the strength of the bond.
   *
   * Cracks propagate along the faces of a surface, across others if these are
   * bonded, too, and from the end of another interface between the same bodies
   * that has no bond or has cracked.
   */
  class BondTips
  {
  public:
    /** Throws UserError, on all ranks, if these are more surfaces than it can
     *  tell apart.
     *  @param young_modulus of a cell [Pa] */
    BondTips(const Discretization                            &discretization,
             InterfacePoints                                 &points,
             const std::function<double(const Grid::Cell &)> &young_modulus);

    /** Smallest factor on the strength at a tip, on all ranks. */
    double
    smallest_factor(const InterfacePoints &points) const;

    /** Finds new cracks after every fourth step, and weakens the intact points
     *  at their tips. Called on all ranks. */
    void
    update(const unsigned long long step, InterfacePoints &points);

  private:
    /** A node on the first side of a surface, and one beside it. */
    struct Neighbour
    {
      unsigned int surface;
      unsigned int node;      // among the owned nodes of the contact
      unsigned int component; // of the surface at this node
      unsigned int beside;    // first entry of the other node in `sets`
      double       distance;  // of nodes of degree one in rows as wide [m]
    };

    void
    find_moduli(const Discretization                            &discretization,
                InterfacePoints                                 &points,
                const std::function<double(const Grid::Cell &)> &young_modulus);

    void
    find_pairs(const InterfacePoints &points);

    void
    find_neighbours(const Discretization &discretization,
                    InterfacePoints      &points);

    /** The distance of each point from the farthest of its neighbours in a set;
     *  0: none is in it [m]. */
    std::vector<double>
    distances(InterfacePoints &points, const std::vector<bool> &set);

    std::vector<double>       modulus; // of the softer side of each point [Pa]
    std::vector<unsigned int> component; // of each point's surface at its node
    std::vector<double>       farthest;  // neighbour of each point [m]
    std::vector<double>       tip;       // distance of a cracked neighbour [m]
    std::vector<Neighbour>    neighbours;
    // pairs of points: of one surface at a place where cracks cross another
    // one; of which the second continues the surface of the first
    std::vector<std::array<unsigned int, 2>> twins, continued;
    Vector                                   sets; // of surfaces, of each node
    unsigned int n_cracked = 0;                    // points, at the last look
  };
} // namespace Voussoir

#endif
