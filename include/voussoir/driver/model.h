#ifndef voussoir_driver_model_h
#define voussoir_driver_model_h

#include <voussoir/base/log.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/driver/case.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/loads/absorbing_boundary.h>
#include <voussoir/loads/reservoir.h>

namespace Voussoir
{
  /**
   * What stands before anything moves: grid, materials, mass, internal force,
   * boundary, reservoir, interfaces. Several runs, one after the other, may be
   * made on one model; none of them changes it.
   */
  class Model
  {
  public:
    /** Throws UserError if the case does not fit its mesh. */
    Model(Case &parameters, Log &log);

    ~Model();

    /** Index of a cell's material. */
    unsigned int
    material_of(const Grid::Cell &cell) const;

    /** The same, for those who know no model. */
    std::function<unsigned int(const Grid::Cell &)>
    material_of_cell() const;

    /** Frequencies of the S waves that the largest cells of each material carry
     *  well, with eight nodes per wavelength; 0 for a material without cells.
     *  All ranks must call this together [Hz]. */
    std::vector<double>
    carried_frequencies() const;

    /** The highest of them [Hz]. */
    double
    carried_frequency() const;

    /** Whether an earthquake enters as inertia on a rigid base. */
    bool
    rigid_base() const;

    const Case                         &parameters;
    const std::vector<const Material *> materials;

  private:
    const std::vector<unsigned int> material_of_coarse_cell;

  public:
    const Grid           grid;
    const Discretization discretization;
    const LumpedMass     mass;

    /** With the moduli as given; a run and the static stages take it with their
     *  own factors. */
    const InternalForce internal_force;

    NodalTerms              terms; // springs, dashpots, added mass
    const AbsorbingBoundary boundary;

    /** Loads that come with the earthquake, in their order. */
    const std::vector<NodalLoad *> running_loads;

    /** Westergaard's, or zero. */
    const AddedMass added_mass;

    /** Compressible water, or null. */
    const std::shared_ptr<const Reservoir> reservoir;

    /** Cells of water that the natural modes want, or null; that of the run if
     *  it has some. */
    const std::shared_ptr<const Reservoir> reservoir_of_modes;

    /** The constraints of the case by name, in their order. */
    const std::vector<Projection *> constraints;

    /** The interfaces before any load acts, or null. */
    const std::unique_ptr<const Contact> contact;

  private:
    /** The meshes that are needed only until the grids are made. */
    struct Meshes
    {
      Meshes(Case &parameters, Log &log);

      CoarseMesh                solid, water;
      std::vector<unsigned int> materials; // of the solid's cells
    };

    Model(Case &parameters, Meshes &&meshes, Log &log);

    void
    report(Log &log) const;

    void
    report_materials(Log &log) const;

    /** Springs go by the distance from it, wherever it is. */
    void
    check_source_point(Log &log) const;

    /** Longest edge of the cells of each material [m]. */
    std::vector<double>
    longest_edges() const;
  };
} // namespace Voussoir

#endif
