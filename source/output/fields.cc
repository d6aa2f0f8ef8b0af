#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/output/field_writer.h>

#include <deal.II/base/data_out_base.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

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
        prm.add_parameter("Interval",
                          interval,
                          "Time between two pictures [s]; 0 for none but those "
                          "under \"Times\".",
                          Patterns::Double(0.));
        prm.add_parameter("Times",
                          times,
                          "Further times of pictures [s].",
                          Patterns::List(Patterns::Double(0.)));
      }

      void
      check(const ObservedModel &model_to_check) const override
      {
        for (const double time : times)
          if (time > model_to_check.end_time)
            {
              std::ostringstream text;
              text << "\"Times\" in section \"Output/fields\" names " << time
                   << " s, which lies after the \"End time\" of section "
                      "\"Time\", "
                   << model_to_check.end_time
                   << " s; leave it out or compute longer.";
              throw UserError(text.str());
            }
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        check(observed);
        model = std::make_unique<ObservedModel>(observed);
        if (restarted)
          {
            // continue the list of pictures
            std::ifstream list(model->folder + "/fields.txt");
            double        time;
            std::string   file;
            while (list >> time >> file)
              if (time < start_time - 0.5 * model->time_step)
                pictures.emplace_back(time, file);
          }
      }

      void
      observe(const State &state) override
      {
        bool due =
          interval > 0. && Schedule(interval, model->time_step).due(state.step);
        for (const double time : times)
          due = due || std::abs(state.time - time) <= 0.5 * model->time_step;
        if (!due)
          return;
        std::ostringstream name;
        name << "fields/fields-" << std::setw(8) << std::setfill('0')
             << state.step;

        const auto list  = split_list(quantities);
        const auto wants = [&](const std::string &quantity) {
          return std::find(list.begin(), list.end(), quantity) != list.end();
        };
        std::vector<NodalField> nodal;
        if (wants("displacement"))
          nodal.push_back({&state.displacement, {"displacement"}});
        if (wants("velocity"))
          nodal.push_back({&state.velocity, {"velocity"}});
        const bool first = Utilities::MPI::this_mpi_process(
                             model->discretization.grid.communicator()) == 0;
        if (first)
          std::filesystem::create_directories(model->folder + "/fields");
        MPI_Barrier(model->discretization.grid.communicator());
        pictures.emplace_back(state.time,
                              write_fields(*model,
                                           nodal,
                                           wants("principal stress") ?
                                             &state.displacement :
                                             nullptr,
                                           name.str(),
                                           state.time));
        if (first)
          {
            std::ofstream pvd(model->folder + "/fields.pvd");
            DataOutBase::write_pvd_record(pvd, pictures);
            std::ofstream text(model->folder + "/fields.txt");
            text << std::setprecision(17);
            for (const auto &[time, file] : pictures)
              text << time << ' ' << file << '\n';
          }
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        summary["pictures"] = pictures.size();
      }

    private:
      std::string         quantities = "displacement, principal stress";
      double              interval   = 0.;
      std::vector<double> times;

      std::unique_ptr<ObservedModel>              model;
      std::vector<std::pair<double, std::string>> pictures;
    };

    const Registry<Observer>::Add<Fields> registered(
      "fields",
      "The whole model at chosen times, in fields.pvd for ParaView.");
  } // namespace
} // namespace Voussoir
