#include <voussoir/fem/single_nodes.h>

// GCC 12 finds "uninitialized" variables in its own AVX-512 intrinsics.
#pragma GCC diagnostic ignored "-Wuninitialized"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int width = Lanes::size();

    // Three components of a node and one entry more, which is not used.
    typedef double Doubles4 __attribute__((vector_size(32)));
    typedef float  Floats4 __attribute__((vector_size(16)));

    Doubles4
    load(const double *entries)
    {
      Doubles4 result;
      std::memcpy(&result, entries, sizeof(result));
      return result;
    }


    // Places of the cells' entries in a buffer with four entries per cell.
    constexpr std::array<unsigned int, 2 * width>
    places_in_buffer()
    {
      std::array<unsigned int, 2 * width> places{};
      for (unsigned int lane = 0; lane < 2 * width; ++lane)
        places[lane] = 4 * lane;
      return places;
    }
    constexpr auto places = places_in_buffer();


    // Four values of each cell, for each of the eight nodes.
    using Buffers = std::array<std::array<float, 8 * width>, 8>;
  } // namespace


  void
  SingleNodes::reinit(const unsigned int batch, const unsigned int n)
  {
    first_batch = batch;
    n_batches   = n;
    for (unsigned int i = 0; i < 2; ++i)
      {
        entries[i] = matrix_free.node_entries[batch + (i < n ? i : 0)];
        // prefetches entries of the next two batches
        if (entries[i] != nullptr)
          for (unsigned int k = 0; k < 8 * width; k += 16)
            __builtin_prefetch(entries[i] + 16 * width + k);
      }
    const auto *next = corners->data() + batch + 2;
    for (unsigned int k = 0; k < 2 * sizeof(*next); k += 64)
      __builtin_prefetch(reinterpret_cast<const char *>(next) + k);
  }


  void
  SingleNodes::read_corners(Values &values) const
  {
    const auto &first  = (*corners)[first_batch],
               &second = (*corners)[first_batch + n_batches - 1];
    for (unsigned int k = 0; k < 24; ++k)
      values[k] = singles_of(first[k], second[k]);
  }


  SingleNodes::Half
  SingleNodes::half_of(const Vector &vector, const unsigned int half)
  {
    by_batch.reinit(first_batch + (half < n_batches ? half : 0));
    by_batch.read_dof_values(vector);
    Half result;
    std::copy_n(by_batch.begin_dof_values(), 24, result.begin());
    return result;
  }


  template <typename Load, typename LoadHalf>
  void
  SingleNodes::read_relative(Values         &values,
                             const Load     &load,
                             const LoadHalf &load_half)
  {
    if (entries[0] == nullptr || entries[1] == nullptr)
      {
        const std::array<Half, 2> halves{{load_half(0), load_half(1)}};
        for (unsigned int k = 0; k < 24; ++k)
          values[k] = singles_of(halves[0][k] - halves[0][k / 8 * 8],
                                 halves[1][k] - halves[1][k / 8 * 8]);
        return;
      }
    alignas(64) Buffers buffers;
    for (unsigned int lane = 0; lane < 2 * width; ++lane)
      {
        const unsigned int *of_lane = entries[lane / width] + lane % width;
        const Doubles4      first   = load(of_lane[0]);
        for (unsigned int v = 1; v < 8; ++v)
          {
            const Floats4 difference =
              __builtin_convertvector(load(of_lane[v * width]) - first,
                                      Floats4);
            std::memcpy(buffers[v].data() + 4 * lane,
                        &difference,
                        sizeof(difference));
          }
      }
    for (unsigned int d = 0; d < 3; ++d)
      values[8 * d] = 0.f;
    for (unsigned int v = 1; v < 8; ++v)
      {
        std::array<Singles, 4> components;
        vectorized_load_and_transpose(4,
                                      buffers[v].data(),
                                      places.data(),
                                      components.data());
        for (unsigned int d = 0; d < 3; ++d)
          values[8 * d + v] = components[d];
      }
  }


  void
  SingleNodes::read(Values &values, const Vector &vector)
  {
    const double *x = vector.begin();
    read_relative(
      values,
      [x](const unsigned int i) { return load(x + i); },
      [&](const unsigned int half) { return half_of(vector, half); });
  }


  void
  SingleNodes::read(Values       &values,
                    const Vector &vector,
                    const Vector &other,
                    const double  factor)
  {
    const double *x = vector.begin(), *y = other.begin();
    read_relative(
      values,
      [x, y, factor](const unsigned int i) {
        return load(x + i) + factor * load(y + i);
      },
      [&](const unsigned int half) {
        Half       result = half_of(vector, half);
        const Half more   = half_of(other, half);
        for (unsigned int k = 0; k < 24; ++k)
          result[k] += factor * more[k];
        return result;
      });
  }


  void
  SingleNodes::add_half(Vector            &vector,
                        const Values      &values,
                        const unsigned int half)
  {
    by_batch.reinit(first_batch + half);
    for (unsigned int k = 0; k < 24; ++k)
      by_batch.begin_dof_values()[k] = half_of_singles(values[k], half);
    by_batch.distribute_local_to_global(vector);
  }


  void
  SingleNodes::add_to(Vector &vector, const Values &values)
  {
    if (n_batches < 2 || entries[0] == nullptr || entries[1] == nullptr)
      {
        for (unsigned int half = 0; half < n_batches; ++half)
          add_half(vector, values, half);
        return;
      }
    alignas(64) Buffers buffers;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const std::array<Singles, 4> components{
          {values[v], values[8 + v], values[16 + v], Singles(0.f)}};
        vectorized_transpose_and_store(
          false, 4, components.data(), places.data(), buffers[v].data());
      }
    // In the order of the nodes, so that no entry is read that has just been
    // stored; and without the fourth entry, whose node may have just been
    // stored.
    double *sums = vector.begin();
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int lane = 0; lane < 2 * width; ++lane)
        {
          double *node = sums + entries[lane / width][v * width + lane % width];
          const float *force = buffers[v].data() + 4 * lane;
          for (unsigned int d = 0; d < 3; ++d)
            node[d] += force[d];
        }
  }
} // namespace Voussoir
