#include <voussoir/fem/trilinear_cells.h>

namespace Voussoir
{
  using namespace dealii;

  template <template <typename> class Shape>
  void
  TrilinearCells<Shape>::reinit(const unsigned int batch)
  {
    nodes.reinit(batch);
    entries = matrix_free.node_entries[batch];
    // the next batch is prefetched meanwhile
    if (entries != nullptr)
      for (unsigned int i = 0; i < 8 * Lanes::size(); i += 16)
        __builtin_prefetch(entries + 24 * Lanes::size() + i);
    std::array<Lanes, 24> corners;
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int d = 0; d < 3; ++d)
        corners[8 * d + v] = matrix_free.corners[batch][v][d];
    Shape<Lanes>::reinit(corners);
  }


  template <template <typename> class Shape>
  void
  TrilinearCells<Shape>::read_dof_values(const Vector &vector)
  {
    if (entries == nullptr)
      {
        nodes.read_dof_values(vector);
        return;
      }
    Lanes *values = nodes.begin_dof_values();
    for (unsigned int v = 0; v < 8; ++v)
      {
        // one more than needed
        std::array<Lanes, 4> components;
        vectorized_load_and_transpose(4,
                                      vector.begin(),
                                      entries + v * Lanes::size(),
                                      components.data());
        for (unsigned int d = 0; d < 3; ++d)
          values[8 * d + v] = components[d];
      }
  }


  template <template <typename> class Shape>
  void
  TrilinearCells<Shape>::distribute_local_to_global(Vector &vector)
  {
    if (entries == nullptr)
      {
        nodes.distribute_local_to_global(vector);
        return;
      }
    std::array<unsigned int, Lanes::size()> places;
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      places[lane] = 4 * lane;
    const Lanes *values = nodes.begin_dof_values();
    for (unsigned int v = 0; v < 8; ++v)
      {
        const std::array<Lanes, 4> components{
          {values[v], values[8 + v], values[16 + v], Lanes(0.)}};
        std::array<double, 4 * Lanes::size()> by_lane;
        vectorized_transpose_and_store(
          false, 4, components.data(), places.data(), by_lane.data());
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            double *node = vector.begin() + entries[v * Lanes::size() + lane];
            for (unsigned int d = 0; d < 3; ++d)
              node[d] += by_lane[4 * lane + d];
          }
      }
  }


  template class TrilinearCells<OnePointShape>;
  template class TrilinearCells<EightPointShape>;
} // namespace Voussoir
