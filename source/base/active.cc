#include <voussoir/base/active.h>

namespace Voussoir
{
  using namespace dealii;

  bool
  declared_active(ParameterHandler    &prm,
                  const ParameterFile &file,
                  const std::string   &path)
  {
    prm.declare_entry("Active",
                      "true",
                      Patterns::Bool(),
                      "false: left out, as if \"Names\" and the static "
                      "stages did not list it.");
    return file.given(path + "/Active", "true") != "false";
  }
} // namespace Voussoir
