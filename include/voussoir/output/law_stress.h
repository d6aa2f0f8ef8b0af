#ifndef voussoir_output_law_stress_h
#define voussoir_output_law_stress_h

#include <voussoir/output/observer.h>

#include <optional>

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

    /** Whether it is so under any strain. */
    bool
    is_always_elastic() const;

    const Material &
    law() const;

  private:
    const Material     *material;
    const PointHistory *history; // or null
    PointHistory::Place place{0, 0};
    unsigned int        q = 0;
  };


  /** Stress of laws at as many points as there are lanes, at the full SIMD
   *  width where they are isotropic and elastic. Lanes without a law have no
   *  stress. */
  class LawStressLanes
  {
  public:
    void
    set(const unsigned int lane, const LawStress &law);

    /** Strain and change of temperature [K] before the earthquake, once the
     *  laws are set; without this there are none. */
    void
    set_initial(const SymmetricTensor3<Lanes> &strain,
                const Lanes                   &temperature);

    /** Total stress [Pa] under the total strain. */
    SymmetricTensor3<Lanes>
    operator()(const SymmetricTensor3<Lanes> &strain) const;

  private:
    std::array<std::optional<LawStress>, Lanes::size()> laws;

    // of the laws where they are isotropic and elastic [Pa]
    Lanes lame_lambda = 0., shear_modulus = 0.;

    // what the strain of the laws is more than the total one
    SymmetricTensor3<Lanes> offset;

    bool all_are_elastic = true; // under any strain
  };
} // namespace Voussoir

#endif
