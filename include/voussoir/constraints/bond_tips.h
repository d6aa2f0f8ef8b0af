#ifndef voussoir_constraints_bond_tips_h
#define voussoir_constraints_bond_tips_h

#include <voussoir/constraints/interface_points.h>
#include <voussoir/materials/solid.h>

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
     *  tell apart. */
    BondTips(const Solid &solid, InterfacePoints &points);

    /** Smallest factor on the strength at a tip, on all ranks. */
    double
    smallest_factor(const InterfacePoints &points) const;

    /** From now on the moduli are those of the earthquake. */
    void
    begin_earthquake();

    /** Finds new cracks after every fourth step, and weakens the intact points
     *  at their tips. Called on all ranks. */
    void
    update(const unsigned long long step, InterfacePoints &points);

    /** Weakens the intact points at the tips of these cracks in an equilibrium;
     *  those whose stress is higher break. Called on all ranks.
     *  @param cracked of each point, whether a crack has reached it
     *  @return whether there is a weaker point, on any rank */
    bool
    weaken(const std::vector<bool> &cracked, InterfacePoints &points);

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
    find_moduli(const Solid &solid, InterfacePoints &points);

    void
    find_pairs(const InterfacePoints &points);

    void
    find_neighbours(const Discretization &discretization,
                    InterfacePoints      &points);

    /** The distance of each point from the farthest of its neighbours in a set;
     *  0: none is in it [m]. */
    std::vector<double>
    distances(InterfacePoints &points, const std::vector<bool> &set);

    /** Finds the tips of these cracks. */
    void
    find_tips(const std::vector<bool> &cracked, InterfacePoints &points);

    /** Factor on the strength of a point at its tip. */
    double
    strength_at_tip(const unsigned int k, const InterfacePoints &points) const;

    // Young's modulus of the softer side of each point [Pa]
    std::vector<double>       modulus, modulus_at_rest;
    bool                      in_earthquake = false;
    std::vector<unsigned int> component; // of each point's surface at its node
    std::vector<double>       farthest;  // neighbour of each point [m]
    std::vector<double>       tip;       // distance of a cracked neighbour [m]
    std::vector<Neighbour>    neighbours;
    // pairs of points: of one surface at a place where cracks cross another
    // one; of which the second continues the surface of the first
    std::vector<std::array<unsigned int, 2>> twins, continued;
    Vector                                   sets; // of surfaces, of each node
    std::vector<bool> last_cracked;                // points, at the last look
  };
} // namespace Voussoir

#endif
