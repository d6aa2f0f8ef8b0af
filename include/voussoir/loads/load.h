#ifndef voussoir_loads_load_h
#define voussoir_loads_load_h

#include <voussoir/base/log.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/registry.h>
#include <voussoir/fem/initial_state.h>
#include <voussoir/loads/nodal_load.h>
#include <voussoir/materials/material.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** What loads see of a case. */
  struct LoadedModel
  {
    const Discretization                           &discretization;
    const std::vector<const Material *>            &materials;
    std::function<unsigned int(const Grid::Cell &)> material_of_cell;
    const ParameterFile                            &file;
    Log                                            &log;
  };

  /**
   * A load of a case: a named section of the parameter file. It belongs to the
   * static stage that names it and stays as it is afterwards, or else acts from
   * the beginning of the earthquake.
   */
  class Load : public NodalLoad
  {
  public:
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Finds the nodes it acts on; @p place names its section in messages. */
    virtual void
    prepare(const LoadedModel &model,
            NodalTerms        &terms,
            const std::string &place) = 0;

    /** Whether it only makes sense in a static stage, because it would be a
     *  blow if it came on at once. */
    virtual bool
    steady() const
    {
      return false;
    }

    /** Whether it only makes sense outside of the static stages, because it
     *  changes with time. */
    virtual bool
    over_time() const
    {
      return false;
    }

    /** Adds its steady nodal forces, of held nodes too [N]. */
    virtual void
    add_steady_force(Vector &) const
    {}

    /** Adds its change of temperature in all three components of a node [K]. */
    virtual void
    add_temperature(Vector &) const
    {}
  };
} // namespace Voussoir

#endif
