#ifndef voussoir_loads_absorbing_boundary_h
#define voussoir_loads_absorbing_boundary_h

#include <voussoir/base/option.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/loads/free_field.h>
#include <voussoir/materials/solid.h>

namespace Voussoir
{
  enum class AbsorbingType
  {
    viscous,
    viscous_spring
  };

  inline OptionNames<AbsorbingType>
  option_names(const AbsorbingType)
  {
    return {{AbsorbingType::viscous, "viscous"},
            {AbsorbingType::viscous_spring, "viscous-spring"}};
  }


  enum class SpringCoefficients
  {
    paper,
    liu_3d,
    liu_2d,
    deeks_randolph,
    du_zhao
  };

  inline OptionNames<SpringCoefficients>
  option_names(const SpringCoefficients)
  {
    return {{SpringCoefficients::paper, "paper"},
            {SpringCoefficients::liu_3d, "Liu 3D"},
            {SpringCoefficients::liu_2d, "Liu 2D"},
            {SpringCoefficients::deeks_randolph, "Deeks-Randolph"},
            {SpringCoefficients::du_zhao, "Du-Zhao"}};
  }


  /** The entries of the section "Boundaries" on the absorbing faces. */
  struct AbsorbingParameters
  {
    std::string        face_sets;
    AbsorbingType      type         = AbsorbingType::viscous_spring;
    SpringCoefficients coefficients = SpringCoefficients::liu_3d;
    dealii::Point<3>   source;      // [m]
    double             radius = 0.; // [m], or zero

    void
    declare(dealii::ParameterHandler &prm);
  };

  /**
   * Springs and dashpots t = -(K u + C v) on the outer faces, and the
   * earthquake that enters through them as nodal forces F = A [ K u_ff + C v_ff
   * + sigma_ff n ] of a free field.
   */
  class AbsorbingBoundary
  {
  public:
    AbsorbingBoundary(const Solid               &solid,
                      const AbsorbingParameters &parameters,
                      const QuadratureRule       quadrature);

    /** Springs and dashpots of the boundary. */
    const std::vector<NodalTerm> &
    terms() const;

    const BoundaryGeometry &
    geometry() const;

    /** Vertical outer faces of the whole model, for the levels of a column. */
    const std::vector<SideFace> &
    side_faces() const;

    /** Corners of the bounding box of the boundary [m]. */
    const std::pair<dealii::Point<3>, dealii::Point<3>> &
    extent() const;

    /** Materials that touch the boundary, by index. */
    const std::vector<unsigned int> &
    materials_at_boundary() const;

    /** Adds the nodal forces by which a free field enters [N]. */
    void
    add_forces(const FreeField &field, NodalForces &forces) const;

  private:
    std::vector<NodalTerm>                        springs; // and dashpots
    BoundaryGeometry                              boundary;
    std::vector<SideFace>                         sides;
    std::pair<dealii::Point<3>, dealii::Point<3>> box;
    std::vector<unsigned int>                     touching_materials;
  };
} // namespace Voussoir

#endif
