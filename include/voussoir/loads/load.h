#ifndef voussoir_loads_load_h
#define voussoir_loads_load_h

#include <voussoir/base/log.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/registry.h>
#include <voussoir/fem/initial_state.h>
#include <voussoir/loads/nodal_load.h>
#include <voussoir/materials/solid.h>

#include <deal.II/base/parameter_handler.h>

#include <optional>

namespace Voussoir
{
  /**
   * A load of a case: a named section of the parameter file. It is applied in
   * the static stage that names it and constant afterwards; a load that no
   * stage names acts from the beginning of the earthquake.
   */
  class Load
  {
  public:
    virtual ~Load() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Finds the nodes that the load acts on; @p place is the path of its
     *  section in the file. */
    virtual void
    prepare(const Solid         &solid,
            const ParameterFile &file,
            const std::string   &place,
            Log                 &log) = 0;

    /** Owned nodes that `add_forces` adds to. */
    virtual std::vector<unsigned int>
    nodes() const
    {
      return {};
    }

    /** Adds its forces at @p time [s] to those of its nodes [N]. */
    virtual void
    add_forces(const double, NodalForces &) const
    {}

    /** Whether the load is for static stages only, because its sudden
     *  application would be an impact. */
    virtual bool
    steady() const
    {
      return false;
    }

    /** Whether the load cannot belong to a static stage, because it changes
     *  with time. */
    virtual bool
    over_time() const
    {
      return false;
    }

    /** Adds its steady nodal forces, of fixed nodes too [N]. */
    virtual void
    add_steady_force(Vector &) const
    {}

    /** Resultant by volumes and areas of the mesh alone, to compare with that
     *  of the steady forces [N]; none if the load has no such resultant. */
    virtual std::optional<dealii::Tensor<1, 3>>
    resultant_of_geometry() const
    {
      return {};
    }

    /** Adds its change of temperature in all three components of a node [K]. */
    virtual void
    add_temperature(Vector &) const
    {}
  };

  /** A load in the time step. */
  class ActingLoad : public NodalLoad
  {
  public:
    explicit ActingLoad(const Load &load)
      : load(load)
    {}

    void
    add_forces(const double time, NodalForces &forces) override
    {
      load.add_forces(time, forces);
    }

  private:
    const Load &load;
  };
} // namespace Voussoir

#endif
