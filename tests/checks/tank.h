#ifndef voussoir_tests_tank_h
#define voussoir_tests_tank_h

#include <voussoir/loads/water_motion.h>
#include <voussoir/mesh/reservoir_mesh.h>

#include "check.h"

namespace Voussoir
{
  /** The water of a case, excited by a solid whose motion is prescribed. */
  class Tank
  {
  public:
    Tank(const Case &parameters, const MPI_Comm communicator);

    CoarseMesh           mesh; // of the solid, once the water is made
    const CoarseMesh     water_mesh;
    const Grid           grid;
    const Discretization discretization;
    Log                  log;
    const Reservoir      reservoir;
    const RigidBase      base;
    const double         time_step;
    WaterMotion          water;
    const NodalTerms     terms;  // of its wet nodes
    NodalForces          forces; // of the beginning of the last step
    double               time = 0.;

    /**
     * One step with the whole solid moving at these velocities at its middle
     * [m/s].
     */
    void
    step(const dealii::Tensor<1, 3> &velocity,
         const dealii::Tensor<1, 3> &base_velocity = dealii::Tensor<1, 3>());

    /** Sum of the forces on the solid [N]. */
    dealii::Tensor<1, 3>
    thrust() const;

    /** Pressure at a node [Pa]. */
    double
    pressure(const dealii::Point<3> &position) const;
  };

  /** A velocity that rises from 0 to 1 and returns [m/s], smooth, at @p time
   *  over the @p duration. */
  double
  pulse(const double time, const double duration);
} // namespace Voussoir

#endif
