#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/perfect_plasticity.h>

namespace Voussoir
{
  using namespace dealii;

  PerfectPlasticity::PerfectPlasticity()
  {
    young_modulus = 15e9;
    poisson_ratio = 0.25;
  }


  void
  PerfectPlasticity::declare_parameters(ParameterHandler &prm)
  {
    IsotropicElasticity::declare_parameters(prm);
    CohesionAndFriction::declare_parameters(prm);
    prm.add_parameter("Dilation angle",
                      dilation_angle,
                      "Angle psi by which plastic flow gains volume, from 0 to "
                      "the friction angle [degrees]." +
                        usually(Usual::dilation_angle),
                      Patterns::Double(0., 70.));
  }


  void
  PerfectPlasticity::check(const std::string &place) const
  {
    if (dilation_angle > friction_angle)
      throw UserError(place +
                      ": the \"Dilation angle\" is larger than the \"Friction "
                      "angle\", so that plastic flow would gain energy; lower "
                      "it.");
  }


  std::vector<std::string>
  PerfectPlasticity::output_names()
  {
    return {"equivalent plastic strain"};
  }


  std::vector<double>
  PerfectPlasticity::outputs(const double *history, const double) const
  {
    return {history[6]};
  }
} // namespace Voussoir
