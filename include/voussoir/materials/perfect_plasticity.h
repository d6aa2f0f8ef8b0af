#ifndef voussoir_materials_perfect_plasticity_h
#define voussoir_materials_perfect_plasticity_h

#include <voussoir/materials/cohesion_and_friction.h>
#include <voussoir/materials/isotropic_elasticity.h>

namespace Voussoir
{
  /**
   * Common part of the laws of rock with friction and cohesion, which yield
   * without hardening or softening. Their internal variables are the plastic
   * strain and the equivalent plastic strain, the sum of sqrt(2/3 de : de).
   */
  struct PerfectPlasticity : IsotropicElasticity, CohesionAndFriction
  {
    static constexpr unsigned int n_history = 7;
    static constexpr bool         flows     = true;

    double dilation_angle = 10.;   // psi [degrees]
    double cut_off        = 0.5e6; // [Pa]

    PerfectPlasticity();

    void
    declare_parameters(dealii::ParameterHandler &prm);

    void
    check(const std::string &place) const;

    /** Plastic flow that reduces the elastic @p trial stress of a strain by @p
     *  excess.
     */
    template <typename Number>
    PointResponse<Number>
    flow(const SymmetricTensor3<Number> &strain,
         const SymmetricTensor3<Number> &trial,
         const SymmetricTensor3<Number> &excess,
         Number                         *history) const
    {
      const SymmetricTensor3<Number> increment = this->strain(excess);
      for (unsigned int i = 0; i < 6; ++i)
        history[i] += increment.access_raw_entry(i);
      history[6] += std::sqrt(Number(2. / 3. * (increment * increment)));

      PointResponse<Number> response(strain);
      response.stress = trial - excess;
      response.elastic_strain -= tensor_of(history);
      response.dissipation       = response.stress * increment;
      response.plastic_increment = increment;
      return response;
    }

    static std::vector<std::string>
    output_names();

    std::vector<double>
    outputs(const double *history, const double element_length) const;
  };
} // namespace Voussoir

#endif
