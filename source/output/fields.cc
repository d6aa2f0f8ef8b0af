#include <voussoir/base/parameter_file.h>
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
                          "What to write: displacement [m], velocity [m/s], "
                          "principal stress [MPa].",
                          Patterns::MultipleSelection(
                            "displacement|velocity|principal stress"));
        pictures.declare_parameters(prm);
      }

      void
      check(const ObservedModel &observed) const override
      {
        pictures.check(observed);
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        model = std::make_unique<ObservedModel>(observed);
        pictures.prepare(observed, start_time, restarted);
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
        if (wants("velocity"))
          nodal.push_back({&state.velocity, {"velocity"}});
        pictures.add(state.time,
                     write_fields(*model,
                                  nodal,
                                  wants("principal stress") ?
                                    &state.displacement :
                                    nullptr,
                                  pictures.next_name(state),
                                  state.time));
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        summary["pictures"] = pictures.size();
      }

    private:
      std::string   quantities = "displacement, principal stress";
      PictureSeries pictures{"fields", "Output/fields"};

      std::unique_ptr<ObservedModel> model;
    };

    const Registry<Observer>::Add<Fields> registered(
      "fields",
      "The whole model at chosen times, in fields.pvd for ParaView.");
  } // namespace
} // namespace Voussoir
