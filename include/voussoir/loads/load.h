#ifndef voussoir_loads_load_h
#define voussoir_loads_load_h

#include <voussoir/base/parameter_file.h>
#include <voussoir/base/registry.h>
#include <voussoir/fem/nodal_terms.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** A load of a case: a named section of the parameter file. */
  class Load
  {
  public:
    virtual ~Load() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Finds the nodes it acts on; @p place names its section in messages. */
    virtual void
    prepare(const Discretization &discretization,
            NodalTerms           &terms,
            const ParameterFile  &file,
            const std::string    &place) = 0;

    /** Adds its nodal forces at @p time [s] to `terms.forces`. */
    virtual void
    add_forces(const double time, NodalTerms &terms) const = 0;
  };
} // namespace Voussoir

#endif
