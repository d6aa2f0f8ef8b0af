#include <voussoir/base/mpi.h>
#include <voussoir/loads/end_motion.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Complex = std::complex<double>;

    // Modes whose phase advances by more than this in a step [rad] are not
    // resolved.
    constexpr double largest_angle = 0.5;


    /** w and z of a sum of w exp(z t), with their conjugates. */
    struct Term
    {
      Complex weight, rate;
    };


    /**
     * J_1(t) / t. This function is 1/(i pi) times the integral of sqrt(1 + z^2)
     * exp(z t) from -i to i; along the left unit semicircle z = i tanh(u + i
     * pi/4) the exponentials decay, and the trapezoidal rule in u converges
     * exponentially. The sum is accurate to 2e-4, and to 2e-3 within 1e-5 of
     * the frequency 1.
     */
    std::vector<Term>
    kernel()
    {
      constexpr double  step = 0.4, last = 6.;
      std::vector<Term> terms;
      for (unsigned int k = 0; k * step < last + 0.5 * step; ++k)
        {
          const Complex u(k * step, 0.25 * numbers::PI);
          const Complex weight =
            step / numbers::PI / (std::cosh(u) * std::cosh(u) * std::cosh(u));
          // with the conjugate; the first is its own conjugate
          terms.push_back(
            {k == 0 ? 0.5 * weight : weight, Complex(0., 1.) * std::tanh(u)});
        }
      return terms;
    }


    // The error supplies at most the energy of a dashpot of minus this share of
    // 1/(rho c).
    constexpr double error_of_kernel = 2e-4;
  } // namespace


  EndMotion::EndMotion(const ReservoirEnd &end, const double time_step)
    : end(end)
    , added(end.nodes.size())
    , time_step(time_step)
    , n_modes(std::lower_bound(end.modes.frequencies.begin(),
                               end.modes.frequencies.end(),
                               largest_angle / time_step) -
              end.modes.frequencies.begin())
    , pressure(end.areas.size())
    , impulse(end.areas.size())
    , mean(end.areas.size())
    , keep(end.areas.size())
    , push(end.areas.size())
    , modal_impulse(n_modes)
    , response(n_modes)
    , sums(end.areas.size() + n_modes)
  {
    for (unsigned int i = 0; i < pressure.size(); ++i)
      if (!end.in_surface[i])
        {
          const double gain = time_step * end.density *
                              Utilities::fixed_power<2>(end.speed) /
                              end.volumes[i];
          const double damping = 0.5 * gain * end.dashpots[i];
          push[i]              = gain / (1. + damping);
          keep[i]              = (1. - damping) / (1. + damping);
        }

    const std::vector<Term> terms = kernel();
    for (unsigned int j = 0; j < n_modes; ++j)
      {
        const double omega = end.modes.frequencies[j],
                     decay = end.modes.decay[j],
                     w     = std::sqrt(omega * omega - decay * decay);
        exponentials.emplace_back();
        for (const Term &term : terms)
          {
            // d(memory)/dt = rate memory + impulse, by the trapezoidal rule
            const Complex half = 0.5 * time_step * (w * term.rate - decay);
            exponentials.back().push_back({(1. + half) / (1. - half),
                                           0.5 * time_step / (1. - half),
                                           2. * w * w * term.weight});
          }
        // the impulse is integrated by leap-frog, memory by the trapezoidal
        // rule: without the second term this difference could supply energy,
        // too
        viscosity.push_back(error_of_kernel +
                            Utilities::fixed_power<2>(0.5 * omega * time_step));
        memory.emplace_back(terms.size());
      }
  }


  void
  EndMotion::advance_modes(const double *size)
  {
    for (unsigned int j = 0; j < n_modes; ++j)
      {
        const double last = modal_impulse[j];
        modal_impulse[j] += time_step * size[j];
        const double both = last + modal_impulse[j];
        double       sum =
          viscosity[j] * size[j] + end.modes.decay[j] * modal_impulse[j];
        for (unsigned int k = 0; k < memory[j].size(); ++k)
          {
            const Exponential &e = exponentials[j][k];
            Complex           &m = memory[j][k];
            m                    = e.keep * m + e.gain * both;
            sum += (e.weight * m).real();
          }
        response[j] = sum / (end.density * end.speed);
      }
  }


  void
  EndMotion::advance_free_field(const double *flux)
  {
    for (unsigned int i = 0; i < pressure.size(); ++i)
      impulse[i] += time_step * pressure[i];
    for (unsigned int i = 0; i < pressure.size(); ++i)
      if (!end.in_surface[i])
        {
          const double next =
            keep[i] * pressure[i] -
            push[i] * (end.volumes[i] / (end.density * end.areas[i]) *
                         end.apply_stiffness(i, impulse) +
                       flux[i]);
          mean[i]     = 0.5 * (pressure[i] + next);
          pressure[i] = next;
        }
  }


  void
  EndMotion::advance(const Vector &water, Vector &flux)
  {
    const unsigned int n       = pressure.size(),
                       n_found = end.modes.frequencies.size();
    const auto &shapes         = end.modes.shapes;
    std::fill(sums.begin(), sums.end(), 0.);
    for (const ReservoirEnd::Node &node : end.nodes)
      {
        sums[node.number] = flux.local_element(node.water);
        const double scattered =
          end.areas[node.number] *
          (water.local_element(node.water) - pressure[node.number]);
        for (unsigned int j = 0; j < n_modes; ++j)
          sums[n + j] += scattered * shapes[node.number * n_found + j];
      }
    Utilities::MPI::sum(sums, end.communicator, sums);
    advance_modes(sums.data() + n);
    advance_free_field(sums.data());

    for (unsigned int i = 0; i < end.nodes.size(); ++i)
      {
        const auto &[unknown, number] = end.nodes[i];
        double sum = -mean[number] / (end.density * end.speed);
        for (unsigned int j = 0; j < n_modes; ++j)
          sum += shapes[number * n_found + j] * response[j];
        added[i] = end.areas[number] * sum;
        flux.local_element(unknown) += added[i];
      }
  }


  nlohmann::json
  EndMotion::save() const
  {
    nlohmann::json modes;
    for (unsigned int j = 0; j < n_modes; ++j)
      {
        std::vector<double> parts;
        for (const Complex &m : memory[j])
          parts.insert(parts.end(), {m.real(), m.imag()});
        modes.push_back({{"impulse", modal_impulse[j]}, {"memory", parts}});
      }
    return {{"pressure", pressure}, {"impulse", impulse}, {"modes", modes}};
  }


  void
  EndMotion::load(const nlohmann::json &saved)
  {
    pressure = saved.at("pressure").get<std::vector<double>>();
    impulse  = saved.at("impulse").get<std::vector<double>>();
    for (unsigned int j = 0; j < n_modes; ++j)
      {
        const nlohmann::json &mode = saved.at("modes").at(j);
        modal_impulse[j]           = mode.at("impulse");
        const auto parts = mode.at("memory").get<std::vector<double>>();
        for (unsigned int k = 0; k < memory[j].size(); ++k)
          memory[j][k] = {parts.at(2 * k), parts.at(2 * k + 1)};
      }
  }
} // namespace Voussoir
