#ifndef voussoir_driver_model_h
#define voussoir_driver_model_h

#include <voussoir/base/log.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/driver/case.h>
#include <voussoir/loads/absorbing_boundary.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/materials/solid.h>

namespace Voussoir
{
  /**
   * All parts of a case that do not change with time: grid, materials, mass,
   * internal force, boundary, loads, reservoir, interfaces. Several runs may
   * use one model; none of them changes it.
   */
  class Model
  {
  public:
    /** Throws UserError if the case does not fit its mesh. */
    Model(const Case &parameters, Log &log);

    ~Model();

    /** Carried frequency of each material: the highest one of S waves with
     *  eight nodes per wavelength in its largest cells; 0 for a material
     *  without cells. All ranks must call this together [Hz]. */
    std::vector<double>
    carried_frequencies() const;

    /** The highest carried frequency [Hz]. */
    double
    carried_frequency() const;

    /** Width of the widest crack band of each material; 0 for one without
     *  cells. All ranks must call this together [m]. */
    std::vector<double>
    widest_crack_bands() const;

    /** Of each material, how low the strength at tips of its cracks is, if they
     *  grow from tips, and what one integration point does to cracks. All ranks
     *  must call this together. */
    std::vector<std::vector<std::string>>
    notes_on_cracks() const;

    /** Whether an earthquake enters as inertia on a rigid base. */
    bool
    rigid_base() const;

    const Case &parameters;

  private:
    /** The meshes, which are needed only until the grids are made. A mesh that
     *  is not refined, or that METIS distributes from a file, is on the first
     *  rank of each machine; the other ranks have the names of its sets and
     *  their faces. */
    struct Meshes
    {
      Meshes(const Case &parameters, Log &log);

      void
      make(const Case &parameters, Log &log);

      GridParameters            grid; // without what a linear run must tell
      CoarseMesh                solid, water;
      InterfaceSurfaces         surfaces;
      std::vector<unsigned int> materials; // of the solid's cells

      std::shared_ptr<const CellsAndRing> stressed; // see Grid::Materials
    };

  public:
    const Grid              grid;
    const Solid             solid;
    const AbsorbingBoundary boundary;

    /** Materials of the case by name, in their order. */
    const std::vector<std::pair<std::string, std::unique_ptr<const Load>>>
      loads;

    /** Westergaard's, or zero. */
    const AddedMass added_mass;

    /** Compressible water, or null. */
    const std::shared_ptr<const Reservoir> reservoir;

    /** The reservoir that the natural modes need, or null; the reservoir of the
     *  run if it has one. */
    const std::shared_ptr<const Reservoir> reservoir_of_modes;

    /** Springs, dashpots, masses and forces of boundary, loads and water on
     *  nodes. */
    const NodalTerms terms;

    /** The interfaces before any load acts, or null. */
    const std::unique_ptr<const Contact> contact;

    /** All loads of the case. */
    NamedLoads
    load_list() const;

    /** Loads that come with the earthquake, in their order. */
    std::vector<const Load *>
    running_loads() const;

  private:
    Model(const Case &parameters, Meshes &&meshes, Log &log);

    void
    report(Log &log) const;

    void
    report_materials(Log &log) const;

    /** Warns of a source point far outside the model, as the stiffness of
     *  springs follows from the distance to it. */
    void
    check_source_point(Log &log) const;

    /** Longest edge of the cells of each material [m]. */
    std::vector<double>
    longest_edges() const;
  };
} // namespace Voussoir

#endif
