#ifndef voussoir_loads_boundary_parameters_h
#define voussoir_loads_boundary_parameters_h

#include <voussoir/fem/supports.h>
#include <voussoir/loads/absorbing_boundary.h>

namespace Voussoir
{
  /** The entries of the section "Boundaries". */
  struct BoundaryParameters
  {
    SupportParameters   supports;
    AbsorbingParameters absorbing;

    void
    declare(dealii::ParameterHandler &prm);

    /** Refuses unknown sets and sets with two kinds of boundary. */
    void
    check(const Grid &grid) const;

    /** Whether no face is fixed, neither by a support nor by the springs of an
     *  absorbing boundary. */
    bool
    empty() const;

    /** The supports, and the absorbing faces as supports, too. */
    std::vector<Support>
    supports_with_absorbing(const bool roller) const;
  };
} // namespace Voussoir

#endif
