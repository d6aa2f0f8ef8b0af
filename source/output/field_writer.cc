#include <voussoir/fem/nodal_values.h>
#include <voussoir/files/vtu_file.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/filtered_displacement.h>
#include <voussoir/output/law_stress.h>
#include <voussoir/output/material_memory.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Strain of a displacement at the points of a cell that pictures show. */
    class DrawnStrains
    {
    public:
      DrawnStrains(const Discretization &discretization, const Vector &vector)
        : displacement(with_ghosts(discretization, vector))
        , values(discretization.mapping,
                 discretization.fe,
                 QIterated<3>(QTrapezoid<1>(), discretization.degree),
                 update_gradients)
        , strains(values.n_quadrature_points)
      {}

      const std::vector<SymmetricTensor<2, 3>> &
      at(const Discretization::Cell &cell)
      {
        values.reinit(cell);
        values[FEValuesExtractors::Vector(0)].get_function_symmetric_gradients(
          displacement, strains);
        return strains;
      }

    private:
      const Vector                       displacement;
      FEValues<3>                        values;
      std::vector<SymmetricTensor<2, 3>> strains;
    };


    /** Strain and temperature of the static state at these points. */
    struct InitialPoints
    {
      explicit InitialPoints(const ObservedRun &run)
        : drawn(run.solid.discretization, run.initial.displacement)
        , temperature(
            with_ghosts(run.solid.discretization, run.initial.temperature))
        , values(run.solid.discretization.mapping,
                 run.solid.discretization.fe,
                 QIterated<3>(QTrapezoid<1>(), run.solid.discretization.degree),
                 update_values)
        , temperatures(values.n_quadrature_points)
      {}

      void
      reinit(const Discretization::Cell &cell)
      {
        strains = drawn.at(cell);
        values.reinit(cell);
        values[FEValuesExtractors::Scalar(0)].get_function_values(temperature,
                                                                  temperatures);
      }

      DrawnStrains                       drawn;
      const Vector                       temperature;
      FEValues<3>                        values;
      std::vector<SymmetricTensor<2, 3>> strains;
      std::vector<double>                temperatures; // change [K]
    };


    /** Principal stresses in MPa from the gradient of u, or of u + s w where
     *  all materials have the same damping. */
    class PrincipalStresses : public DataPostprocessor<3>
    {
    public:
      /** @param memory w of FilteredDisplacement, or null */
      PrincipalStresses(const ObservedRun &run, const Vector *memory)
        : run(run)
        , points(QTrapezoid<1>(), run.solid.discretization.degree)
        , initial(run.initial.displacement.size() > 0 ?
                    std::make_unique<InitialPoints>(run) :
                    nullptr)
        , memory(memory != nullptr ?
                   std::make_unique<DrawnStrains>(run.solid.discretization,
                                                  *memory) :
                   nullptr)
      {}

      void
      evaluate_vector_field(
        const DataPostprocessorInputs::Vector<3> &inputs,
        std::vector<dealii::Vector<double>>      &values) const override
      {
        const auto   cell = inputs.get_cell<3>();
        const double damping =
          run.solid.materials[run.solid.grid().material(cell)]
            ->damping_factor();
        if (initial)
          initial->reinit(cell);
        const auto *strains_of_memory = memory ? &memory->at(cell) : nullptr;
        for (unsigned int q = 0; q < values.size(); ++q)
          {
            Tensor<2, 3> gradient;
            for (unsigned int d = 0; d < 3; ++d)
              gradient[d] = inputs.solution_gradients[q][d];
            SymmetricTensor<2, 3> filtered = symmetrize(gradient);
            if (strains_of_memory != nullptr)
              filtered += damping * (*strains_of_memory)[q];
            const LawStress law(run, cell, points.point(q));
            const auto      elastic =
              initial ? law.elastic_strain(filtered,
                                           initial->strains[q],
                                           initial->temperatures[q]) :
                             law.elastic_strain(filtered, {}, 0.);
            const auto [largest, smallest] =
              largest_and_smallest_principal(law(elastic));
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
      const ObservedRun                   &run;
      const QIterated<3>                   points;  // that pictures show
      const std::unique_ptr<InitialPoints> initial; // null: no static stage
      const std::unique_ptr<DrawnStrains>  memory;  // null: none
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
        model.solid.grid().triangulation().n_active_cells());
      for (const auto &cell :
           model.solid.discretization.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          result[cell->active_cell_index()] = model.solid.grid().material(cell);
      return result;
    }


    std::vector<VtuText>
    texts(const ObservedModel &model)
    {
      std::vector<VtuText> result{{"material_names", model.names.materials},
                                  {"cell_set_names", model.names.cell_sets}};
      if (model.base_moves)
        result.push_back({"motion", {"relative to the rigid base"}});
      return result;
    }
  } // namespace


  namespace
  {
    /** Fields of a picture. */
    struct Picture
    {
      const std::vector<NodalField> &fields;
      const std::vector<CellField>   cell_fields = {};

      // principal stresses, null if not written, and the displacement they
      // follow from
      std::unique_ptr<const PrincipalStresses> stress   = nullptr;
      Vector                                   filtered = {};
    };


    std::string
    write(const ObservedModel  &model,
          const MaterialMemory &memory,
          const Picture        &picture,
          const std::string    &folder,
          const std::string    &name,
          const double          time)
    {
      const Discretization &discretization = model.solid.discretization;

      DataOut<3> data_out;
      data_out.attach_dof_handler(discretization.dof_handler);
      std::vector<Vector> vectors;
      vectors.reserve(picture.fields.size());
      for (const NodalField &field : picture.fields)
        {
          vectors.push_back(with_ghosts(discretization, *field.vector));
          const bool one = field.names.size() == 1;
          data_out.add_data_vector(
            discretization.dof_handler,
            vectors.back(),
            one ? std::vector<std::string>(3, field.names[0]) : field.names,
            std::vector<
              DataComponentInterpretation::DataComponentInterpretation>(
              3,
              one ? DataComponentInterpretation::component_is_part_of_vector :
                    DataComponentInterpretation::component_is_scalar));
        }
      if (picture.stress)
        data_out.add_data_vector(picture.filtered, *picture.stress);

      const auto material = material_of_cells(model);
      const auto cell_set =
        smallest_cell_sets(discretization.grid, model.names.cell_sets);
      data_out.add_data_vector(material, "material");
      data_out.add_data_vector(cell_set, "cell_set");
      for (const CellField &field : picture.cell_fields)
        data_out.add_data_vector(*field.values, field.name);
      const auto remembered = memory_of_cells(model.solid, memory);
      for (const auto &[memory_name, values] : remembered)
        data_out.add_data_vector(values, vtk_name(memory_name));

      data_out.build_patches(discretization.mapping, discretization.degree);
      const std::string file = name + ".vtu";
      const bool        written =
        write_vtu(data_out, folder + "/" + file, time, texts(model), model.log);
      return written ? file : "";
    }
  } // namespace


  std::string
  write_fields(const ObservedRun             &run,
               const std::vector<NodalField> &fields,
               const State                   *stress_of,
               const std::string             &name,
               const double                   time,
               const std::vector<CellField>  &cell_fields)
  {
    Picture picture{fields, cell_fields};
    if (stress_of != nullptr)
      {
        FilteredDisplacement filtered(run);
        filtered.update(*stress_of);
        picture.stress =
          std::make_unique<PrincipalStresses>(run, filtered.memory());
        picture.filtered =
          with_ghosts(run.solid.discretization, filtered.displacement());
      }
    return write(run, run.material_memory, picture, run.folder, name, time);
  }


  std::string
  write_fields(const ObservedModel           &model,
               const std::string             &folder,
               const std::vector<NodalField> &fields,
               const std::string             &name)
  {
    return write(model, {}, {fields}, folder, name, 0.);
  }
} // namespace Voussoir
