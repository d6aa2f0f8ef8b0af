#ifndef voussoir_materials_material_h
#define voussoir_materials_material_h

#include <voussoir/base/registry.h>
#include <voussoir/fem/internal_force.h>

#include <deal.II/base/parameter_handler.h>

#include <cstdint>

namespace Voussoir
{
  /** The isotropic elastic constants that waves and boundaries go by. */
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

  /** SIMD lanes of a number type, and access to one of them: where a law must
   *  go point by point. */
  template <typename Number>
  constexpr unsigned int
  n_lanes()
  {
    if constexpr (std::is_same_v<Number, double>)
      return 1;
    else
      return Number::size();
  }

  inline double &
  lane_of(double &number, const unsigned int)
  {
    return number;
  }

  inline const double &
  lane_of(const double &number, const unsigned int)
  {
    return number;
  }

  inline double &
  lane_of(Lanes &numbers, const unsigned int lane)
  {
    return numbers[lane];
  }

  inline const double &
  lane_of(const Lanes &numbers, const unsigned int lane)
  {
    return numbers[lane];
  }

  /** Whether any lane is above a limit. */
  template <typename Number>
  bool
  any_above(const Number &numbers, const double limit)
  {
    // as wide as the numbers, so that one instruction compares all lanes
    std::uint64_t any = 0;
    for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
      any |= std::uint64_t(lane_of(numbers, lane) > limit);
    return any != 0;
  }

  /** What a law with memory knows of a point besides its strain. */
  template <typename Number>
  struct PointSituation
  {
    Number element_length; // width of the band in which a crack lives [m]
    double time_step;      // [s]
  };

  /** What a law with memory answers. */
  template <typename Number>
  struct PointResponse
  {
    SymmetricTensor3<Number> stress;         // [Pa]
    SymmetricTensor3<Number> elastic_strain; // stored: stress times half of it
    Number                   dissipation;    // lost in this step [J/m3]

    /** Share that damage leaves of the stress of damping. */
    Number damping_share = Number(1.);

    /** Plastic flow of this step. */
    SymmetricTensor3<Number> plastic_increment = SymmetricTensor3<Number>();
  };

  /**
   * A material of a case: a named section of the parameter file, the cell sets
   * it fills, and the kernel that turns displacement into internal force. New
   * classes are made from a stress law by MaterialOf. A material knows no
   * mesh, no clock and no MPI.
   */
  class Material : public CellKernel
  {
  public:
    virtual void
    declare_parameters(dealii::ParameterHandler &prm);

    /** Refuses values that do not fit together, and derives what the law needs
     *  of them; @p place names the section. */
    virtual void
    check(const std::string &place);

    virtual ElasticConstants
    elastic_constants() const = 0;

    double
    damping_factor() const override;

    /** Density times the inertia factor: what the mass matrix sees [kg/m3]. */
    double
    inertial_density() const;

    /** Elastic stress at a point by itself [Pa]. */
    virtual SymmetricTensor3<double>
    stress(const SymmetricTensor3<double> &strain) const = 0;

    /** Response of a point by itself, whose memory of `n_history` numbers goes
     *  one step on. */
    virtual PointResponse<double>
    respond(const SymmetricTensor3<double> &strain,
            double                         *history,
            const PointSituation<double>   &situation) const = 0;

    /**
     * Strain e of the law from the total strain, of which @p initial_strain and
     * the change of temperature [K] were there before the earthquake.
     */
    SymmetricTensor3<double>
    strain_of_law(const SymmetricTensor3<double> &strain,
                  const SymmetricTensor3<double> &initial_strain,
                  const double                    temperature) const;

    /** Whether the law has no directions of its own. */
    virtual bool
    isotropic() const = 0;

    /** What the memory tells the user, with units. */
    virtual std::vector<std::string>
    output_names() const = 0;

    /** The values of `output_names` at a point. */
    virtual std::vector<double>
    outputs(const double *history, const double element_length) const = 0;

    /** A sentence for the log if cells as long as this [m] do not suit the
     *  law; else empty. */
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

    /** Factor on the stress: the static factor in the static stage; under
     *  dynamic load what lets the moduli hold at the reference frequency of
     *  the damping model. */
    double stiffness_scale = 1.;

    /** Stiffness of the springs of the damping filters together, over the
     *  material's own; 0 without. */
    double filter_stiffness = 0.;

    /** Factor on the strain that the law sees: the static factor in the static
     *  stage. */
    double strain_factor = 1.;
  };
} // namespace Voussoir

#endif
