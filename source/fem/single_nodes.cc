#include <voussoir/fem/single_nodes.h>

// GCC 12 finds "uninitialized" variables in its own AVX-512 intrinsics.
#pragma GCC diagnostic ignored "-Wuninitialized"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int width = Lanes::size();

    // The three components of a node and one entry more, which is not used: of
    // a cell, of one or two cells, and of every fourth one of the cells.
    constexpr unsigned int n_blocks = has_singles ? width / 2 : 1;
    constexpr unsigned int in_group = n_blocks == 1 ? 1 : 2;
    constexpr unsigned int n_groups = 4 * n_blocks / in_group;
    typedef float          Floats4 __attribute__((vector_size(16)));
    typedef double DoubleGroup __attribute__((vector_size(32 * in_group)));
    typedef float  SingleGroup __attribute__((vector_size(16 * in_group)));
    typedef float  Blocks __attribute__((vector_size(16 * n_blocks)));

    /** The first cell of a group; two cells of a group are four apart. */
    constexpr unsigned int
    first_of_group(const unsigned int group)
    {
      return group / 4 * 8 + group % 4;
    }


    Doubles4
    load(const double *entries)
    {
      Doubles4 result;
      std::memcpy(&result, entries, sizeof(result));
      return result;
    }


    /** The groups @p j and @p j + 4 in single precision, if there are so many.
     */
    template <typename Group>
    Blocks
    blocks_of(const unsigned int j, const Group &group)
    {
      const auto single = [&](const unsigned int k) {
        return __builtin_convertvector(group(k), SingleGroup);
      };
      if constexpr (n_blocks == in_group)
        return single(j);
      else
        return __builtin_shufflevector(single(j),
                                       single(j + 4),
                                       0,
                                       1,
                                       2,
                                       3,
                                       4,
                                       5,
                                       6,
                                       7,
                                       8,
                                       9,
                                       10,
                                       11,
                                       12,
                                       13,
                                       14,
                                       15);
    }


    template <unsigned int i, unsigned int k, std::size_t... n>
    Blocks
    two_of_each(const Blocks &a, const Blocks &b, std::index_sequence<n...>)
    {
      return __builtin_shufflevector(
        a, b, (n / 4 * 4 + (n % 2 == 0 ? i : k) + n % 4 / 2 * 4 * n_blocks)...);
    }

    /** Entries @p i and @p k of each block of @p a, and then of @p b. */
    template <unsigned int i, unsigned int k>
    Blocks
    two_of_each(const Blocks &a, const Blocks &b)
    {
      return two_of_each<i, k>(a, b, std::make_index_sequence<4 * n_blocks>());
    }


    /** Transposes entry k of block b of vector j to entry j of block b of
     * vector k. */
    std::array<Blocks, 4>
    transposed(const std::array<Blocks, 4> &a)
    {
      const Blocks low    = two_of_each<0, 1>(a[0], a[1]),
                   low_2  = two_of_each<0, 1>(a[2], a[3]),
                   high   = two_of_each<2, 3>(a[0], a[1]),
                   high_2 = two_of_each<2, 3>(a[2], a[3]);
      return {{two_of_each<0, 2>(low, low_2),
               two_of_each<1, 3>(low, low_2),
               two_of_each<0, 2>(high, high_2),
               two_of_each<1, 3>(high, high_2)}};
    }
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
    if constexpr (has_singles)
      {
        const auto group = [&](const unsigned int k, const unsigned int v) {
          const auto node = [&](const unsigned int lane) {
            return load(entries[lane / width][v * width + lane % width]);
          };
          const unsigned int lane = first_of_group(k);
          if constexpr (in_group == 1)
            return node(lane);
          else
            return __builtin_shufflevector(
              node(lane), node(lane + 4), 0, 1, 2, 3, 4, 5, 6, 7);
        };
        std::array<DoubleGroup, n_groups> first;
        for (unsigned int k = 0; k < n_groups; ++k)
          first[k] = group(k, 0);
        for (unsigned int d = 0; d < 3; ++d)
          values[8 * d] = 0.f;
        for (unsigned int v = 1; v < 8; ++v)
          {
            const auto difference = [&](const unsigned int k) {
              return group(k, v) - first[k];
            };
            const std::array<Blocks, 4> components =
              transposed({{blocks_of(0, difference),
                           blocks_of(1, difference),
                           blocks_of(2, difference),
                           blocks_of(3, difference)}});
            for (unsigned int d = 0; d < 3; ++d)
              values[8 * d + v].data = components[d];
          }
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
    if constexpr (has_singles)
      {
        std::array<std::array<Blocks, 4>, 8> of_nodes;
        for (unsigned int v = 0; v < 8; ++v)
          of_nodes[v] = transposed({{values[v].data,
                                     values[8 + v].data,
                                     values[16 + v].data,
                                     Blocks{}}});
        double    *sums     = vector.begin();
        const auto of_batch = entries;
        for (unsigned int lane = 0; lane < 2 * width; ++lane)
          for (unsigned int v = 0; v < 8; ++v)
            {
              Floats4 force;
              std::memcpy(&force,
                          reinterpret_cast<const float *>(
                            &of_nodes[v][lane % 4]) +
                            lane / 4 * 4,
                          sizeof(force));
              add_to_node(sums +
                            of_batch[lane / width][v * width + lane % width],
                          __builtin_convertvector(force, Doubles4));
            }
      }
  }
} // namespace Voussoir
