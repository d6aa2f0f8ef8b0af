#ifndef voussoir_materials_material_h
#define voussoir_materials_material_h

#include <voussoir/base/registry.h>
#include <voussoir/fem/cell_kernel.h>
#include <voussoir/materials/law.h>
#include <voussoir/materials/random_field.h>

namespace Voussoir
{
  /** The isotropic elastic constants of waves and boundaries. */
  struct ElasticConstants
  {
    double density;       // rho [kg/m3]
    double young_modulus; // E [Pa]
    double poisson_ratio; // nu

    double
    shear_modulus() const // G [Pa]
    {
      return young_modulus / (2. * (1. + poisson_ratio));
    }
    double
    lame_lambda() const // [Pa]
    {
      return young_modulus * poisson_ratio /
             ((1. + poisson_ratio) * (1. - 2. * poisson_ratio));
    }
    double
    p_wave_speed() const // [m/s]
    {
      return std::sqrt((lame_lambda() + 2. * shear_modulus()) / density);
    }
    double
    s_wave_speed() const // [m/s]
    {
      return std::sqrt(shear_modulus() / density);
    }
  };

  /**
   * A material of a case: a named section of the parameter file, the cell sets
   * it fills, a stress law, and the cell kernel of this law. The kernel gets
   * cells, factors on the moduli and internal variables as arguments; the law
   * evaluates single points. MaterialOf makes classes of materials from laws,
   * see law.h.
   */
  class Material : public CellKernel
  {
  public:
    virtual void
    declare_parameters(dealii::ParameterHandler &prm);

    /** Refuses values that do not fit together, and computes derived constants;
     *  @p place names the section. */
    virtual void
    check(const std::string &place);

    virtual ElasticConstants
    elastic_constants() const = 0;

    double
    damping_factor() const override;

    double
    wave_modulus() const override;

    /** Density times the inertia factor, for the mass matrix [kg/m3]. */
    double
    inertial_density() const;

    /** The material of the static state: with its modulus times the static
     *  factor and its strengths without the increase for an earthquake, if the
     *  law has internal variables; else, and of itself, this material. */
    virtual const Material &
    at_rest() const = 0;

    /** Factor on the stress of `static_material`: the static factor, unless its
     *  modulus contains it. */
    double
    factor_at_rest() const;

    /** Elastic stress at a point by itself [Pa]. */
    virtual SymmetricTensor3<double>
    stress(const SymmetricTensor3<double> &strain) const = 0;

    /** Response of a point by itself; updates its `n_history` internal
     *  variables by one step. */
    virtual PointResponse<double>
    respond(const SymmetricTensor3<double> &strain,
            double                         *history,
            const PointSituation<double>   &situation) const = 0;

    /** Stress of points that have been elastic so far [Pa]; as many points as
     *  there are lanes.
     *  @param element_length as in PointSituation [m] */
    virtual SymmetricTensor3<Lanes>
    stress_of_elastic_points(const SymmetricTensor3<Lanes> &strain,
                             const Lanes &element_length) const = 0;

    /** See LawDefaults::yield_ratio; 0 for a law without internal variables. */
    virtual double
    yield_ratio(const SymmetricTensor3<double> &elastic_stress,
                const double                    element_length) const = 0;

    /** Response of as many points as there are lanes. */
    virtual Lanes
    yield_ratio(const SymmetricTensor3<Lanes> &elastic_stress,
                const Lanes                   &element_length) const = 0;

    /**
     * Strain whose elastic stress D : e is that of the equation of motion,
     *   e = k (B (u + s w) - e_i) + a (e_i - alpha T I) .
     *
     * @param filtered       B (u + s w), see CellKernel::add_force
     * @param initial_strain e_i, from before the earthquake
     * @param temperature    T, its change before the earthquake [K]
     * @param stress_factor  k, see InternalForce
     */
    SymmetricTensor3<double>
    elastic_strain(const SymmetricTensor3<double> &filtered,
                   const SymmetricTensor3<double> &initial_strain,
                   const double                    temperature,
                   const double                    stress_factor) const;

    virtual TensileFailure
    tensile_failure() const = 0;

    /** Whether the law has no directions of its own. */
    virtual bool
    isotropic() const = 0;

    /** Names of the results from the internal variables, with units. */
    virtual std::vector<std::string>
    output_names() const = 0;

    /** The values of `output_names` at a point. */
    virtual std::vector<double>
    outputs(const double *history, const double element_length) const = 0;

    /** A sentence for the log if cells of this length [m] do not suit the law;
     *  else empty. */
    virtual std::string
    remark(const double element_length) const = 0;

    /** Cost of a cell relative to a linear elastic one, to balance the ranks.
     */
    virtual double
    relative_cost() const;

    std::string cell_sets;
    double      density        = 2400.;
    double      inertia_factor = 1.;
    double      damping        = 1.;
    double      static_factor  = 1.;
    double      expansion      = 1e-5; // [1/K]

    RandomFieldParameters random_field;
  };

  /** The values of a function for all materials, by index. */
  template <typename Function>
  auto
  for_each_material(const std::vector<const Material *> &materials,
                    const Function                      &function)
  {
    std::vector<decltype(function(*materials[0]))> values;
    for (const Material *material : materials)
      values.push_back(function(*material));
    return values;
  }
} // namespace Voussoir

#endif
