#ifndef voussoir_tests_limit_files_h
#define voussoir_tests_limit_files_h

#include <sys/resource.h>

namespace Voussoir
{
  /** No file may grow beyond this, as if the disk were full. */
  inline void
  limit_files(const rlim_t bytes)
  {
    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
} // namespace Voussoir

#endif
