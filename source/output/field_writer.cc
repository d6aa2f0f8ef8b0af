#include <voussoir/fem/nodal_values.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/law_stress.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/output/vtu_file.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** What the static stage left, at the points of a cell that are drawn. */
    struct InitialPoints
    {
      explicit InitialPoints(const ObservedModel &model)
        : discretization(model.discretization)
        , displacement(with_ghosts(discretization, model.initial.displacement))
        , temperature(with_ghosts(discretization, model.initial.temperature))
        , values(discretization.mapping,
                 discretization.fe,
                 QIterated<3>(QTrapezoid<1>(), discretization.degree),
                 update_values | update_gradients)
        , strains(values.n_quadrature_points)
        , temperatures(values.n_quadrature_points)
      {}

      void
      reinit(const Discretization::Cell &cell)
      {
        values.reinit(cell);
        values[FEValuesExtractors::Vector(0)].get_function_symmetric_gradients(
          displacement, strains);
        values[FEValuesExtractors::Scalar(0)].get_function_values(temperature,
                                                                  temperatures);
      }

      const Discretization              &discretization;
      const Vector                       displacement, temperature;
      FEValues<3>                        values;
      std::vector<SymmetricTensor<2, 3>> strains;
      std::vector<double>                temperatures; // change [K]
    };


    /** Principal stresses in MPa from the displacement gradient. */
    class PrincipalStresses : public DataPostprocessor<3>
    {
    public:
      explicit PrincipalStresses(const ObservedModel &model)
        : model(model)
        , points(QTrapezoid<1>(), model.discretization.degree)
        , initial(model.initial.displacement.size() > 0 ?
                    std::make_unique<InitialPoints>(model) :
                    nullptr)
      {}

      void
      evaluate_vector_field(
        const DataPostprocessorInputs::Vector<3> &inputs,
        std::vector<dealii::Vector<double>>      &values) const override
      {
        const auto cell = inputs.get_cell<3>();
        if (initial)
          initial->reinit(cell);
        for (unsigned int q = 0; q < values.size(); ++q)
          {
            Tensor<2, 3> gradient;
            for (unsigned int d = 0; d < 3; ++d)
              gradient[d] = inputs.solution_gradients[q][d];
            const LawStress law(model, cell, points.point(q));
            const auto [largest, smallest] = largest_and_smallest_principal(
              initial ? law(symmetrize(gradient),
                            initial->strains[q],
                            initial->temperatures[q]) :
                        law(symmetrize(gradient), {}, 0.));
            values[q](0) = 1e-6 * largest;
            values[q](1) = 1e-6 * smallest;
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
      const ObservedModel                 &model;
      const QIterated<3>                   points;  // that are drawn
      const std::unique_ptr<InitialPoints> initial; // null: no static stage
    };


    /** "crack opening [mm]" as "crack_opening_mm". */
    std::string
    vtk_name(std::string name)
    {
      name.erase(std::remove_if(name.begin(),
                                name.end(),
                                [](const char c) {
                                  return c == '[' || c == ']';
                                }),
                 name.end());
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    }


    dealii::Vector<float>
    material_of_cells(const ObservedModel &model)
    {
      dealii::Vector<float> result(
        model.discretization.grid.triangulation().n_active_cells());
      for (const auto &cell :
           model.discretization.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          result[cell->active_cell_index()] = model.material_of_cell(cell);
      return result;
    }


    std::vector<VtuText>
    texts(const ObservedModel &model)
    {
      std::vector<VtuText> result{{"material_names", model.names.materials},
                                  {"cell_set_names", model.names.cell_sets}};
      if (model.base.moves())
        result.push_back({"motion", {"relative to the rigid base"}});
      return result;
    }
  } // namespace


  std::string
  write_fields(const ObservedModel           &model,
               const std::vector<NodalField> &fields,
               const Vector                  *stress_of,
               const std::string             &name,
               const double                   time,
               const std::vector<CellField>  &cell_fields)
  {
    const Discretization &discretization = model.discretization;

    DataOut<3> data_out;
    data_out.attach_dof_handler(discretization.dof_handler);
    std::vector<Vector> vectors;
    vectors.reserve(fields.size() + 1);
    for (const NodalField &field : fields)
      {
        vectors.push_back(with_ghosts(discretization, *field.vector));
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
        vectors.push_back(with_ghosts(discretization, *stress_of));
        data_out.add_data_vector(vectors.back(), stresses);
      }

    const auto material = material_of_cells(model);
    const auto cell_set =
      smallest_cell_sets(discretization.grid, model.names.cell_sets);
    data_out.add_data_vector(material, "material");
    data_out.add_data_vector(cell_set, "cell_set");
    for (const CellField &field : cell_fields)
      data_out.add_data_vector(*field.values, field.name);
    const auto memory = memory_of_cells(model);
    for (const auto &[memory_name, values] : memory)
      data_out.add_data_vector(values, vtk_name(memory_name));

    data_out.build_patches(discretization.mapping, discretization.degree);
    const std::string file    = name + ".vtu";
    const bool        written = write_vtu(
      data_out, model.folder + "/" + file, time, texts(model), model.log);
    return written ? file : "";
  }
} // namespace Voussoir
