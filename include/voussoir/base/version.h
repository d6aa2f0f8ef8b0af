#ifndef voussoir_base_version_h
#define voussoir_base_version_h

#include <string>

namespace Voussoir
{
  /** "0.1.0 (revision abcdef)". */
  std::string
  version();
} // namespace Voussoir

#endif
