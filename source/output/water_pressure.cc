#include <voussoir/base/error.h>
#include <voussoir/loads/water_motion.h>
#include <voussoir/output/picture_series.h>

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
        pictures.prepare(observed, start_time, restarted);
      }

      void
      observe(const State &state) override
      {
        if (!pictures.due(state))
          return;
        const std::string file = pictures.next_name(state) + ".vtu";
        water->reservoir.write(water->pressure,
                               folder + "/" + file,
                               state.time);
        pictures.add(state.time, file);
      }

      void
      finish(const State &, nlohmann::json &) override
      {}

    private:
      PictureSeries pictures{"water_pressure", "Output/water pressure"};

      std::string        folder;
      const WaterMotion *water = nullptr;
    };

    const Registry<Observer>::Add<WaterPressure>
      registered("water pressure",
                 "What the motion adds to the pressure in compressible water, "
                 "in water_pressure.pvd.");
  } // namespace
} // namespace Voussoir
