#ifndef voussoir_base_keyed_values_h
#define voussoir_base_keyed_values_h

#include <cstdint>
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
  };
} // namespace Voussoir

#endif
