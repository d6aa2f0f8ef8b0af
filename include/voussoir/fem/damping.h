#ifndef voussoir_fem_damping_h
#define voussoir_fem_damping_h

#include <voussoir/base/option.h>

#include <deal.II/base/parameter_handler.h>

#include <ostream>
#include <vector>

namespace Voussoir
{
  enum class DampingModel
  {
    maxwell,
    rayleigh,
    mass_proportional,
    none
  };

  inline OptionNames<DampingModel>
  option_names(const DampingModel)
  {
    return {{DampingModel::maxwell, "Maxwell"},
            {DampingModel::rayleigh, "Rayleigh"},
            {DampingModel::mass_proportional, "mass proportional"},
            {DampingModel::none, "none"}};
  }


  /** The entries of the section "Damping". */
  struct DampingParameters
  {
    DampingModel              model             = DampingModel::maxwell;
    double                    ratio             = 0.05;
    double                    lowest_frequency  = 1.;
    double                    highest_frequency = 20.;
    unsigned int              branches          = 3;
    std::string               reference         = "first mode";
    double                    mesh_viscosity    = 0.06;
    std::vector<unsigned int> modes;

    static constexpr unsigned int most_branches = 6;

    void
    declare(dealii::ParameterHandler &prm);

    /** @p n_modes: number of modes that the case computes */
    void
    check(const unsigned int n_modes) const;

    /** Whether the moduli are to hold at the first natural frequency. */
    bool
    follows_first_mode() const;

    /** Whether the damping depends on the natural modes. */
    bool
    depends_on_modes() const;
  };

  /**
   * Coefficients of the damping model.
   *
   * Maxwell: a constant ratio over a band of frequencies by filters on the
   * nodal displacement, f = K (u + s sum w_i), dw_i/dt = D_i du/dt - w_i/tau_i,
   * with the damping factor s of the material. Rayleigh: C = alpha M + beta s
   * K.
   */
  class Damping
  {
  public:
    /**
     * @param natural_frequencies [Hz]: Rayleigh damping has its ratio at those
     *   of the two modes that the parameters name; the first one is the
     *   reference of Maxwell damping, if the parameters ask for it
     */
    explicit Damping(const DampingParameters   &parameters,
                     const std::vector<double> &natural_frequencies = {});

    /** No damping. */
    static Damping
    none();

    /** Sets the viscosity for a mesh with this stable step without damping [s].
     */
    void
    add_mesh_viscosity(const double undamped_limit);

    /** Frequency at which the given moduli hold [Hz]; 0: they are relaxed. */
    double
    reference_frequency() const;

    /** Moduli in free vibration at a frequency [Hz] over the given ones, for a
     *  material of factor s. */
    double
    modulus(const double frequency, const double factor = 1.) const;

    /** Mass-proportional coefficient alpha [1/s]. */
    double mass_coefficient = 0.;

    /** Stiffness-proportional coefficient beta [s]. */
    double stiffness_coefficient = 0.;

    /** Viscosity for frequencies above those that the mesh carries [s]: it acts
     *  on the velocity as the stiffness-proportional coefficient, for any
     *  factor of the material and under every model. See
     *  DampingParameters::mesh_viscosity. */
    double mesh_viscosity = 0.;

    /** Maxwell branches: D_i and tau_i [s]. */
    std::vector<double> coefficients, relaxation_times;

    /** Sum of the D_i. */
    double
    branch_stiffness() const;

    /** Vectors of damping memory that a state has. */
    unsigned int
    n_branches() const;

    /**
     * gamma(dt) of the stable step: damping makes the cells stiffer by the
     * factor 1 + s gamma.
     */
    double
    stiffening(const double dt) const;

    /** Damping ratio at a frequency [Hz] for a material of factor s. */
    double
    ratio(const double frequency, const double factor = 1.) const;

    /** Storage modulus at a frequency [Hz] over the relaxed modulus. */
    double
    modulus_ratio(const double frequency, const double factor = 1.) const;

    /** Factor on the stiffness that makes the given moduli hold at the
     *  reference frequency: as storage modulus or, if this frequency is that of
     *  a mode, so that the free vibration in the mode has the given frequency.
     */
    double
    stiffness_scale(const double factor) const;

    /** Prints the achieved damping ratio over the frequency. */
    void
    print(std::ostream &out) const;

  private:
    /** Contribution of the Maxwell branches to the damping ratio. */
    double
    ratio_of_branches(const double frequency, const double factor) const;

    void
    fit_maxwell();

    void
    fit_rayleigh(const double first_frequency, const double second_frequency);

    DampingParameters parameters;
    double            reference = 0.;    // [Hz]
    bool              adapted   = false; // to the first mode
  };
} // namespace Voussoir

#endif
