#ifndef voussoir_base_section_names_h
#define voussoir_base_section_names_h

#include <string>
#include <vector>

namespace Voussoir
{
  /** Refuses names of sections that the user lists if one stands there twice or
   *  has a "/", or if there are too many; @p place says where the list is. */
  void
  check_section_names(const std::vector<std::string> &names,
                      const std::string              &place);
} // namespace Voussoir

#endif
