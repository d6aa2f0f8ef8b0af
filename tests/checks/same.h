#ifndef voussoir_tests_same_h
#define voussoir_tests_same_h

#include <voussoir/base/keyed_values.h>
#include <voussoir/fem/discretization.h>

#include <string>

namespace Voussoir
{
  /** Whether two vectors agree bit for bit, on all ranks. */
  bool
  same(const Vector &a, const Vector &b);

  /** The same of values of a checkpoint. */
  bool
  same(const KeyedValues &a, const KeyedValues &b, const MPI_Comm communicator);

  /** The contents of a file; empty if there is none. */
  std::string
  text_of(const std::string &file);
} // namespace Voussoir

#endif
