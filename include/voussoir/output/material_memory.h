#ifndef voussoir_output_material_memory_h
#define voussoir_output_material_memory_h

#include <voussoir/output/observer.h>

#include <deal.II/lac/vector.h>

namespace Voussoir
{
  /**
   * Results from the internal variables of all materials (damage, plastic
   * strain, crack openings), by name: the mean of the integration points of
   * each active cell; zero in cells whose material has no such result.
   */
  std::map<std::string, dealii::Vector<float>>
  memory_of_cells(const Solid &solid, const MaterialMemory &memory);

  /** Whether the law of a material has crack openings. */
  bool
  reports_cracks(const Material &material);

  /** Opening of the crack of an integration point that has left the elastic
   *  range, evaluated when it is asked for. In cells of degree 2 and more,
   * whose strain varies across a crack, it is that of the whole cell: the sum
   * of w_i l_i e_i / s over its points, with the weights w_i , bands l_i ,
   * strains e_i and the share s of a row of cells that is the band of a point.
   */
  class CrackOpening
  {
  public:
    /** @param number of the largest opening among the outputs of the material
     */
    CrackOpening(const Solid               &solid,
                 const unsigned int         material,
                 const PointHistory        &history,
                 const PointHistory::Place &place,
                 const unsigned int         q,
                 const std::size_t          number)
      : solid(solid)
      , material(material)
      , history(history)
      , place(place)
      , q(q)
      , number(number)
    {}

    /** Whether all points of a cell have the opening of the cell. */
    static bool
    is_of_cell(const Solid &solid)
    {
      return solid.discretization.degree > 1;
    }

    /** At the last step [m]: the band times the inelastic strain across the
     *  crack, n . e_in . n with e_in = e - C^-1 : sigma ; at most the largest
     *  opening so far. Zero where the traction is compressive by more than a
     *  hundredth of E times this strain: the crack is closed, even if shear
     *  along an inclined strut gives a strain across, and the expansion of
     *  crushed concrete is no crack. */
    double
    now() const;

    /** So far, an internal variable of the law [m]. */
    double
    largest() const;

  private:
    /** An opening of the cell from those of its points. */
    template <typename OfPoint>
    double
    of_cell(const OfPoint &of_point) const;

    double
    now_at(const unsigned int point) const;

    double
    largest_at(const unsigned int point) const;

    const Solid               &solid;
    unsigned int               material; // its number
    const PointHistory        &history;
    const PointHistory::Place &place;
    unsigned int               q;
    std::size_t                number;
  };

  /** Visits the points of this rank's cells that have left the elastic range,
   *  of all materials with crack openings. */
  void
  for_each_active_point(
    const ObservedRun                                   &run,
    const std::function<void(const Discretization::Cell &,
                             const unsigned int point)> &visit);

  /** The same, with the width of the crack band [m] and the opening. */
  void
  for_each_crack(const ObservedRun                                      &run,
                 const std::function<void(const Discretization::Cell &,
                                          const unsigned int  point,
                                          const double        band,
                                          const CrackOpening &opening)> &visit);

  /** The crack with the largest opening over the width of its cell. */
  struct WidestCrack
  {
    double           opening = 0.; // [m]
    double           share   = 0.; // of the width of the cell across it
    dealii::Point<3> where;        // middle of the cell [m]
  };

  /** The widest crack of all materials with crack openings, now, or @p ever;
   *  all ranks must call this together. */
  WidestCrack
  widest_crack(const ObservedRun &run, const bool ever = false);

  /**
   * For each material with internal variables: the share of its volume that has
   * left the elastic range, energy lost in it [J], largest value of each of its
   * results. All ranks must call this together.
   *
   * @param names of the materials
   */
  nlohmann::json
  memory_summary(const ObservedRun &run, const std::vector<std::string> &names);
} // namespace Voussoir

#endif
