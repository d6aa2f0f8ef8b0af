#ifndef voussoir_mesh_sources_arch_dam_mesh_h
#define voussoir_mesh_sources_arch_dam_mesh_h

#include <voussoir/mesh/coarse_mesh.h>
#include <voussoir/mesh_sources/abutment_wedge.h>
#include <voussoir/mesh_sources/arch_dam_section.h>
#include <voussoir/mesh_sources/arch_dam_sweep.h>
#include <voussoir/mesh_sources/lift_joints.h>

namespace Voussoir
{
  /**
   * An arch dam with its rock and its reservoir: the quadrilaterals of the
   * cross-section, swept through the layers from downstream to upstream.
   *
   * Cell sets are "dam", "block 1", "block 2" and so on from the right bank,
   * "rock", "reservoir" and those of the wedges; face sets are the dam's faces,
   * joints, lift joints and interface with the rock, the walls and ends of the
   * canyon, and the sides of the rock.
   *
   * @param columns_per_block columns of the section's grid between two joints
   * @param water_end         layer in which the reservoir ends, exclusive
   */
  CoarseMesh
  make_arch_dam_mesh(const ArchDamCrossSection        &section,
                     const ArchDamSweep               &sweep,
                     const std::vector<AbutmentWedge> &wedges,
                     const unsigned int                columns_per_block,
                     const LiftJoints                 &lift_joints,
                     const unsigned int                water_end);
} // namespace Voussoir

#endif
