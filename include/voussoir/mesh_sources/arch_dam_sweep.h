#ifndef voussoir_mesh_sources_arch_dam_sweep_h
#define voussoir_mesh_sources_arch_dam_sweep_h

#include <voussoir/mesh_sources/arch_dam_section.h>

#include <limits>

namespace Voussoir
{
  /**
   * The lines along which the vertices of the cross-section are swept: through
   * the dam, and on both sides into the river's direction. They run in layers
   * from downstream to upstream, level except where a ledge dips: its vertices
   * have another place in the cross-section of each layer, on a plane in space,
   * and the other vertices move with them.
   */
  class ArchDamSweep
  {
  public:
    /**
     * @param rock        on both sides of the dam; its layers next to the dam
     *   have the cell size
     * @param n_thickness layers in the dam
     * @param cell_size   [m]
     */
    ArchDamSweep(const ArchDamCrossSection &section,
                 const ArchDamSections     &sections,
                 const double               height,
                 const RockGrading         &rock,
                 const unsigned int         n_thickness,
                 const double               cell_size);

    /** All vertices on the line of a vertex of the section, as s [m], layer, z
     *  [m]. */
    std::vector<dealii::Point<3>>
    operator()(const unsigned int vertex) const;

    /** Maps s, layer, which may lie between two, and z to space [m].
     *  Consecutive points with the same s and z cost least. */
    std::vector<dealii::Point<3>>
    positions(const std::vector<dealii::Point<3>> &coordinates) const;

    /** Moves s, layer, z up or down onto the ledge of that bank. */
    dealii::Point<3>
    onto_ledge(const dealii::Point<3> &at) const;

    /** Moves s, layer, z to the foot of the ledge of that bank. */
    dealii::Point<3>
    onto_foot(const dealii::Point<3> &at) const;

    /** Number of layers beside the dam whose length is nearest to this one [m].
     */
    unsigned int
    layers_along(const double length) const;

    /** Length of so many layers downstream of the dam, on the sweep of the
     *  horizontal line through s and z [m]. */
    double
    length_downstream(const unsigned int layers,
                      const double       s,
                      const double       z) const;

    unsigned int first_in_dam, n_layers;

  private:
    /** x, y on the sweep of a horizontal line through the dam. */
    dealii::Point<2>
    point(const ArchDamSections::Line &line, const double layer) const;

    /** Length of the sweep of such a line from the dam's downstream (-1) or
     *  upstream (1) face to the end of the rock [m]. */
    double
    length_beside(const ArchDamSections::Line &line, const int side) const;

    /** Share of the distance through the rock beside the dam after some layers.
     */
    double
    part_of_way(const double layers) const;

    /** Finds the vertices of the layers, from the middle of the dam on, in
     *  steps of at most this length [m]. */
    void
    lay_ledges(const ArchDamCrossSection &section, const double step);

    const ArchDamCrossSection::Ledge &
    ledge_at(const double s) const;

    /** Elevation of the plane of a ledge in the rock. */
    double
    level(const ArchDamCrossSection::Ledge &ledge,
          const double                      layer,
          const double                      s) const;

    ArchDamCrossSection::LedgeLine
    ledge_line(const ArchDamCrossSection::Ledge &ledge,
               const double                      layer,
               const double                      near) const;

    /** Offset, after a length, of a line that leaves the dam at an angle. */
    dealii::Tensor<1, 2>
    path(const double angle, const double length) const;

    using Vertices = std::vector<ArchDamCrossSection::Vertex>;

    const ArchDamSections &sections;
    const unsigned int     n_thickness;
    const double           turning_length, full_length;
    std::vector<double>    points; // beside the dam, up to 1

    const dealii::QGauss<1> quadrature{8}; // over the turn

    const std::array<ArchDamCrossSection::Ledge, 2> ledges;

    Vertices vertices; // at the middle of the dam

    // Where ledges dip: the vertices in layers one after the other, and the
    // first of these.
    std::vector<Vertices> moved;
    unsigned int          first_moved = 0;

    double upstream_end   = std::numeric_limits<double>::lowest();
    double downstream_end = std::numeric_limits<double>::max();
  };
} // namespace Voussoir

#endif
