#include <voussoir/fem/batch_nodes.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int width = Lanes::size();
  } // namespace


  void
  BatchNodes::reinit(const unsigned int batch)
  {
    entries = matrix_free.node_entries[batch];
    if (entries == nullptr)
      by_library.reinit(batch);
    else // the next batch is prefetched meanwhile
      for (unsigned int i = 0; i < 8 * width; i += 16)
        __builtin_prefetch(entries + 8 * width + i);
  }


  void
  BatchNodes::read_dof_values(const Vector &vector)
  {
    if (entries == nullptr)
      {
        by_library.read_dof_values(vector);
        return;
      }
    for (unsigned int v = 0; v < 8; ++v)
      {
        // the fourth is not used
        std::array<Lanes, 4> components;
        vectorized_load_and_transpose(4,
                                      vector.begin(),
                                      entries + v * width,
                                      components.data());
        for (unsigned int d = 0; d < 3; ++d)
          begin_dof_values()[8 * d + v] = components[d];
      }
  }


  void
  BatchNodes::distribute_local_to_global(Vector &vector)
  {
    if (entries == nullptr)
      {
        by_library.distribute_local_to_global(vector);
        return;
      }
    std::array<unsigned int, width> places;
    for (unsigned int lane = 0; lane < width; ++lane)
      places[lane] = 4 * lane;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const std::array<Lanes, 4>    components{{begin_dof_values()[v],
                                                  begin_dof_values()[8 + v],
                                                  begin_dof_values()[16 + v],
                                                  Lanes(0.)}};
        std::array<double, 4 * width> by_lane;
        vectorized_transpose_and_store(
          false, 4, components.data(), places.data(), by_lane.data());
        for (unsigned int lane = 0; lane < width; ++lane)
          {
            double *node = vector.begin() + entries[v * width + lane];
            for (unsigned int d = 0; d < 3; ++d)
              node[d] += by_lane[4 * lane + d];
          }
      }
  }
} // namespace Voussoir
