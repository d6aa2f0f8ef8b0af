#ifndef voussoir_materials_law_h
#define voussoir_materials_law_h

#include <voussoir/fem/simd.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Voussoir
{
  template <typename Number>
  struct PointResponse;

  /** Failure in tension. */
  struct TensileFailure
  {
    double strength     = 0.; // ft [Pa]; 0: none
    double crack_length = 0.; // E Gf / ft^2 [m]; 0: no fracture energy
  };


  /**
   * The contract of a stress law, for those who add one. A law is a struct
   * without mesh, clock and ranks, in one file of its own with the line
   *
   *   const Registry<Material>::Add<MaterialOf<Law>>
   *     registered_name("name", "One sentence.");
   *
   * See doc/new_material.md for the steps. The functions of a law are templates
   * in the type of numbers: `double` for a single point, `Lanes` for one point
   * of each cell of a batch. Tension is positive; tensors have their true
   * components (no doubled shear strains).
   *
   * Every law has the following, most laws by IsotropicElasticity:
   *
   *     double young_modulus;  // E [Pa]
   *     double poisson_ratio;  // nu [1]
   *     void declare_parameters(ParameterHandler &prm);  // add_parameter()
   *     template <typename Number>
   *     SymmetricTensor3<Number>
   *     stress(const SymmetricTensor3<Number> &strain) const; // elastic [Pa]
   *
   * where E and nu are those of waves, boundaries and one-point cells.
   *
   * A law with internal variables has n_history > 0 of them at each point,
   * which begin at zero and stay there while the point is elastic, and
   *
   *     template <typename Number>
   *     PointResponse<Number>
   *     respond(const SymmetricTensor3<Number> &strain,
   *             Number                         *history,
   *             const PointSituation<Number>   &situation) const;
   *
   * which returns the response to the strain e [1] of the point, and updates
   * its history by one step. Where the response is elastic, it must be
   * `stress`. It also has, most laws by IsotropicElasticity,
   *
   *     void set_static(const double factor);
   *
   * which turns the law, once checked, into that of the static state: its
   * modulus times the static factor, strengths without the increase for an
   * earthquake.
   *
   * Members that LawDefaults has are optional.
   */
  struct LawDefaults
  {
    /** Internal variables of a point. */
    static constexpr unsigned int n_history = 0;

    /** Whether the law reports its plastic flow, on which the branches of
     *  Maxwell damping do not act. */
    static constexpr bool flows = false;

    /** Whether the law has no directions of its own. */
    static constexpr bool isotropic = true;

    /** Refuses entries that do not fit together by a UserError that begins with
     *  @p place, and computes derived constants. */
    void
    check(const std::string & /*place*/) const
    {}

    /**
     * A cheap upper bound of the yield ratio, above one at the elastic limit or
     * before. As long as it is at most one, a point that has been elastic so
     * far stays elastic without a call of `respond`. By default `respond` is
     * called for every point.
     *
     * @param elastic_stress [Pa]
     * @param element_length as in PointSituation [m]
     */
    template <typename Number>
    Number
    yield_ratio(const SymmetricTensor3<Number> & /*elastic_stress*/,
                const Number & /*element_length*/) const
    {
      return 2.;
    }

    /**
     * Converts a point from the law of the static state, under which it has
     * left the elastic range: changes the internal variables where they depend
     * on the modulus, and returns the strain e at which this law has the same
     * stress. By default plastic strains stay, and the elastic strain follows
     * the modulus.
     *
     * @param strain         e of the law of the static state [1]
     * @param response       of that law
     * @param element_length as in PointSituation [m]
     * @param static_factor  modulus of that law over that of this one
     */
    SymmetricTensor3<double>
    hand_over(const SymmetricTensor3<double> &strain,
              const PointResponse<double>    &response,
              double * /*history*/,
              const double /*element_length*/,
              const double static_factor) const;

    /** Names of the results from the history, with units; laws that share a
     *  name share one field of the pictures. */
    static std::vector<std::string>
    output_names()
    {
      return {};
    }

    /** The values of `output_names` at a point that has left the elastic
     *  range. */
    std::vector<double>
    outputs(const double * /*history*/, const double /*element_length*/) const
    {
      return {};
    }

    TensileFailure
    tensile_failure() const
    {
      return {};
    }

    /** Tensile strength of a cell of this size [m] that a crack runs into, over
     *  that of the material; 1 for a law whose cracks grow by strength alone.
     *  Cells at a tip have it in PointSituation. */
    double
    tip_strength(const double /*cell_size*/) const
    {
      return 1.;
    }

    /** Whether a point with this history has a crack that may run on. */
    static bool
    is_cracked(const double * /*history*/)
    {
      return false;
    }

    /** Whether cracks have planes that go on from cell to cell; see
     *  CrackPlanes. */
    bool
    cracks_along_planes() const
    {
      return false;
    }

    /** A clause for the log if cells of this length [m] do not suit the law;
     *  else empty. */
    std::string
    remark(const double /*element_length*/) const
    {
      return {};
    }
  };

  /** Arguments of a law with internal variables besides the strain. */
  template <typename Number>
  struct PointSituation
  {
    Number element_length; // width of the band of the crack in the cell [m]
    double time_step;      // since the last call [s]

    Number tip_strength = Number(1.); // see LawDefaults::tip_strength

    /** Normal of the crack that the cell has or is about to have; zero if it is
     *  not known. */
    dealii::Tensor<1, 3, Number> crack_normal = {};
  };

  /** Response of a law with internal variables; by default, that of a point
   *  without stress and losses. */
  template <typename Number>
  struct PointResponse
  {
    explicit PointResponse(const SymmetricTensor3<Number> &strain)
      : elastic_strain(strain)
    {}

    /** sigma [Pa]. */
    SymmetricTensor3<Number> stress;

    /** e_e [1], so that sigma : e_e / 2 is the stored energy; all of the strain
     *  unless there is plastic strain. */
    SymmetricTensor3<Number> elastic_strain;

    /** Energy lost in this step to cracks and plastic flow [J/m3], without the
     *  losses of damping. */
    Number dissipation = Number(0.);

    /** Share of the stiffness that damage leaves, to which damping is
     *  proportional; for a single damage d that is 1 - d. */
    Number damping_share = Number(1.);

    /** Plastic strain of this step [1]. */
    SymmetricTensor3<Number> plastic_increment = SymmetricTensor3<Number>();
  };


  inline SymmetricTensor3<double>
  LawDefaults::hand_over(const SymmetricTensor3<double> &strain,
                         const PointResponse<double>    &response,
                         double *,
                         const double,
                         const double static_factor) const
  {
    return strain - (1. - static_factor) * response.elastic_strain;
  }
} // namespace Voussoir

#endif
