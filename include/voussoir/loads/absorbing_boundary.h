#ifndef voussoir_loads_absorbing_boundary_h
#define voussoir_loads_absorbing_boundary_h

#include <voussoir/fem/nodal_terms.h>
#include <voussoir/loads/free_field.h>

namespace Voussoir
{
  /** The entries of the section "Boundaries". */
  struct BoundaryParameters
  {
    std::string      fixed, roller, absorbing;
    std::string      absorbing_type = "viscous-spring";
    std::string      coefficients   = "Liu 3D";
    dealii::Point<3> source;
    double           radius = 0.;

    void
    declare(dealii::ParameterHandler &prm);

    /** Refuses unknown sets and sets with two kinds of boundary. */
    void
    check(const Grid &grid) const;

    std::vector<Support>
    supports() const;
  };

  /** The entries of the section "Wave field". */
  struct WaveParameters
  {
    std::string enters_through    = "absorbing boundary";
    std::string type              = "vertical";
    double      angle             = 15.;
    double      azimuth           = 0.;
    double      maximum_frequency = 25.;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /** Springs (per area and distance, see below) and dashpots of a boundary. */
  struct BoundaryCoefficients
  {
    double normal_spring;     // times 1/r: [Pa]
    double tangential_spring; // times 1/r: [Pa]
    double normal_dashpot;    // [Pa s/m]
    double tangential_dashpot;

    /** One of the coefficient sets for this rock. */
    static BoundaryCoefficients
    of(const std::string      &absorbing_type,
       const std::string      &set,
       const ElasticConstants &rock);
  };

  /**
   * Springs and dashpots t = -(K u + C v) on the outer faces, and the
   * earthquake that enters through them as nodal forces F = A [ K u_ff + C v_ff
   * + sigma_ff n ] of a free field.
   */
  class AbsorbingBoundary
  {
  public:
    AbsorbingBoundary(
      const Discretization                                  &discretization,
      const BoundaryParameters                              &parameters,
      const std::vector<const Material *>                   &materials,
      const std::function<unsigned int(const Grid::Cell &)> &material_of_cell,
      const std::string                                     &quadrature,
      NodalTerms                                            &terms);

    /** Lets a free field in; without one the boundary only absorbs. */
    void
    set_free_field(std::unique_ptr<FreeField> &&field);

    const BoundaryGeometry &
    geometry() const;

    /** Vertical outer faces of the whole model, for the levels of a column. */
    const std::vector<SideFace> &
    side_faces() const;

    /** Corners of the box around the boundary [m]. */
    const std::pair<dealii::Point<3>, dealii::Point<3>> &
    extent() const;

    /** Materials that touch the boundary, by index. */
    const std::vector<unsigned int> &
    materials_at_boundary() const;

    void
    add_forces(const double time, NodalTerms &terms);

    /** Brings the free field past a step whose forces are not wanted. */
    void
    replay(const double time);

  private:
    std::vector<unsigned int> slots; // of the boundary nodes in NodalTerms
    std::vector<NodalTerms::Matrix>               springs, dashpots;
    BoundaryGeometry                              boundary;
    std::vector<SideFace>                         sides;
    std::pair<dealii::Point<3>, dealii::Point<3>> box;
    std::vector<unsigned int>                     touching_materials;
    std::unique_ptr<FreeField>                    field;
  };

  /**
   * The free field of a case, from what the sections "Ground motion" and "Wave
   * field" say.
   */
  std::unique_ptr<FreeField>
  make_free_field(const AbsorbingBoundary             &boundary,
                  const Discretization                &discretization,
                  const std::vector<const Material *> &materials,
                  const std::string                   &quadrature,
                  const Damping                       &damping,
                  const WaveParameters                &wave,
                  const std::string                   &given_at,
                  GroundMotionSignals                &&motion,
                  const bool                           paper_scheme,
                  const double                         time_step,
                  const double                         duration);
} // namespace Voussoir

#endif
