#ifndef voussoir_mesh_sources_generator_h
#define voussoir_mesh_sources_generator_h

#include <voussoir/base/registry.h>
#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /** A built-in mesh, described in the section of its name under "Mesh". */
  class MeshGenerator
  {
  public:
    virtual ~MeshGenerator() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Refuses entries that do not fit together. */
    virtual void
    check() const = 0;

    virtual CoarseMesh
    generate() const = 0;

    /** Key figures of the structure, a line for the log; empty if there are
     *  none. */
    virtual std::string
    describe(const CoarseMesh &) const
    {
      return {};
    }
  };
} // namespace Voussoir

#endif
