#include "histories.h"

#include <voussoir/base/mpi.h>

namespace Voussoir
{
  using namespace dealii;

  std::vector<double>
  Histories::component(const unsigned int point, const unsigned int d) const
  {
    std::vector<double> values;
    for (const Tensor<1, 3> &u : displacement[point])
      values.push_back(u[d]);
    return values;
  }


  double
  Histories::largest() const
  {
    double result = 0.;
    for (const auto &history : displacement)
      for (const Tensor<1, 3> &u : history)
        for (unsigned int d = 0; d < 3; ++d)
          keep_largest(result, std::abs(u[d]));
    return result;
  }


  double
  relative_difference(Histories histories, const Histories &reference)
  {
    for (unsigned int p = 0; p < reference.displacement.size(); ++p)
      for (std::size_t i = 0; i < reference.times.size(); ++i)
        histories.displacement[p][i] -= reference.displacement[p][i];
    return histories.largest() / reference.largest();
  }


  Histories
  run_and_record(Simulation                         &simulation,
                 const std::vector<NamedPoint>      &points,
                 const std::function<void(State &)> &after_step)
  {
    const PointWeights  weights(simulation.model.solid.discretization,
                               points,
                               "the check");
    Histories           histories;
    std::vector<double> shares;
    while (simulation.run.state.time <
           simulation.model.parameters.time.end_time)
      {
        simulation.run.scheme.step(simulation.run.state);
        if (after_step)
          after_step(simulation.run.state);
        histories.times.push_back(simulation.run.state.time);
        for (const Tensor<1, 3> &u :
             weights.share(simulation.run.state.displacement))
          for (unsigned int d = 0; d < 3; ++d)
            shares.push_back(u[d]);
      }

    const std::vector<double> sums =
      sum_over_ranks(shares, simulation.model.grid.communicator());
    histories.displacement.resize(points.size());
    for (std::size_t i = 0; i < sums.size(); i += 3)
      histories.displacement[i / 3 % points.size()].push_back(
        Tensor<1, 3>({sums[i], sums[i + 1], sums[i + 2]}));
    return histories;
  }


  std::complex<double>
  fourier_sum(const std::vector<double> &times,
              const std::vector<double> &values,
              const double               frequency,
              const double               begin,
              const double               end)
  {
    std::complex<double> sum;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (begin <= times[i] && times[i] < end)
        sum +=
          values[i] * std::polar(1., -2. * numbers::PI * frequency * times[i]);
    return sum;
  }
} // namespace Voussoir
