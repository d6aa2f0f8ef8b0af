#ifndef voussoir_loads_channel_modes_h
#define voussoir_loads_channel_modes_h

#include <deal.II/lac/sparse_matrix.h>

#include <vector>

namespace Voussoir
{
  /** Modes across a channel: above the cut-off frequency of a mode its wave
   *  travels along the channel. */
  struct ChannelModes
  {
    /** omega [rad/s], ascending. */
    std::vector<double> frequencies;

    /** By node and mode, with s^T M s = 1. */
    std::vector<double> shapes;

    /** Rate of decay by losses across the channel, at most omega [1/s]. */
    std::vector<double> decay;
  };

  /**
   * The lowest solutions of c^2 K s = omega^2 M s by subspace iteration.
   *
   * @param stiffness K [-]
   * @param areas     M, lumped [m2]
   * @param in_surface nodes of the free surface, with s = 0
   * @param speed     c [m/s]
   * @param number    of modes, at most
   * @return modes without decay, the same on every rank
   */
  ChannelModes
  find_channel_modes(const dealii::SparseMatrix<double> &stiffness,
                     const std::vector<double>          &areas,
                     const std::vector<bool>            &in_surface,
                     const double                        speed,
                     const unsigned int                  number);
} // namespace Voussoir

#endif
