#ifndef voussoir_base_active_h
#define voussoir_base_active_h

#include <voussoir/base/parameter_file.h>

namespace Voussoir
{
  /** Declares the entry "Active" of the section at @p path, which @p prm has
   *  entered, and returns its value in the file. */
  bool
  declared_active(dealii::ParameterHandler &prm,
                  const ParameterFile      &file,
                  const std::string        &path);
} // namespace Voussoir

#endif
