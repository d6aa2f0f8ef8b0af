#include <voussoir/base/error.h>
#include <voussoir/materials/material.h>

namespace Voussoir
{
  using namespace dealii;

  void
  Material::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Cell sets",
                      cell_sets,
                      "Names of the cell sets that are of this material.");
    prm.add_parameter("Density",
                      density,
                      "Mass density [kg/m3].",
                      Patterns::Double(1e-6));
    prm.add_parameter(
      "Inertia factor",
      inertia_factor,
      "Factor on the density in the equation of motion. A factor of 0.01 on "
      "the rock makes the massless foundation of older practice; it costs time "
      "steps, which shrink with its root. A rock with a factor below one takes "
      "no inertial earthquake force.",
      Patterns::Double(1e-4, 1.));
    prm.add_parameter("Damping factor",
                      damping,
                      "Damping of this material relative to the section "
                      "\"Damping\"; 0 for none.",
                      Patterns::Double(0., 4.));
  }


  void
  Material::check(const std::string &place) const
  {
    if (cell_sets.empty())
      throw UserError(place + " has no \"Cell sets\"; name the cell sets that "
                              "are of this material.");
  }


  double
  Material::damping_factor() const
  {
    return damping;
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
