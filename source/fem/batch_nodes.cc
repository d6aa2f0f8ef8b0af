#include <voussoir/fem/batch_nodes.h>

// GCC 12 finds "uninitialized" variables in its own AVX-512 intrinsics.
#pragma GCC diagnostic ignored "-Wuninitialized"

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
    this->batch = batch;
    entries     = matrix_free.node_entries[batch];
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
    read_nodes(vector.begin(), begin_dof_values());
  }


  void
  BatchNodes::read_nodes(const double *vector, Lanes *values) const
  {
    for (unsigned int v = 0; v < 8; ++v)
      {
        // the fourth is not used
        std::array<Lanes, 4> components;
        vectorized_load_and_transpose(4,
                                      vector,
                                      entries + v * width,
                                      components.data());
        for (unsigned int d = 0; d < 3; ++d)
          values[8 * d + v] = components[d];
      }
  }


  void
  BatchNodes::read_corners(MatrixFree::Corners &corners) const
  {
    const unsigned int place = matrix_free.place_of_own_corners[batch];
    if (place != numbers::invalid_unsigned_int)
      corners = matrix_free.own_corners[place];
    else
      read_nodes(matrix_free.positions.data(), corners.data());
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
    std::array<std::array<double, 4 * width>, 8> of_nodes;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const std::array<Lanes, 4> components{{begin_dof_values()[v],
                                               begin_dof_values()[8 + v],
                                               begin_dof_values()[16 + v],
                                               Lanes(0.)}};
        vectorized_transpose_and_store(
          false, 4, components.data(), places.data(), of_nodes[v].data());
      }
    double             *sums     = vector.begin();
    const unsigned int *of_batch = entries;
    for (unsigned int lane = 0; lane < width; ++lane)
      for (unsigned int v = 0; v < 8; ++v)
        {
          Doubles4 numbers;
          std::memcpy(&numbers, &of_nodes[v][4 * lane], sizeof(numbers));
          add_to_node(sums + of_batch[v * width + lane], numbers);
        }
  }
} // namespace Voussoir
