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
   * (contact, prescribed motion): it gets the displacement and velocity
   * predicted without the constraint and returns its impulse and work.
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
      Sum work;

      /** Violation of the constraint after the correction [m]. */
      double violation = 0.;
    };

    /** Declares the entries of a registered class; `prepare` takes them. */
    virtual void
    declare_parameters(dealii::ParameterHandler &)
    {}

    virtual void
    prepare(const Discretization &,
            const LumpedMass &,
            const ParameterFile &,
            const std::string &)
    {}

    /** Inverse of the mass that the update divides by, of an owned node: a
     *  momentum p changes its velocity by H p; zero where fixed, and where the
     * motion is prescribed, except for the projections that prescribe it. */
    using InverseMass =
      std::function<dealii::Tensor<2, 3>(const unsigned int node)>;

    /** Called before the first step and when masses or time step change. */
    virtual void
    prepare_step(const InverseMass &, const double)
    {}

    /** Called with the state that the first step starts from, also after a
     *  restart. */
    virtual void
    start(const State &)
    {}

    /** Owned nodes whose motion the constraint may change, in ascending order.
     */
    virtual const std::vector<unsigned int> &
    nodes() const = 0;

    /** The components x, y, z of the nodes that the constraint alone
     * determines. */
    virtual std::array<bool, 3>
    prescribed_components() const
    {
      return {{false, false, false}};
    }

    /** Corrects @p state at the end of a step of length @p time_step [s]; the
     *  time of the state is already that end. The result is of this rank. */
    virtual Result
    project(State &state, const double time_step) = 0;
  };
} // namespace Voussoir

#endif
