#include <voussoir/base/error.h>
#include <voussoir/base/section_names.h>

#include <algorithm>

namespace Voussoir
{
  void
  check_section_names(const std::vector<std::string> &names,
                      const std::string              &place)
  {
    constexpr std::size_t most_names = 1000;
    if (names.size() > most_names)
      throw UserError(place + " lists " + std::to_string(names.size()) +
                      " names; at most " + std::to_string(most_names) +
                      " are taken.");
    for (auto name = names.begin(); name != names.end(); ++name)
      {
        if (std::find(names.begin(), name, *name) != name)
          throw UserError(place + " lists \"" + *name +
                          "\" twice; keep one of the two.");
        if (name->find('/') != std::string::npos)
          throw UserError(place + " lists \"" + *name +
                          "\"; choose a name without \"/\".");
      }
  }
} // namespace Voussoir
