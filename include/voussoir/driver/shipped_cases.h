#ifndef voussoir_driver_shipped_cases_h
#define voussoir_driver_shipped_cases_h

#include <ostream>
#include <string>

namespace Voussoir
{
  /**
   * The parameter file of this name or, where there is none, the shipped case
   * of this name, with or without "prm/" in front; the name itself if there is
   * no such case. Shipped cases are in share/voussoir/prm of an installation,
   * and in prm beside the build folder.
   */
  std::string
  find_case(const std::string &name);

  /** A line for each shipped case: its name, and the title in its head. */
  void
  list_shipped_cases(std::ostream &out);
} // namespace Voussoir

#endif
