#ifndef voussoir_mesh_sources_abutment_wedge_h
#define voussoir_mesh_sources_abutment_wedge_h

#include <voussoir/mesh/coarse_mesh.h>
#include <voussoir/mesh_sources/arch_dam_section.h>

#include <deal.II/base/parameter_handler.h>

#include <functional>

namespace Voussoir
{
  /** The entries of a wedge, an abutment block in one bank of an arch dam. */
  struct AbutmentWedgeParameters
  {
    double elevation = 0.; // of the base plane; 0: no wedge
    double dip       = 0.; // [degrees]
    double direction = 0.; // [degrees]
    double width     = 100.;
    double length    = 150.;
    double cut       = 100.;

    void
    declare(dealii::ParameterHandler &prm);

    /** The base plane in the cross-section. */
    ArchDamCrossSection::Ledge
    ledge(const unsigned int bank) const;
  };

  /**
   * A wedge: an abutment block that can slide out of the bank of an arch dam.
   *
   * In the cross-section it is the rock above a ledge and on the river's side
   * of an upright column; along the river it reaches from the dam's upstream
   * face to where the rock in front of it is cut away. It is bounded by three
   * release planes, base, lateral and rear, and daylights on the canyon's wall
   * and in the cut.
   */
  class AbutmentWedge
  {
  public:
    /** The sweep that makes the mesh from the cross-section. */
    struct Layers
    {
      unsigned int dam_begin, dam_end, n;

      /** Number of layers whose length from the dam is nearest to this one. */
      std::function<unsigned int(const double length)> along;
    };

    /**
     * Places the wedge on the ledge of @p section in this bank. Throws
     * UserError, which names the @p place of the parameters.
     *
     * @param bank 0 for the right one, 1 for the left
     */
    AbutmentWedge(const AbutmentWedgeParameters &parameters,
                  const unsigned int             bank,
                  const Layers                  &layers,
                  const ArchDamCrossSection     &section,
                  const std::string             &place);

    const unsigned int bank; // 0 for the right one, 1 for the left

    /** "left wedge" or "right wedge". */
    std::string
    name() const;

    /** Number of layers from the downstream end of the wedge to the dam. */
    unsigned int
    layers_before_dam() const;

    bool
    contains(const ArchDamCrossSection::Quad &quad,
             const unsigned int               layer) const;

    /** Whether the rock is cut away in this cell. */
    bool
    is_cut(const ArchDamCrossSection::Quad &quad,
           const unsigned int               layer) const;

    /**
     * Adds the cell set "left wedge" or "right wedge", face sets of that name
     * with " base", " lateral plane" and " rear plane", all named from the
     * wedge, and the faces of the cut to "ground"; the base also to the second
     * surface of the chart.
     *
     * @param cell_number of each quadrilateral and layer, the layers of one
     *   quadrilateral together; invalid_unsigned_int for none
     */
    void
    add_sets(const ArchDamCrossSection       &section,
             const std::vector<unsigned int> &cell_number,
             CoarseMesh                      &mesh) const;

  private:
    bool
    is_in_columns(const ArchDamCrossSection::Quad &quad) const;

    const unsigned int n_layers, dam_begin, end; // end: at the rear plane
    unsigned int       begin, cut_begin;

    const ArchDamCrossSection::Ledge ledge;
  };
} // namespace Voussoir

#endif
