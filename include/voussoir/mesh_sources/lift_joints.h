#ifndef voussoir_mesh_sources_lift_joints_h
#define voussoir_mesh_sources_lift_joints_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace Voussoir
{
  /** The joints between the lifts of concrete in which a dam is placed: rows of
   *  faces of its cells. */
  class LiftJoints
  {
  public:
    /** @param height of a lift [m]; 0 for none */
    static void
    declare(dealii::ParameterHandler &prm, double &height);

    /** @param elevations of the dam's rows of cells, from base to crest [m] */
    LiftJoints(const double height, const std::vector<double> &elevations);

    /** Set of the faces below a row, "lift 1" from below; empty if no lift
     *  joint runs there. */
    std::string
    below(const unsigned int row) const;

    /** Adds number and elevations, if there are any, to the mesh's remarks. */
    void
    add_remark(CoarseMesh &mesh) const;

  private:
    std::map<unsigned int, double> elevation; // by the row above [m]
  };
} // namespace Voussoir

#endif
