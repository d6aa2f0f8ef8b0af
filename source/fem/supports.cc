#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/supports.h>

namespace Voussoir
{
  using namespace dealii;

  void
  SupportParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Fixed",
                      fixed,
                      "Face sets on which all displacements are fixed "
                      "(relative to the ground, if the earthquake enters "
                      "through a rigid base).");
    prm.add_parameter(
      "Roller",
      roller,
      "Face sets that are fixed along their normal, such as planes of "
      "symmetry; planes of constant x, y or z.");
    prm.add_parameter("Antisymmetric",
                      antisymmetric,
                      "Face sets on which the two tangential components are "
                      "fixed: planes of symmetry of a structure whose other "
                      "half moves the opposite way; planes of constant x, y or "
                      "z.");
  }


  std::vector<Support>
  SupportParameters::list() const
  {
    std::vector<Support> supports;
    for (const std::string &set : split_list(fixed))
      supports.push_back({set, Support::Fixed::all});
    for (const std::string &set : split_list(roller))
      supports.push_back({set, Support::Fixed::normal});
    for (const std::string &set : split_list(antisymmetric))
      supports.push_back({set, Support::Fixed::tangential});
    return supports;
  }
} // namespace Voussoir
