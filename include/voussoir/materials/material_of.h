#ifndef voussoir_materials_material_of_h
#define voussoir_materials_material_of_h

#include <voussoir/materials/cell_energies.h>
#include <voussoir/materials/cell_kernels.h>
#include <voussoir/materials/material.h>

namespace Voussoir
{
  /** The material of a stress law; law.h defines a law. */
  template <typename Law>
  class MaterialOf : public Material
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      Material::declare_parameters(prm);
      law.declare_parameters(prm);
    }

    void
    check(const std::string &place) override
    {
      Material::check(place);
      law.check(place);
      if constexpr (has_memory)
        {
          auto of_static_state           = std::make_shared<MaterialOf>(*this);
          of_static_state->static_factor = 1.;
          of_static_state->law.set_static(static_factor);
          static_material = of_static_state;
        }
    }

    const Material &
    at_rest() const override
    {
      if constexpr (has_memory)
        if (static_material)
          return *static_material;
      return *this;
    }

    ElasticConstants
    elastic_constants() const override
    {
      return {inertial_density(), law.young_modulus, law.poisson_ratio};
    }

    SymmetricTensor3<double>
    stress(const SymmetricTensor3<double> &strain) const override
    {
      return law.stress(strain);
    }

    PointResponse<double>
    respond(const SymmetricTensor3<double> &strain,
            double                         *history,
            const PointSituation<double>   &situation) const override
    {
      if constexpr (has_memory)
        return law.respond(strain, history, situation);
      PointResponse<double> response(strain);
      response.stress = law.stress(strain);
      return response;
    }

    SymmetricTensor3<Lanes>
    stress_of_elastic_points(const SymmetricTensor3<Lanes> &strain,
                             const Lanes &element_length) const override
    {
      if constexpr (has_memory)
        {
          std::array<Lanes, Law::n_history> history{};
          return law
            .respond(strain,
                     history.data(),
                     PointSituation<Lanes>{element_length, 0.})
            .stress;
        }
      else
        return law.stress(strain);
    }

    TensileFailure
    tensile_failure() const override
    {
      return law.tensile_failure();
    }

    bool
    isotropic() const override
    {
      return Law::isotropic;
    }

    std::vector<std::string>
    output_names() const override
    {
      return Law::output_names();
    }

    double
    yield_ratio(const SymmetricTensor3<double> &elastic_stress,
                const double                    element_length) const override
    {
      if constexpr (Law::n_history > 0)
        return law.yield_ratio(elastic_stress, element_length);
      else
        return 0.;
    }

    Lanes
    yield_ratio(const SymmetricTensor3<Lanes> &elastic_stress,
                const Lanes                   &element_length) const override
    {
      if constexpr (Law::n_history > 0)
        return law.yield_ratio(elastic_stress, element_length);
      else
        return 0.;
    }

    std::vector<double>
    outputs(const double *history, const double element_length) const override
    {
      return law.outputs(history, element_length);
    }

    double
    tip_strength(const double cell_size) const override
    {
      return law.tip_strength(cell_size);
    }

    double
    tensile_strength() const override
    {
      return law.tensile_failure().strength;
    }

    bool
    is_cracked(const double *history) const override
    {
      return Law::is_cracked(history);
    }

    bool
    cracks_along_planes() const override
    {
      return law.cracks_along_planes();
    }

    std::string
    remark(const double element_length) const override
    {
      std::string text = law.remark(element_length);
      if constexpr (has_memory)
        {
          const std::string at_rest =
            static_material->law.remark(element_length);
          if (!at_rest.empty() && at_rest != text)
            text += (text.empty() ? "in the static state " :
                                    "; in the static state ") +
                    at_rest;
        }
      return text.empty() ? text : text + ".";
    }

    unsigned int
    n_history() const override
    {
      return n_history_of<Law>;
    }

    void
    add_force(const CellRange  &cells,
              const SweepInput &input,
              Vector           &force) const override
    {
      CellKernels::add_force(law, cells, damping, input, force);
    }

    // the next five are called for laws with internal variables only

    void
    add_response(const CellRange  &cells,
                 const SweepInput &input,
                 Vector           &force,
                 PointHistory     &history) const override
    {
      if constexpr (has_memory)
        CellKernels::add_response(law, cells, damping, input, force, history);
    }

    void
    set_thermal_strain(const CellRange &cells,
                       PointHistory    &history,
                       const Vector    &temperature) const override
    {
      if constexpr (has_memory)
        CellKernels::set_thermal_strain(cells, expansion, history, temperature);
    }

    void
    hand_over(const CellRange &cells, PointHistory &history) const override
    {
      if constexpr (has_memory)
        CellKernels::hand_over(
          law, static_material->law, cells, static_factor, history);
    }

    void
    set_static_state(const CellRange &cells,
                     PointHistory    &history,
                     const Vector    &displacement,
                     const Vector    &temperature) const override
    {
      if constexpr (has_memory)
        CellKernels::set_static_state(law,
                                      cells,
                                      static_factor,
                                      expansion,
                                      history,
                                      displacement,
                                      temperature);
    }

    ElasticEnergy
    elastic_energy(const CellRange    &cells,
                   const DampedMotion &motion,
                   PointHistory       *history) const override
    {
      return CellKernels::elastic_energy(law, cells, damping, motion, history);
    }

    Lanes
    stabilisation_energy(const CellRange    &batch,
                         const DampedMotion &motion,
                         const PointHistory &history) const override
    {
      return CellKernels::stabilisation_energy(
        law, batch, damping, motion, history);
    }

    SplitStress
    elastic_stress(const CellRange    &batch,
                   const Vector       &displacement,
                   const PointHistory *history) const override
    {
      return CellKernels::elastic_stress(law, batch, displacement, history);
    }

    InelasticEnergy
    inelastic_energy(const CellRange       &cells,
                     const InelasticMotion &motion,
                     const PointHistory    &history) const override
    {
      if constexpr (has_memory)
        return CellKernels::inelastic_energy(
          law, cells, damping, motion, history);
      else
        return {};
    }

    void
    add_thermal_force(const CellRange &cells,
                      Vector          &force,
                      const Vector    &temperature) const override
    {
      CellKernels::add_thermal_force(law, cells, expansion, force, temperature);
    }

    double
    work(const CellRange    &cells,
         const Vector       &u,
         const Vector       &v,
         const PointHistory *history) const override
    {
      return CellKernels::work(law, cells, u, v, history);
    }

    Lanes
    element_eigenvalues(
      const CellRange                    &batch,
      const dealii::AlignedVector<Lanes> &masses) const override
    {
      return CellKernels::element_eigenvalues(law, batch, masses);
    }

  private:
    static constexpr bool has_memory = Law::n_history > 0;

    Law law;
    std::shared_ptr<const MaterialOf>
      static_material; // of a law with internal variables
  };
} // namespace Voussoir

#endif
