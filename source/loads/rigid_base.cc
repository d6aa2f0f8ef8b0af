#include <voussoir/loads/rigid_base.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Tensor<1, 3>
    at(const GroundMotionSignals &motion,
       double (Signal::*quantity)(double) const,
       const double time)
    {
      Tensor<1, 3> value;
      for (unsigned int d = 0; d < 3; ++d)
        if (motion[d])
          value[d] = ((*motion[d]).*quantity)(time);
      return value;
    }
  } // namespace


  RigidBase::RigidBase(GroundMotionSignals &&motion)
    : motion(std::move(motion))
  {}


  bool
  RigidBase::moves() const
  {
    return motion[0] || motion[1] || motion[2];
  }


  Tensor<1, 3>
  RigidBase::displacement(const double time) const
  {
    return at(motion, &Signal::displacement, time);
  }


  Tensor<1, 3>
  RigidBase::velocity(const double time) const
  {
    return at(motion, &Signal::velocity, time);
  }


  Tensor<1, 3>
  RigidBase::acceleration(const double time) const
  {
    return at(motion, &Signal::acceleration, time);
  }
} // namespace Voussoir
