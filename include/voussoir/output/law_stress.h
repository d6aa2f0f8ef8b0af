#ifndef voussoir_output_law_stress_h
#define voussoir_output_law_stress_h

#include <voussoir/output/observer.h>

#include <optional>

namespace Voussoir
{
  /** Stress of the equation of motion at a point of a cell, for output. Where
   *  the nearest integration point has left the elastic range, it is the stress
   *  that the law gave at that point in the last step; elsewhere the elastic
   *  stress, which a law with internal variables limits where it is beyond its
   *  strength, as if a crack opened there. */
  class LawStress
  {
  public:
    /** @param unit point of the reference cell */
    LawStress(const StressModel          &model,
              const Discretization::Cell &cell,
              const dealii::Point<3>     &unit);

    /** Total stress [Pa].
     *  @param elastic_strain see there */
    dealii::SymmetricTensor<2, 3>
    operator()(const dealii::SymmetricTensor<2, 3> &elastic_strain) const;

    /** Material::elastic_strain; but where the law of the static state limits
     *  the stress before the earthquake, that of the limited stress. */
    dealii::SymmetricTensor<2, 3>
    elastic_strain(const dealii::SymmetricTensor<2, 3> &filtered,
                   const dealii::SymmetricTensor<2, 3> &initial_strain,
                   const double                         temperature) const;

    /** Whether the stress is the elastic one. */
    bool
    is_elastic(const dealii::SymmetricTensor<2, 3> &elastic_stress) const;

    /** Whether the stress is the elastic one under any strain. */
    bool
    is_always_elastic() const;

    const Material &
    law() const;

    /** k of the stress, see InternalForce. */
    double
    stress_factor() const;

    /** Whether the nearest integration point has left the elastic range. */
    bool
    is_active() const;

    /** Lanes of the nearest integration point, if it has left the elastic range
     *  in any of them; else null. */
    const ActivePoint *
    active_lanes() const;

    /** Whether the nearest integration points of both are lanes of one. */
    bool
    is_lane_beside(const LawStress &other) const;

    /** Width of the widest crack band of the cell [m]; 0 for an elastic law. */
    double
    widest_band() const;

  private:
    const Material     *material;
    const PointHistory *history; // or null
    double              k;
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
     *  laws are set; else both are zero. */
    void
    set_initial(const SymmetricTensor3<Lanes> &strain,
                const Lanes                   &temperature);

    /** Total stress [Pa] under the strain B (u + s w), see
     *  FilteredDisplacement. */
    SymmetricTensor3<Lanes>
    operator()(const SymmetricTensor3<Lanes> &filtered) const;

    /** Damping factors s. */
    const Lanes &
    damping_factors() const;

  private:
    /** Takes the stress at integration points that have left the elastic range,
     *  if all nearest ones are in one batch of cells, and sets their ratio to
     *  zero. */
    void
    take_active_lanes(Lanes &ratio, SymmetricTensor3<Lanes> &stress) const;

    // of the laws where they are isotropic and elastic [Pa]
    Lanes lame_lambda = 0., shear_modulus = 0.;

    Lanes stress_factor = 0., damping_factor = 0.;

    // difference of their elastic strain and k B (u + s w)
    SymmetricTensor3<Lanes> offset;

    bool all_are_elastic = true; // under any strain

    // the material of all lanes if it is the same and isotropic, else null; and
    // the width of the widest band of each lane [m]
    const Material *common = nullptr;
    Lanes           bands  = 1.;

    // whether the nearest integration points of all lanes have one number in
    // one batch of cells
    bool are_in_one_batch = true;

    // Few evaluations read these; all read the members above, which are hence
    // side by side.
    std::array<std::optional<LawStress>, Lanes::size()> laws;
  };
} // namespace Voussoir

#endif
