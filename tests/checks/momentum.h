#ifndef voussoir_tests_momentum_h
#define voussoir_tests_momentum_h

#include <voussoir/driver/simulation.h>
#include <voussoir/fem/nodal_values.h>

namespace Voussoir
{
  /** Momentum of a motion, that of the added mass with it. */
  inline Vector
  momentum_with_water(const Model &model, const Vector &motion)
  {
    Vector result(motion);
    result.scale(model.solid.mass.mass);
    for (unsigned int slot = 0; slot < model.terms.nodes.size(); ++slot)
      {
        const unsigned int         node = model.terms.nodes[slot];
        const dealii::Tensor<1, 3> water =
          model.terms.added_mass[slot] * node_value(motion, node);
        for (unsigned int d = 0; d < 3; ++d)
          result.local_element(3 * node + d) += water[d];
      }
    return result;
  }
} // namespace Voussoir

#endif
