#include <voussoir/files/keyed_rows.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Rows that are read in one exchange.
    constexpr std::size_t items_at_once = 1 << 14;

    using Words = std::vector<std::uint64_t>;


    // splitmix64: neighbouring words become uncorrelated
    std::uint64_t
    mixed(std::uint64_t word)
    {
      word += 0x9e3779b97f4a7c15;
      word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9;
      word = (word ^ (word >> 27)) * 0x94d049bb133111eb;
      return word ^ (word >> 31);
    }


    /** Whether a row has only zeros; such rows are not stored. */
    bool
    is_kept(const double *row, const unsigned int width)
    {
      return std::any_of(row, row + width, [](const double x) {
        return x != 0. || std::signbit(x);
      });
    }


    /** Sends items of @p width numbers, @p n_to [r] of them to rank r, in the
     *  order of ranks; returns the received items in the same order. */
    template <typename Number>
    std::vector<Number>
    exchange(const std::vector<Number> &numbers,
             const unsigned int         width,
             const std::vector<int>    &n_to,
             const std::vector<int>    &n_from,
             const MPI_Comm             communicator)
    {
      static_assert(sizeof(Number) == sizeof(std::uint64_t));
      const auto starts = [](const std::vector<int> &n) {
        std::vector<int> result(n.size());
        std::partial_sum(n.begin(), n.end() - 1, result.begin() + 1);
        return result;
      };
      const std::vector<int> to = starts(n_to), from = starts(n_from);
      std::vector<Number>    received(std::size_t(width) *
                                   (from.back() + n_from.back()));
      MPI_Datatype           item;
      MPI_Type_contiguous(width, MPI_UINT64_T, &item);
      MPI_Type_commit(&item);
      MPI_Alltoallv(numbers.data(),
                    n_to.data(),
                    to.data(),
                    item,
                    received.data(),
                    n_from.data(),
                    from.data(),
                    item,
                    communicator);
      MPI_Type_free(&item);
      return received;
    }


    /** Sends each key to a rank that follows from the key alone, so that it is
     *  the same for all ranks that hold the key. */
    struct Addresses
    {
      Addresses(const Words &keys, const MPI_Comm communicator)
        : n_to(Utilities::MPI::n_mpi_processes(communicator))
        , n_from(n_to.size())
      {
        std::vector<std::vector<std::size_t>> places(n_to.size());
        for (std::size_t i = 0; i < keys.size(); ++i)
          places[mixed(keys[i]) % n_to.size()].push_back(i);
        for (std::size_t rank = 0; rank < n_to.size(); ++rank)
          {
            n_to[rank] = places[rank].size();
            order.insert(order.end(), places[rank].begin(), places[rank].end());
          }
        MPI_Alltoall(
          n_to.data(), 1, MPI_INT, n_from.data(), 1, MPI_INT, communicator);
      }

      std::vector<int>         n_to, n_from;
      std::vector<std::size_t> order; // of the sent rows
    };


    template <typename Number>
    std::vector<Number>
    ordered(const std::vector<Number>      &numbers,
            const unsigned int              width,
            const std::vector<std::size_t> &order)
    {
      std::vector<Number> result;
      result.reserve(numbers.size());
      for (const std::size_t i : order)
        result.insert(result.end(),
                      numbers.begin() + i * width,
                      numbers.begin() + (i + 1) * width);
      return result;
    }
  } // namespace


  KeyedRows::KeyedRows(const KeyedValues &values)
    : width(values.width)
  {
    keys.reserve(n_kept_rows(values));
    numbers.reserve(keys.capacity() * width);
    std::vector<double> scratch;
    for (std::size_t i = 0; i < values.items.size(); ++i)
      if (const double *row = values.row(i, scratch); is_kept(row, width))
        {
          keys.push_back(values.items[i].first);
          numbers.insert(numbers.end(), row, row + width);
        }
  }


  std::uint64_t
  KeyedRows::checksum(const MPI_Comm communicator) const
  {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < keys.size(); ++i)
      {
        std::uint64_t of_row = mixed(keys[i]);
        for (unsigned int k = 0; k < width; ++k)
          {
            std::uint64_t bits;
            std::memcpy(&bits, row(i) + k, sizeof(bits));
            of_row = mixed(of_row ^ bits);
          }
        sum += of_row;
      }
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, communicator);
    return sum;
  }


  std::size_t
  n_kept_rows(const KeyedValues &values)
  {
    std::size_t         n = 0;
    std::vector<double> scratch;
    for (std::size_t i = 0; i < values.items.size(); ++i)
      n += is_kept(values.row(i, scratch), values.width);
    return n;
  }


  void
  distribute(const KeyedRows   &rows,
             const KeyedValues &values,
             const MPI_Comm     communicator)
  {
    const unsigned int width = rows.width;
    const Addresses    to_keeper(rows.keys, communicator);
    KeyedRows          kept(width);
    kept.keys    = exchange(ordered(rows.keys, 1, to_keeper.order),
                         1,
                         to_keeper.n_to,
                         to_keeper.n_from,
                         communicator);
    kept.numbers = exchange(ordered(rows.numbers, width, to_keeper.order),
                            width,
                            to_keeper.n_to,
                            to_keeper.n_from,
                            communicator);
    std::unordered_map<std::uint64_t, std::size_t> place;
    for (std::size_t i = 0; i < kept.keys.size(); ++i)
      place[kept.keys[i]] = i;

    // in parts, as most numbers may be zeros, which have no rows
    const std::size_t last =
      Utilities::MPI::max(values.items.size(), communicator);
    for (std::size_t first = 0; first < last; first += items_at_once)
      {
        Words keys;
        for (std::size_t i = first;
             i < std::min(first + items_at_once, values.items.size());
             ++i)
          keys.push_back(values.items[i].first);
        const Addresses     from_keeper(keys, communicator);
        std::vector<double> replies;
        for (const std::uint64_t key :
             exchange(ordered(keys, 1, from_keeper.order),
                      1,
                      from_keeper.n_to,
                      from_keeper.n_from,
                      communicator))
          {
            const auto found = place.find(key);
            if (found == place.end())
              replies.insert(replies.end(), width, 0.);
            else
              replies.insert(replies.end(),
                             kept.row(found->second),
                             kept.row(found->second) + width);
          }
        const auto numbers = exchange(
          replies, width, from_keeper.n_from, from_keeper.n_to, communicator);
        const double *row = numbers.data();
        for (const std::size_t i : from_keeper.order)
          {
            values.set(first + i, row);
            row += width;
          }
      }
  }


  std::uint64_t
  byte_checksum(const std::vector<std::uint8_t> &bytes)
  {
    std::uint64_t sum = bytes.size();
    for (const std::uint8_t byte : bytes)
      sum = mixed(sum ^ byte);
    return sum;
  }
} // namespace Voussoir
