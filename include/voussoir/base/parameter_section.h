#ifndef voussoir_base_parameter_section_h
#define voussoir_base_parameter_section_h

#include <voussoir/base/parameter_file.h>

namespace Voussoir
{
  /** Runs an action in the section at a path ("Section/Subsection"). */
  template <typename Work>
  void
  in_section(dealii::ParameterHandler &prm,
             const std::string        &path,
             const Work               &work)
  {
    const auto names = split_list(path, '/');
    for (const std::string &name : names)
      prm.enter_subsection(name);
    work();
    for (std::size_t i = 0; i < names.size(); ++i)
      prm.leave_subsection();
  }
} // namespace Voussoir

#endif
