#ifndef voussoir_materials_material_h
#define voussoir_materials_material_h

#include <voussoir/base/registry.h>
#include <voussoir/fem/internal_force.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/matrix_free/fe_evaluation.h>

namespace Voussoir
{
  /** Strain or stress of one integration point in each SIMD lane. */
  template <typename Number>
  using SymmetricTensor3 = dealii::SymmetricTensor<2, 3, Number>;

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

  /**
   * A material of a case: a named section of the parameter file, the cell sets
   * it fills, and the kernel that turns displacement into internal force.
   *
   * A new class of materials is one file: a struct with the stress law,
   *
   *   struct Law
   *   {
   *     void declare_parameters(ParameterHandler &prm);  // add_parameter()
   *     void check(const std::string &place) const;      // UserError
   *     template <typename Number>
   *     SymmetricTensor3<Number>
   *     stress(const SymmetricTensor3<Number> &strain) const;
   *     double young_modulus, poisson_ratio;
   *   };
   *
   * and `const Registry<Material>::Add<MaterialOf<Law>> registered("name",
   * "One sentence.");`. A material knows no mesh, no clock and no MPI.
   */
  class Material : public CellKernel
  {
  public:
    virtual void
    declare_parameters(dealii::ParameterHandler &prm);

    /** Refuses values that do not fit together; @p place names the section. */
    virtual void
    check(const std::string &place) const;

    virtual ElasticConstants
    elastic_constants() const = 0;

    double
    damping_factor() const override;

    /** Density times the inertia factor: what the mass matrix sees [kg/m3]. */
    double
    inertial_density() const;

    /** Stress at a point by itself, for output [Pa]. */
    virtual SymmetricTensor3<double>
    stress(const SymmetricTensor3<double> &strain) const = 0;

    /**
     * Stress under the total strain, of which @p initial_strain and the change
     * of temperature [K] were there before the earthquake [Pa].
     */
    SymmetricTensor3<double>
    total_stress(const SymmetricTensor3<double> &strain,
                 const SymmetricTensor3<double> &initial_strain,
                 const double                    temperature) const;

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
  };


  /** The material that a stress law makes; see Material. */
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
    check(const std::string &place) const override
    {
      Material::check(place);
      law.check(place);
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

    void
    add_force(const MatrixFree  &matrix_free,
              Vector            &force,
              const Vector      &displacement,
              const Vector      *memory,
              const unsigned int begin,
              const unsigned int end) const override
    {
      Evaluation cell(matrix_free);
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          cell.reinit(batch);
          cell.read_dof_values(displacement);
          if (memory != nullptr)
            add_memory(cell, *memory);
          cell.evaluate(dealii::EvaluationFlags::gradients);
          for (const unsigned int q : cell.quadrature_point_indices())
            cell.submit_symmetric_gradient(
              stiffness_scale * law.stress(cell.get_symmetric_gradient(q)), q);
          cell.integrate(dealii::EvaluationFlags::gradients);
          cell.distribute_local_to_global(force);
        }
    }

    void
    add_thermal_force(const MatrixFree  &matrix_free,
                      Vector            &force,
                      const Vector      &temperature,
                      const unsigned int begin,
                      const unsigned int end) const override
    {
      Evaluation cell(matrix_free);
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          cell.reinit(batch);
          cell.gather_evaluate(temperature, dealii::EvaluationFlags::values);
          for (const unsigned int q : cell.quadrature_point_indices())
            {
              SymmetricTensor3<Lanes> strain;
              for (unsigned int d = 0; d < 3; ++d)
                strain[d][d] = expansion * cell.get_value(q)[d];
              cell.submit_symmetric_gradient(stiffness_scale *
                                               law.stress(strain),
                                             q);
            }
          cell.integrate_scatter(dealii::EvaluationFlags::gradients, force);
        }
    }

    double
    work(const MatrixFree  &matrix_free,
         const Vector      &u,
         const Vector      &v,
         const unsigned int begin,
         const unsigned int end) const override
    {
      Evaluation cell_u(matrix_free), cell_v(matrix_free);
      Lanes      sum = 0.;
      for (unsigned int batch = begin; batch < end; ++batch)
        {
          cell_u.reinit(batch);
          cell_u.read_dof_values(u);
          cell_u.evaluate(dealii::EvaluationFlags::gradients);
          Evaluation *other = &cell_u;
          if (&u != &v)
            {
              cell_v.reinit(batch);
              cell_v.read_dof_values(v);
              cell_v.evaluate(dealii::EvaluationFlags::gradients);
              other = &cell_v;
            }
          Lanes batch_sum = 0.;
          for (const unsigned int q : cell_u.quadrature_point_indices())
            batch_sum += stiffness_scale *
                         law.stress(cell_u.get_symmetric_gradient(q)) *
                         other->get_symmetric_gradient(q) * cell_u.JxW(q);
          // lanes beyond the last cell of a material hold copies
          for (unsigned int lane = 0;
               lane < matrix_free.n_active_entries_per_cell_batch(batch);
               ++lane)
            sum[lane] += batch_sum[lane];
        }
      double total = 0.;
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        total += sum[lane];
      return total;
    }

    Lanes
    element_eigenvalues(
      const MatrixFree                   &matrix_free,
      const unsigned int                  batch,
      const dealii::AlignedVector<Lanes> &masses) const override
    {
      // power iteration, which 30 products bring within one or two per cent
      Evaluation cell(matrix_free);
      cell.reinit(batch);
      const unsigned int           n = masses.size();
      dealii::AlignedVector<Lanes> mode(3 * n);
      for (unsigned int i = 0; i < 3 * n; ++i)
        mode[i] = std::cos(2.3 * i * i + 0.7 * i);
      Lanes eigenvalue = 0.;
      for (unsigned int iteration = 0; iteration < 30; ++iteration)
        {
          Lanes norm = 0.;
          for (unsigned int i = 0; i < 3 * n; ++i)
            norm += mode[i] * mode[i] * masses[i % n];
          norm = 1. / std::sqrt(norm);
          for (unsigned int i = 0; i < 3 * n; ++i)
            cell.begin_dof_values()[i] = mode[i] *= norm;
          cell.evaluate(dealii::EvaluationFlags::gradients);
          for (const unsigned int q : cell.quadrature_point_indices())
            cell.submit_symmetric_gradient(
              stiffness_scale * law.stress(cell.get_symmetric_gradient(q)), q);
          cell.integrate(dealii::EvaluationFlags::gradients);
          eigenvalue = 0.;
          for (unsigned int i = 0; i < 3 * n; ++i)
            {
              eigenvalue += mode[i] * cell.begin_dof_values()[i];
              mode[i] = cell.begin_dof_values()[i] / masses[i % n];
            }
        }
      return eigenvalue;
    }

  private:
    // degree and number of points are known at run time only: as fast as with
    // template arguments, and one instantiation serves all degrees
    using Evaluation = dealii::FEEvaluation<3, -1, 0, 3, double>;

    void
    add_memory(Evaluation &cell, const Vector &memory) const
    {
      std::array<Lanes, 3 * 125> values; // up to degree 4
      const unsigned int         n = cell.dofs_per_cell;
      for (unsigned int i = 0; i < n; ++i)
        values[i] = cell.begin_dof_values()[i];
      cell.read_dof_values(memory);
      for (unsigned int i = 0; i < n; ++i)
        cell.begin_dof_values()[i] =
          values[i] + damping * cell.begin_dof_values()[i];
    }

    Law law;
  };
} // namespace Voussoir

#endif
