#ifndef voussoir_tests_histories_h
#define voussoir_tests_histories_h

#include <voussoir/driver/simulation.h>
#include <voussoir/fem/point_weights.h>

#include <complex>

namespace Voussoir
{
  /** Displacements at points from the start to the end of a run. */
  struct Histories
  {
    std::vector<double> times; // [s]

    /** By point and time [m]; the same on all ranks. */
    std::vector<std::vector<dealii::Tensor<1, 3>>> displacement;

    /** One component at a point. */
    std::vector<double>
    component(const unsigned int point, const unsigned int d) const;

    /** Largest of all components [m]. */
    double
    largest() const;
  };

  /** Largest difference of a component over the largest of the reference. */
  double
  relative_difference(Histories histories, const Histories &reference);

  /**
   * Runs a simulation to its end time; @p after_step may read or change the
   * state after each step.
   */
  Histories
  run_and_record(Simulation                         &simulation,
                 const std::vector<NamedPoint>      &points,
                 const std::function<void(State &)> &after_step = {});

  /** Sum of values at times from begin to end, times exp(-2 pi i f t). */
  std::complex<double>
  fourier_sum(const std::vector<double> &times,
              const std::vector<double> &values,
              const double               frequency,
              const double               begin,
              const double               end);
} // namespace Voussoir

#endif
