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
      check(const ObservedModel &observed) const override
      {
        if (observed.water == nullptr)
          throw UserError("\"Observers\" in section \"Output\" names \"water "
                          "pressure\", but there is no water to look into; set "
                          "\"Model = compressible\" in section \"Reservoir\".");
        pictures.check(observed);
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        folder = observed.folder;
        water  = observed.water;
        log    = &observed.log;
        pictures.prepare(observed, start_time, restarted);
      }

      void
      observe(const State &state) override
      {
        if (!pictures.due(state))
          return;
        const AcousticSpace &space    = water->reservoir.space;
        Vector               pressure = space.create_ghosted_vector(); // [MPa]
        pressure.copy_locally_owned_data_from(water->pressure);
        pressure *= 1e-6;
        pressure.update_ghost_values();
        DataOut<3> data_out;
        data_out.attach_dof_handler(space.dof_handler);
        data_out.add_data_vector(pressure, "pressure_MPa");
        data_out.build_patches(space.mapping, space.fe.degree);
        const std::string file = pictures.next_name(state) + ".vtu";
        if (write_vtu(data_out, folder + "/" + file, state.time, {}, *log))
          pictures.add(state.time, file);
      }

      void
      finish(const State &, nlohmann::json &) override
      {}

    private:
      PictureSeries pictures{"water_pressure", "Output/water pressure"};

      std::string        folder;
      const WaterMotion *water = nullptr;
      Log               *log   = nullptr;
    };

    const Registry<Observer>::Add<WaterPressure>
      registered("water pressure",
                 "What the motion adds to the pressure in compressible water, "
                 "in water_pressure.pvd.");
  } // namespace
} // namespace Voussoir
