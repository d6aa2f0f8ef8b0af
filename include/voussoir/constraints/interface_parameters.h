#ifndef voussoir_constraints_interface_parameters_h
#define voussoir_constraints_interface_parameters_h

#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/interface_law.h>
#include <voussoir/mesh/coarse_mesh.h>

#include <memory>

namespace Voussoir
{
  /** Water pressure inside an interface. */
  struct UpliftParameters
  {
    std::string upstream_faces, downstream_faces;
    double      upstream_level = 0., downstream_level = -1e6; // [m]
    double      drain_position = 0., drain_factor = 1.;
    double      density = 1000.; // [kg/m3]
    std::string comes_with;      // load of a static stage

    void
    declare(dealii::ParameterHandler &prm);

    bool
    given() const;

    /** Pressure at an elevation and a share of the distance from the upstream
     * to the downstream faces [Pa]. */
    double
    pressure(const double elevation, const double share) const;
  };

  /** A section "Interfaces/NAME": surfaces along which the mesh is split and
   *  their strength. */
  struct InterfaceParameters
  {
    std::string                   name;
    std::string                   face_sets, between;
    std::string                   grouted_after; // load of a static stage
    bool                          tied = false;  // from then on
    std::unique_ptr<InterfaceLaw> law;
    double                        initial_gap = 0., key_depth = 0.; // [m]

    // joint reinforcement: area over area [-], [Pa], [m], [Pa]
    double steel_ratio = 0., steel_modulus = 200e9, free_length = 1.,
           yield_stress = 400e6;

    UpliftParameters uplift;

    void
    declare(dealii::ParameterHandler &prm);

    void
    check() const;
  };

  /** Face sets along which a mesh was split, those of each interface. */
  struct InterfaceSurfaces
  {
    std::vector<std::vector<std::string>> of_interface;

    /** The face sets of all interfaces, in order. */
    std::vector<std::string>
    names() const;
  };

  /** The section "Interfaces". */
  struct InterfacesParameters
  {
    std::vector<InterfaceParameters> list;

    /** Interfaces with `set Active = false`: the mesh is not split there. */
    std::vector<InterfaceParameters> inactive;

    void
    declare(dealii::ParameterHandler &prm, const ParameterFile &file);

    void
    check() const;

    /** Finds the face sets of each interface in the mesh and splits it along
     *  them. */
    InterfaceSurfaces
    split(CoarseMesh &mesh) const;
  };
} // namespace Voussoir

#endif
