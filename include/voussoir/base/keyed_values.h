#ifndef voussoir_base_keyed_values_h
#define voussoir_base_keyed_values_h

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace Voussoir
{
  /**
   * Live numbers that a checkpoint must hold beside nodal vectors, each group
   * of @p width numbers with a key that does not depend on the ranks (see
   * Grid::global_key). Ranks may hold the same group twice if they agree on it.
   */
  struct KeyedValues
  {
    unsigned int                                    width;
    std::vector<std::pair<std::uint64_t, double *>> items;

    /** Copy the numbers of an item to a row and back, where they do not stand
     *  one after the other; the pointers of the items are then null. */
    std::function<void(const std::size_t item, double *row)>       pack   = {};
    std::function<void(const std::size_t item, const double *row)> unpack = {};

    /** The numbers of an item; @p scratch is used where they are packed. */
    const double *
    row(const std::size_t item, std::vector<double> &scratch) const
    {
      if (!pack)
        return items[item].second;
      scratch.resize(width);
      pack(item, scratch.data());
      return scratch.data();
    }

    void
    set(const std::size_t item, const double *row) const
    {
      if (unpack)
        unpack(item, row);
      else
        std::copy(row, row + width, items[item].second);
    }
  };
} // namespace Voussoir

#endif
