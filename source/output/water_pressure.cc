#include <voussoir/base/error.h>
#include <voussoir/files/vtu_file.h>
#include <voussoir/loads/water_motion.h>
#include <voussoir/output/picture_series.h>

#include <deal.II/numerics/data_out.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Pictures of the pressure in compressible water. */
    class WaterPressure : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        pictures.declare_parameters(prm);
      }

      void
      check(const ObservedModel &model) const override
      {
        if (model.reservoir == nullptr)
          throw UserError("\"Observers\" in section \"Output\" names \"water "
                          "pressure\", but there is no compressible water; set "
                          "\"Model = compressible\" in section \"Reservoir\".");
        pictures.check(model);
      }

      void
      observe(const State &state) override
      {
        if (!pictures.due(state))
          return;
        const AcousticSpace &space    = run().water->reservoir.space;
        Vector               pressure = space.create_ghosted_vector(); // [MPa]
        pressure.copy_locally_owned_data_from(run().water->pressure);
        pressure *= 1e-6;
        pressure.update_ghost_values();
        DataOut<3> data_out;
        data_out.attach_dof_handler(space.dof_handler);
        data_out.add_data_vector(pressure, "pressure_MPa");
        data_out.build_patches(space.mapping, space.fe.degree);
        const std::string file = pictures.next_name(state) + ".vtu";
        if (write_vtu(
              data_out, run().folder + "/" + file, state.time, {}, run().log))
          pictures.add(state.time, file);
      }

    private:
      void
      prepare() override
      {
        pictures.prepare(run());
      }

      void
      conclude(const State &, nlohmann::json &) override
      {}

      PictureSeries pictures{"water_pressure", "Output/water pressure"};
    };

    const Registry<Observer>::Add<WaterPressure> registered_water_pressure(
      "water pressure",
      "Hydrodynamic pressure in compressible water, in water_pressure.pvd.");
  } // namespace
} // namespace Voussoir
