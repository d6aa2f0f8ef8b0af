#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block that is released in its first natural mode: its damped vibration
     * has the frequency of the table of modes, for any damping ratio, band and
     * natural frequency.
     */
    class TransientFrequency : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Settings",
                          settings,
                          "Separated by |, each \"Section/Entry=value\", or "
                          "more than one, separated by &.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string &setting : split_list(settings, '|'))
          {
            const auto parameters =
              make_case(file.with(split_list(setting, '&')));
            const auto simulation = make_simulation(*parameters, communicator);
            const double mode     = simulation->modes.list.at(0).frequency;
            verdicts.near(setting + ": frequency over time",
                          frequency(*simulation),
                          mode,
                          0.003,
                          "Hz");
          }
      }

    private:
      /** Of the projection on the mode, by its zeros from the second to the
       *  eighth. */
      static double
      frequency(Simulation &simulation)
      {
        State        &state = simulation.run.state;
        const Vector &shape = simulation.modes.list[0].shape;
        Vector        momentum(shape);
        momentum.scale(simulation.model.solid.mass.mass);
        state.velocity = shape;
        std::vector<double> zeros;
        double              last = 0.;
        const double        dt   = simulation.run.time_step.length;
        while (zeros.size() < 8 && state.step < 1000000)
          {
            simulation.run.scheme.step(state);
            const double now = state.displacement * momentum;
            if (state.step > 1 && now * last <= 0.)
              zeros.push_back(state.time - dt * now / (now - last));
            last = now;
          }
        return 0.5 * 6. / (zeros.at(7) - zeros.at(1));
      }

      std::string settings;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<TransientFrequency>
      registered("transient frequency",
                 "A damped block over time against its mode.");
  } // namespace
} // namespace Voussoir
