#include <voussoir/base/error.h>
#include <voussoir/loads/time_factor.h>

#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  void
  TimeFactor::declare(ParameterHandler  &prm,
                      const std::string &entry,
                      const std::string &description)
  {
    prm.add_parameter(entry,
                      expression,
                      description +
                        " A formula in the time t [s], such as "
                        "\"if(t < 2, t/2, 1)\" or \"sin(2*pi*3*t)\".");
  }


  void
  TimeFactor::prepare(const std::string &place)
  {
    function = std::make_unique<FunctionParser<1>>();
    try
      {
        function->initialize("t", expression, {{"pi", numbers::PI}});
        if (std::isfinite((*this)(0.)))
          return;
      }
    catch (const std::exception &)
      {}
    throw UserError(place + ": \"" + expression +
                    "\" is no formula in t with a finite value at t = 0; "
                    "write for example \"if(t < 2, t/2, 1)\".");
  }


  double
  TimeFactor::operator()(const double time) const
  {
    return function->value(Point<1>(time));
  }
} // namespace Voussoir
