#ifndef voussoir_tests_rod_and_column_h
#define voussoir_tests_rod_and_column_h

#include <voussoir/materials/material.h>

#include <cmath>
#include <vector>

namespace Voussoir
{
  /**
   * A rod with a column of water on its free end, open on top: with
   * omega = k c_r,
   *   u = sin(k z),  p = P sin(omega (h - y)/c), y from the wet end upwards,
   *   E k cos(k L) = rho c omega tan(omega h/c) sin(k L) .
   * For incompressible water c is infinite.
   */
  struct RodAndColumn
  {
    ElasticConstants rod;
    double           length, depth, density, c;

    /** Zero at natural frequencies: difference of both sides times cos(omega
     *  h/c). */
    double
    mismatch(const double omega) const
    {
      const double in_rod   = omega * length / rod.p_wave_speed(),
                   in_water = omega * depth / c;
      return density * c * std::sin(in_water) * std::sin(in_rod) -
             rod.density * rod.p_wave_speed() * std::cos(in_rod) *
               std::cos(in_water);
    }

    /** The lowest natural frequencies [rad/s]. */
    std::vector<double>
    frequencies(const unsigned int number) const
    {
      std::vector<double> result;
      const double        step = 0.01 * rod.p_wave_speed() / length;
      for (double omega = step; result.size() < number; omega += step)
        if (mismatch(omega) * mismatch(omega + step) < 0.)
          {
            double lower = omega, upper = omega + step;
            for (unsigned int i = 0; i < 60; ++i)
              {
                const double middle = 0.5 * (lower + upper);
                (mismatch(middle) * mismatch(upper) > 0. ? upper : lower) =
                  middle;
              }
            result.push_back(lower);
          }
      return result;
    }

    /** (r^T M phi)^2 / phi^T M phi for r = 1 [kg/m2]: the water's part of
     *  M phi is its pressure over omega^2, and phi^T M phi is the energy of
     *  rod and water over omega^2. */
    double
    effective_mass(const double omega) const
    {
      const double k = omega / rod.p_wave_speed(), end = std::sin(k * length),
                   in_water = omega * depth / c;
      const double momentum = rod.density * (1. - std::cos(k * length)) / k +
                              density * c * std::tan(in_water) * end / omega;
      const double of_rod =
        rod.density * std::pow(rod.p_wave_speed() * k, 2) *
        (0.5 * length + std::sin(2. * k * length) / (4. * k));
      const double of_water =
        density * std::pow(omega * end / std::cos(in_water), 2) *
        (0.5 * depth - c * std::sin(2. * in_water) / (4. * omega));
      return momentum * momentum * omega * omega / (of_rod + of_water);
    }
  };
} // namespace Voussoir

#endif
