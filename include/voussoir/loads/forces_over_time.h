#ifndef voussoir_loads_forces_over_time_h
#define voussoir_loads_forces_over_time_h

#include <voussoir/loads/load.h>
#include <voussoir/loads/time_factor.h>

namespace Voussoir
{
  /** Common part of loads whose nodal forces are multiplied by a factor over
   *  time. */
  class ForcesOverTime : public Load
  {
  public:
    std::vector<unsigned int>
    nodes() const override;

    void
    add_forces(const double time, NodalForces &forces) const override;

  protected:
    /** @param expression default of the factor; empty: the factor is optional
     */
    explicit ForcesOverTime(const std::string &expression = "1");

    TimeFactor factor;

    /** Owned nodes and the force on each at a factor of one [N]; empty without
     *  a factor. */
    std::vector<std::pair<unsigned int, dealii::Tensor<1, 3>>> nodal_forces;
  };
} // namespace Voussoir

#endif
