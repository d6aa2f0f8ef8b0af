#ifndef voussoir_constraints_interface_points_h
#define voussoir_constraints_interface_points_h

#include <voussoir/constraints/contact_exchange.h>
#include <voussoir/constraints/contact_points.h>
#include <voussoir/constraints/interface_parameters.h>

#include <optional>

namespace Voussoir
{
  /**
   * The contact points of all interfaces of a case on this rank: where in the
   * mesh they are, the exchange with the ranks of their nodes, and their
   * changes in the static stages. Contact finds their forces in a step of time,
   * StaticContact in the static state.
   */
  class InterfacePoints : public ContactPoints
  {
  public:
    /** @param interfaces along which the mesh is split; must live as long as
     *  this */
    InterfacePoints(const Discretization       &discretization,
                    const InterfacesParameters &interfaces,
                    const InterfaceSurfaces    &surfaces);

    /** See Contact::set_delay. */
    double
    set_delay(const Discretization                            &discretization,
              const std::function<double(const Grid::Cell &)> &wave_speed);

    /** Applies the uplift of the interfaces whose water comes with one of these
     *  loads. */
    void
    apply_uplift(const std::vector<std::string> &loads);

    /** Joins the interfaces that are grouted after one of these loads; returns
     *  whether there are any. Called on all ranks.
     *  @param displacement from which gap and slip count */
    bool
    grout(const std::vector<std::string> &loads, const Vector &displacement);

    /** Joins all interfaces, for points read from a state in which they were
     *  grouted: bars and uplift act.
     *  @param water see `has_water` */
    void
    join_all(const std::vector<bool> &water);

    /** Whether the sides of a point touch, to a millionth of a cell. */
    bool
    touches(const ContactPoint &point) const;

    ContactExchange &
    exchange();

    const ContactExchange &
    exchange() const;

    MPI_Comm communicator;

    /** Names of the surfaces (face sets of all interfaces). */
    std::vector<std::string> names;

    /** Global nodes of the clusters. */
    std::vector<dealii::types::global_dof_index> cluster_nodes;

    /** Of each point: its position [m], a number that is the same on all
     *  partitions, and the global node on its first side. */
    std::vector<dealii::Point<3>>                positions;
    std::vector<std::uint64_t>                   keys;
    std::vector<dealii::types::global_dof_index> first_nodes;

    /** Whether the uplift of each interface acts. */
    std::vector<bool> has_water;

    /** Smallest side of a cell at the interfaces [m]. */
    double cell_size = 0.;

  private:
    void
    add_points(const Discretization &discretization);

    void
    find_uplift(const Discretization &discretization);

    /** Sets the uplift at the points of an interface if it acts. */
    void
    set_uplift(const unsigned int interface);

    /** Grouts an interface: its sides are in contact from now on; gap and slip
     * count from this displacement of the nodes of the clusters. */
    void
    join(const unsigned int                       interface,
         const std::vector<dealii::Tensor<1, 3>> &displacement);

    const InterfacesParameters    &interfaces;
    std::vector<unsigned int>      interface_of_surface;
    std::optional<ContactExchange> exchange_of_nodes;
    std::vector<bool>              forces_unique; // each point
    std::vector<double>            uplift;        // of each point [Pa]
  };
} // namespace Voussoir

#endif
