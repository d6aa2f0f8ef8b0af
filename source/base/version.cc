#include <voussoir/base/version.h>

namespace Voussoir
{
  std::string
  version()
  {
    const std::string revision = VOUSSOIR_REVISION;
    return VOUSSOIR_VERSION +
           (revision.empty() ? "" : " (revision " + revision + ")");
  }
} // namespace Voussoir
