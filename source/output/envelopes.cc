#include <voussoir/output/field_writer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Largest motion of each node over the run. */
    class Envelopes : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Interval",
                          interval,
                          "Time between two looks at the motion [s].",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &) const override
      {}

      void
      prepare(const ObservedModel &observed, const double, const bool) override
      {
        model    = std::make_unique<ObservedModel>(observed);
        schedule = Schedule(interval, model->time_step);
        // the three components of a node hold its three largest amounts
        largest  = model->discretization.create_vector();
        previous = largest;
      }

      void
      observe(const State &state) override
      {
        if (state.step > 0 && schedule.due(state.step))
          update(state);
        // the acceleration needs the velocity of two steps in a row
        if (schedule.due(state.step + 1))
          previous = state.velocity;
      }

      void
      finish(const State &state, nlohmann::json &) override
      {
        write_fields(*model,
                     {{&largest,
                       {"largest_displacement_m",
                        "largest_velocity_m_per_s",
                        "largest_acceleration_m_per_s2"}}},
                     nullptr,
                     "envelopes",
                     state.time);
      }

      std::map<std::string, Vector *>
      checkpoint_vectors() override
      {
        return {{"envelope", &largest}, {"envelope velocity", &previous}};
      }

    private:
      void
      update(const State &state)
      {
        const auto norm = [](const double *x) {
          return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        };
        for (unsigned int i = 0; i < largest.locally_owned_size(); i += 3)
          {
            const double *v = state.velocity.begin() + i;
            const double *p = previous.begin() + i;
            const double  a[3]{(v[0] - p[0]) / model->time_step,
                               (v[1] - p[1]) / model->time_step,
                               (v[2] - p[2]) / model->time_step};
            double       *m = largest.begin() + i;
            m[0] = std::max(m[0], norm(state.displacement.begin() + i));
            m[1] = std::max(m[1], norm(v));
            m[2] = std::max(m[2], norm(a));
          }
      }

      double interval = 0.01;

      std::unique_ptr<ObservedModel> model;
      Schedule                       schedule;
      Vector                         largest, previous;
    };

    const Registry<Observer>::Add<Envelopes>
      registered("envelopes",
                 "Largest displacement, velocity and acceleration of each node "
                 "over the run, in envelopes.vtu.");
  } // namespace
} // namespace Voussoir
