#ifndef voussoir_output_law_stress_h
#define voussoir_output_law_stress_h

#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** Stress of a material's law at a point of a cell for output, with the
   *  memory of the nearest integration point, which is left as it is. Where the
   *  strain of the point is beyond the limit, although none was at the nearest
   *  one, it is that of a crack which opens there. */
  class LawStress
  {
  public:
    /** @param unit point of the reference cell */
    LawStress(const ObservedModel        &model,
              const Discretization::Cell &cell,
              const dealii::Point<3>     &unit);

    /**
     * Total stress [Pa] under the total strain, of which @p initial_strain and
     * the change of temperature [K] were there before the earthquake.
     */
    dealii::SymmetricTensor<2, 3>
    operator()(const dealii::SymmetricTensor<2, 3> &strain,
               const dealii::SymmetricTensor<2, 3> &initial_strain,
               const double                         temperature) const;

    /** Whether it is this one, that of an elastic point. */
    bool
    is_elastic(const dealii::SymmetricTensor<2, 3> &elastic_stress) const;

  private:
    const Material     *material;
    const PointHistory *history; // or null
    PointHistory::Place place{0, 0};
    unsigned int        q = 0;
  };
} // namespace Voussoir

#endif
