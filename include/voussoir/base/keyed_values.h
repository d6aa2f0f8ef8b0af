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
   * Numbers of the state that a checkpoint holds besides nodal vectors: groups
   * of @p width numbers, each with a key that does not depend on the ranks (see
   * Grid::global_key). Two ranks may hold the same group if they agree on its
   * numbers.
   */
  struct KeyedValues
  {
    unsigned int                                    width;
    std::vector<std::pair<std::uint64_t, double *>> items;

    /** Copy the numbers of an item to a row and back, where they are not
     *  contiguous in memory; the pointers of the items are then null. */
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
