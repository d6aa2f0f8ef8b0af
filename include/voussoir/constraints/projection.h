#ifndef voussoir_constraints_projection_h
#define voussoir_constraints_projection_h

#include <voussoir/base/parameter_file.h>
#include <voussoir/base/registry.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * A constraint that corrects the predicted motion at the end of each step
   * (contact, prescribed motion): it gets displacement and velocity as they
   * would be without it and returns what it did, as momentum and energy.
   */
  class Projection
  {
  public:
    virtual ~Projection() = default;

    struct Result
    {
      /** Impulse on the body in this step [N s]. */
      dealii::Tensor<1, 3> impulse;

      /** Work done on the body in this step [J]. */
      double work = 0.;

      /** How far the constraint is violated after the correction [m]. */
      double violation = 0.;
    };

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    virtual void
    prepare(const Discretization &discretization,
            const LumpedMass     &mass,
            const ParameterFile  &file,
            const std::string    &place) = 0;

    /** Corrects @p state at the end of a step of length @p time_step [s]; its
     *  time is already that end. The result is of this rank. */
    virtual Result
    project(State &state, const double time_step) = 0;
  };
} // namespace Voussoir

#endif
