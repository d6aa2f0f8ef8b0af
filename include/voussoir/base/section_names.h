#ifndef voussoir_base_section_names_h
#define voussoir_base_section_names_h

#include <string>
#include <vector>

namespace Voussoir
{
  /** Refuses a list of names of sections that is too long, has a name twice or
   *  has a name with "/"; @p place is where the list stands. */
  void
  check_section_names(const std::vector<std::string> &names,
                      const std::string              &place);
} // namespace Voussoir

#endif
