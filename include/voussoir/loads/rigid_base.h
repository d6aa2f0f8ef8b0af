#ifndef voussoir_loads_rigid_base_h
#define voussoir_loads_rigid_base_h

#include <voussoir/loads/ground_motion.h>

namespace Voussoir
{
  /**
   * The base of a model on rigid ground, to which the motion of the model is
   * relative. If no earthquake enters through the base, it is at rest and the
   * motion is absolute.
   */
  class RigidBase
  {
  public:
    RigidBase() = default;

    /** @param motion of the ground, by component; null: none */
    explicit RigidBase(GroundMotionSignals &&motion);

    bool
    moves() const;

    /** [m] */
    dealii::Tensor<1, 3>
    displacement(const double time) const;

    /** [m/s] */
    dealii::Tensor<1, 3>
    velocity(const double time) const;

    /** [m/s2] */
    dealii::Tensor<1, 3>
    acceleration(const double time) const;

  private:
    GroundMotionSignals motion;
  };
} // namespace Voussoir

#endif
