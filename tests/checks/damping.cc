#include <complex>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Free vibration of a laterally held column in its first axial mode, at
     * several frequencies: the decay gives the damping ratio, the period the
     * modulus.
     */
    class ModalDamping : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Frequencies", frequencies, "[Hz]");
        prm.add_parameter("Allowed", allowed, "Deviation of the ratio.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double frequency : frequencies)
          {
            // f = c_p / 4H of the column, fixed below; c_p = 2000 m/s
            const double height     = 2000. / (4. * frequency);
            const auto   parameters = make_case(file.with(
              {"Mesh/box/Upper corner=" + std::to_string(height / 24.) + ", " +
                 std::to_string(height / 24.) + ", " + std::to_string(height)}));
            const auto simulation  = make_simulation(*parameters, communicator);
            const Damping &damping = simulation->run.damping;
            State         &state   = simulation->run.state;
            const auto     amplitude = [&] {
              // mass-weighted projection on the mode
              double sum = 0.;
              for (unsigned int node = 0;
                   node < simulation->model.discretization.n_owned_nodes();
                   ++node)
                sum +=
                  simulation->model.mass.mass.local_element(3 * node + 2) *
                  state.displacement.local_element(3 * node + 2) *
                  mode(simulation->model.discretization.node_positions[node],
                       height);
              return Utilities::MPI::sum(sum, communicator);
            };
            for (unsigned int node = 0;
                 node < simulation->model.discretization.n_owned_nodes();
                 ++node)
              state.velocity.local_element(3 * node + 2) =
                mode(simulation->model.discretization.node_positions[node],
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
            // the first peak still feels the start of the memory
            const double decrement =
              std::log(peaks[1] / peaks[6]) / (5. * 2. * numbers::PI);
            const double period = (times[6] - times[1]) / 5.;
            const double ratio =
              decrement / std::sqrt(1. + decrement * decrement);
            std::ostringstream name;
            name << "damping ratio at " << frequency << " Hz [%]";
            verdicts.near(name.str(),
                          100. * ratio,
                          100. *
                            half_loss_factor(
                              damping,
                              2. * numbers::PI * frequency,
                              simulation->model.materials[0]->damping_factor()),
                          allowed);
            std::ostringstream hertz;
            hertz << "frequency against the storage modulus at " << frequency
                  << " Hz";
            const double factor =
              simulation->model.materials[0]->damping_factor();
            verdicts.near(hertz.str(),
                          1. / period,
                          frequency *
                            std::sqrt(damping.modulus_ratio(frequency, factor) *
                                      damping.stiffness_scale(factor)),
                          0.01,
                          "Hz");
          }
      }

    private:
      /** Half the loss over the storage modulus of
       *  1 + i w beta + s sum D_i i w tau_i / (1 + i w tau_i), and alpha/2w. */
      static double
      half_loss_factor(const Damping &damping,
                       const double   omega,
                       const double   factor)
      {
        std::complex<double> modulus(1., omega * damping.stiffness_coefficient);
        for (unsigned int i = 0; i < damping.coefficients.size(); ++i)
          {
            const std::complex<double> rate(0.,
                                            omega *
                                              damping.relaxation_times[i]);
            modulus += factor * damping.coefficients[i] * rate / (1. + rate);
          }
        return 0.5 * modulus.imag() / modulus.real() +
               0.5 * damping.mass_coefficient / omega;
      }

      static double
      mode(const Point<3> &p, const double height)
      {
        return std::sin(0.5 * numbers::PI * p[2] / height);
      }

      std::vector<double> frequencies{1., 3., 10., 20.};
      double              allowed = 0.05;
    };

    const Registry<Check>::Add<ModalDamping>
      registered("modal damping", "Decay of single modes.");
  } // namespace
} // namespace Voussoir
