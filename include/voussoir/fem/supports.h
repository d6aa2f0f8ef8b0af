#ifndef voussoir_fem_supports_h
#define voussoir_fem_supports_h

#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /** The entries of the section "Boundaries" that fix faces. */
  struct SupportParameters
  {
    std::string fixed, roller, antisymmetric;

    void
    declare(dealii::ParameterHandler &prm);

    std::vector<Support>
    list() const;
  };
} // namespace Voussoir

#endif
