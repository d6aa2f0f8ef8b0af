#include <voussoir/output/field_writer.h>

#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Principal stresses in MPa from the displacement gradient. */
    class PrincipalStresses : public DataPostprocessor<3>
    {
    public:
      explicit PrincipalStresses(const ObservedModel &model)
        : model(model)
      {}

      void
      evaluate_vector_field(
        const DataPostprocessorInputs::Vector<3> &inputs,
        std::vector<dealii::Vector<double>>      &values) const override
      {
        const auto &material =
          *model.materials[model.material_of_cell(inputs.get_cell<3>())];
        for (unsigned int q = 0; q < values.size(); ++q)
          {
            Tensor<2, 3> gradient;
            for (unsigned int d = 0; d < 3; ++d)
              gradient[d] = inputs.solution_gradients[q][d];
            const auto principal =
              eigenvalues(material.stress(symmetrize(gradient)));
            values[q](0) = 1e-6 * principal[0];
            values[q](1) = 1e-6 * principal[2];
          }
      }

      std::vector<std::string>
      get_names() const override
      {
        return {"largest_principal_stress_MPa",
                "smallest_principal_stress_MPa"};
      }

      UpdateFlags
      get_needed_update_flags() const override
      {
        return update_gradients;
      }

      std::vector<DataComponentInterpretation::DataComponentInterpretation>
      get_data_component_interpretation() const override
      {
        return {2, DataComponentInterpretation::component_is_scalar};
      }

    private:
      const ObservedModel &model;
    };
  } // namespace


  std::string
  write_fields(const ObservedModel           &model,
               const std::vector<NodalField> &fields,
               const Vector                  *stress_of,
               const std::string             &name,
               const double                   time)
  {
    const Discretization &discretization = model.discretization;
    const auto            with_ghosts    = [&](const Vector &vector) {
      Vector full(discretization.owned_dofs,
                  discretization.relevant_dofs,
                  discretization.grid.communicator());
      for (unsigned int i = 0; i < vector.locally_owned_size(); ++i)
        full.local_element(i) = vector.local_element(i);
      full.update_ghost_values();
      discretization.hanging_nodes.distribute(full);
      full.update_ghost_values();
      return full;
    };

    DataOut<3> data_out;
    data_out.attach_dof_handler(discretization.dof_handler);
    std::vector<Vector> vectors;
    vectors.reserve(fields.size() + 1);
    for (const NodalField &field : fields)
      {
        vectors.push_back(with_ghosts(*field.vector));
        const bool one = field.names.size() == 1;
        data_out.add_data_vector(
          discretization.dof_handler,
          vectors.back(),
          one ? std::vector<std::string>(3, field.names[0]) : field.names,
          std::vector<DataComponentInterpretation::DataComponentInterpretation>(
            3,
            one ? DataComponentInterpretation::component_is_part_of_vector :
                  DataComponentInterpretation::component_is_scalar));
      }
    PrincipalStresses stresses(model);
    if (stress_of != nullptr)
      {
        vectors.push_back(with_ghosts(*stress_of));
        data_out.add_data_vector(vectors.back(), stresses);
      }

    dealii::Vector<float> material(
      discretization.grid.triangulation().n_active_cells());
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        material[cell->active_cell_index()] = model.material_of_cell(cell);
    data_out.add_data_vector(material, "material");

    DataOutBase::VtkFlags flags;
    flags.time                     = time;
    flags.compression_level        = DataOutBase::VtkFlags::best_speed;
    flags.write_higher_order_cells = false;
    data_out.set_flags(flags);
    data_out.build_patches(discretization.mapping, discretization.degree);
    const std::string file = name + ".vtu";
    data_out.write_vtu_in_parallel(model.folder + "/" + file,
                                   discretization.grid.communicator());
    return file;
  }
} // namespace Voussoir
