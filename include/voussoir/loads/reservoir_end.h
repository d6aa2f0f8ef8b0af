#ifndef voussoir_loads_reservoir_end_h
#define voussoir_loads_reservoir_end_h

#include <voussoir/base/log.h>
#include <voussoir/fem/acoustic_space.h>
#include <voussoir/loads/channel_modes.h>

namespace Voussoir
{
  /**
   * The section of the reservoir at its radiating end, behind which the far
   * reservoir continues as a channel of this section. All ranks hold the whole
   * section. EndMotion integrates its free field and its modes in time.
   */
  class ReservoirEnd
  {
  public:
    /** Data of the water that ends at the section. */
    struct Water
    {
      double        density, speed;  // rho [kg/m3], c [m/s]
      const Vector &end_areas;       // [m2]
      const Vector &bottom_dashpots; // [m3/(Pa s)]
      const Vector &inverse_storage; // zero at the free surface
      bool          is_channel;      // else plane waves leave
    };

    /** @param is_end of faces of the space */
    ReservoirEnd(const AcousticSpace                &space,
                 const AcousticSpace::FacePredicate &is_end,
                 const Water                        &water,
                 Log                                &log);

    const MPI_Comm communicator;
    const double   density, speed;

    /** By node of the section: its area M [m2], the volume of water that its
     *  unknown stands for [m3], its dashpots of the bottom [m3/(Pa s)], and
     *  whether it lies in the free surface. */
    std::vector<double> areas, volumes, dashpots;
    std::vector<bool>   in_surface;

    /** Owned unknowns of the water in the section. */
    struct Node
    {
      unsigned int water, number;
    };
    std::vector<Node> nodes;

    /** With the losses at the bottom; none where plane waves leave. */
    ChannelModes modes;

    /** (K I)_i of the pressure impulse in the section, with the integral K of
     *  products of gradients [Pa s]. */
    double
    apply_stiffness(const unsigned int         node,
                    const std::vector<double> &impulse) const;

    /** The largest stable time step of the free field [s]. */
    double
    stable_step() const;

  private:
    void
    number_nodes(const AcousticSpace &space, const Water &water);

    void
    assemble(const AcousticSpace                &space,
             const AcousticSpace::FacePredicate &is_end,
             Log                                &log);

    void
    find_modes();

    std::vector<dealii::types::global_dof_index> dof_of_node;
    dealii::SparsityPattern                      pattern;
    dealii::SparseMatrix<double>                 stiffness;
  };
} // namespace Voussoir

#endif
