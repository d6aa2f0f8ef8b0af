#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Free vibration of a laterally constrained column in its first axial mode,
     * at several frequencies: the decay and its period against the roots that
     * tests/data/damping_reference.py finds.
     */
    class ModalDamping : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Frequencies", frequencies, "Undamped [Hz].");
        prm.add_parameter("Ratios",
                          ratios,
                          "Damping ratios of the free decay [%].");
        prm.add_parameter("Decays", decays, "Their frequencies [Hz].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (unsigned int i = 0; i < frequencies.size(); ++i)
          {
            const double frequency = frequencies[i];
            // f = c_p / 4H of the column, fixed below; c_p = 2000 m/s
            const double height     = 2000. / (4. * frequency);
            const auto   parameters = make_case(file.with(
              {"Mesh/box/Upper corner=" + std::to_string(height / 24.) + ", " +
                 std::to_string(height / 24.) + ", " + std::to_string(height)}));
            const auto simulation = make_simulation(*parameters, communicator);
            State     &state      = simulation->run.state;
            const auto amplitude  = [&] {
              // mass-weighted projection on the mode
              double sum = 0.;
              for (unsigned int node = 0;
                   node <
                   simulation->model.solid.discretization.n_owned_nodes();
                   ++node)
                sum +=
                  simulation->model.solid.mass.mass.local_element(3 * node +
                                                                  2) *
                  state.displacement.local_element(3 * node + 2) *
                  mode(
                    simulation->model.solid.discretization.node_positions[node],
                    height);
              return Utilities::MPI::sum(sum, communicator);
            };
            for (unsigned int node = 0;
                 node < simulation->model.solid.discretization.n_owned_nodes();
                 ++node)
              state.velocity.local_element(3 * node + 2) = mode(
                simulation->model.solid.discretization.node_positions[node],
                height);

            // positive peaks, with the parabola through three samples
            std::vector<double> peaks, times;
            double              a = 0., b = 0.;
            while (peaks.size() < 7)
              {
                simulation->run.scheme.step(state);
                const double c = amplitude();
                if (b > a && b >= c && b > 0.)
                  {
                    const double shift = 0.5 * (a - c) / (a - 2. * b + c);
                    peaks.push_back(b - 0.25 * (a - c) * shift);
                    times.push_back((double(state.step) - 1. + shift) *
                                    simulation->run.time_step.length);
                  }
                a = b;
                b = c;
              }
            // the first peak is still influenced by the start of the filters
            const double decrement =
              std::log(peaks[1] / peaks[6]) / (5. * 2. * numbers::PI);
            const double period = (times[6] - times[1]) / 5.;
            const double ratio =
              decrement / std::sqrt(1. + decrement * decrement);
            std::ostringstream at;
            at << " at " << frequency << " Hz";
            verdicts.near("damping ratio" + at.str() + " [%]",
                          100. * ratio,
                          ratios.at(i),
                          0.01);
            verdicts.near("frequency of the decay" + at.str(),
                          1. / period,
                          decays.at(i),
                          0.001,
                          "Hz");
          }
      }

    private:
      static double
      mode(const Point<3> &p, const double height)
      {
        return std::sin(0.5 * numbers::PI * p[2] / height);
      }

      std::vector<double> frequencies, ratios, decays;
    };

    // Reference: other program
    const Registry<Check>::Add<ModalDamping>
      registered("modal damping", "Decay of single modes.");
  } // namespace
} // namespace Voussoir
