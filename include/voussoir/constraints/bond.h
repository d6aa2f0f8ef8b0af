#ifndef voussoir_constraints_bond_h
#define voussoir_constraints_bond_h

#include <voussoir/constraints/interface_law.h>

namespace Voussoir
{
  /** A bond that can be lost: its strength, whole and residual. */
  class Bond : public InterfaceLaw
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    check(const std::string &place) const override;

  protected:
    InterfaceStrength intact{1e6, 1e6, 0., 1.}, broken{0., 0., 0., 0.7};
  };
} // namespace Voussoir

#endif
