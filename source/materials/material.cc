#include <voussoir/base/error.h>
#include <voussoir/base/parameter_section.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/material.h>

namespace Voussoir
{
  using namespace dealii;

  void
  Material::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Cell sets",
                      cell_sets,
                      "Names of the cell sets of this material.");
    prm.add_parameter("Density",
                      density,
                      "Mass density [kg/m3]." + usually(Usual::density),
                      Patterns::Double(1e-6));
    prm.add_parameter(
      "Inertia factor",
      inertia_factor,
      "Factor on the density in the equation of motion. A factor of 0.01 on "
      "the rock makes the massless foundation of older practice; time steps "
      "shrink with the root of the factor. A rock with a factor below one "
      "takes no inertial earthquake force.",
      Patterns::Double(1e-4, 1.));
    prm.add_parameter(
      "Damping factor",
      damping,
      "Factor on the damping of section \"Damping\" for this material; 0 for "
      "none. Mass-proportional damping is the same in all materials.",
      Patterns::Double(0., 4.));
    prm.add_parameter("Static factor",
                      static_factor,
                      "Modulus under the loads of the static stages over the "
                      "dynamic modulus; 0.67 where the dynamic modulus is "
                      "taken as 1.5 times the static one.",
                      Patterns::Double(0.01, 2.));
    prm.add_parameter("Thermal expansion",
                      expansion,
                      "Coefficient of thermal expansion [1/K]." +
                        usually(Usual::expansion),
                      Patterns::Double(0.));
    in_section(prm, "Random field", [&] { random_field.declare(prm); });
  }


  void
  Material::check(const std::string &place)
  {
    if (cell_sets.empty())
      throw UserError(
        place + " has no \"Cell sets\"; name the cell sets of this material.");
  }


  double
  Material::wave_modulus() const
  {
    const ElasticConstants constants = elastic_constants();
    return constants.lame_lambda() + 2. * constants.shear_modulus();
  }


  double
  Material::damping_factor() const
  {
    return damping;
  }


  double
  Material::factor_at_rest() const
  {
    return n_history() > 0 ? 1. : static_factor;
  }


  SymmetricTensor3<double>
  Material::elastic_strain(const SymmetricTensor3<double> &filtered,
                           const SymmetricTensor3<double> &initial_strain,
                           const double                    temperature,
                           const double                    stress_factor) const
  {
    SymmetricTensor3<double> at_rest = initial_strain;
    for (unsigned int d = 0; d < 3; ++d)
      at_rest[d][d] -= expansion * temperature;
    return stress_factor * (filtered - initial_strain) +
           static_factor * at_rest;
  }


  double
  Material::inertial_density() const
  {
    return density * inertia_factor;
  }


  double
  Material::relative_cost() const
  {
    return 1.;
  }
} // namespace Voussoir
