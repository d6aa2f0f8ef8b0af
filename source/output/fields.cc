#include <voussoir/base/parameter_file.h>
#include <voussoir/mesh/mesh_quality.h>
#include <voussoir/output/displacement_since.h>
#include <voussoir/output/field_writer.h>
#include <voussoir/output/picture_series.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Pictures of the whole model at chosen times. */
    class Fields : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Quantities",
                          quantities,
                          "Fields to write: displacement [m], also since the "
                          "static state or the last grouting of joints, "
                          "velocity [m/s], principal stress [MPa], mesh "
                          "quality (scaled Jacobian and aspect ratio of the "
                          "cells).",
                          Patterns::MultipleSelection(
                            "displacement|" + since_static_state + "|" +
                            since_grouting +
                            "|velocity|principal stress|mesh quality"));
        prm.add_parameter("Static stages",
                          static_stages,
                          "Write the displacement after each static stage, in "
                          "static_stages.vtu.");
        pictures.declare_parameters(prm);
      }

      void
      check(const ObservedModel &model) const override
      {
        check_grouting(quantities, "Output/fields", model);
        pictures.check(model);
      }

      void
      observe(const State &state) override
      {
        if (!pictures.due(state))
          return;
        const auto list  = split_list(quantities);
        const auto wants = [&](const std::string &quantity) {
          return std::find(list.begin(), list.end(), quantity) != list.end();
        };
        std::vector<NodalField> nodal;
        if (wants("displacement"))
          nodal.push_back({&state.displacement, {"displacement"}});
        std::map<std::string, Vector> since;
        for (const std::string &quantity : {since_static_state, since_grouting})
          if (wants(quantity))
            {
              Vector &displacement = since[quantity] = state.displacement;
              if (const Vector *origin = origin_of(quantity, run().initial))
                displacement -= *origin;
              std::string name = quantity;
              std::replace(name.begin(), name.end(), ' ', '_');
              nodal.push_back({&displacement, {name}});
            }
        if (wants("velocity"))
          nodal.push_back({&state.velocity, {"velocity"}});
        std::vector<CellField> of_cells;
        if (wants("mesh quality"))
          {
            if (aspect_ratio.size() == 0)
              find_quality();
            of_cells = {{&scaled_jacobian, "scaled_Jacobian"},
                        {&aspect_ratio, "aspect_ratio"}};
          }
        pictures.add(state.time,
                     write_fields(run(),
                                  nodal,
                                  wants("principal stress") ? &state : nullptr,
                                  pictures.next_name(state),
                                  state.time,
                                  of_cells));
      }

    private:
      void
      prepare() override
      {
        aspect_ratio.reinit(0);
        pictures.prepare(run());
        const auto &stages = run().initial.stages;
        if (!static_stages || stages.empty() || run().restarted)
          return;
        std::vector<NodalField> fields;
        for (const auto &[name, displacement] : stages)
          fields.push_back({&displacement, {"displacement after " + name}});
        write_fields(run(), fields, nullptr, "static_stages", 0.);
      }

      void
      conclude(const State &, nlohmann::json &summary) override
      {
        summary["pictures"] = pictures.size();
      }

      void
      find_quality()
      {
        const Triangulation<3> &mesh = run().solid.grid().triangulation();
        scaled_jacobian.reinit(mesh.n_active_cells());
        aspect_ratio.reinit(mesh.n_active_cells());
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              std::array<Point<3>, 8> vertices;
              for (unsigned int v = 0; v < 8; ++v)
                vertices[v] = cell->vertex(v);
              MeshQuality quality;
              quality.take(vertices);
              scaled_jacobian[cell->active_cell_index()] =
                quality.scaled_jacobian;
              aspect_ratio[cell->active_cell_index()] = quality.aspect_ratio;
            }
      }

      std::string   quantities    = "displacement, principal stress";
      bool          static_stages = true;
      PictureSeries pictures{"fields", "Output/fields"};

      // of the cells, once a picture needs them
      dealii::Vector<float> scaled_jacobian, aspect_ratio;
    };

    const Registry<Observer>::Add<Fields> registered_fields(
      "fields",
      "Pictures of the whole model at chosen times, in fields.pvd for "
      "ParaView.");
  } // namespace
} // namespace Voussoir
