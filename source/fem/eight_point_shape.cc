#include <voussoir/fem/eight_point_shape.h>
#include <voussoir/fem/trilinear_modes.h>

namespace Voussoir
{
  using namespace TrilinearModes;

  template <typename Number>
  void
  EightPointShape<Number>::reinit(const Values &corners)
  {
    find_derivatives(corners.data(), edges);
    point = 8;
  }


  template <typename Number>
  void
  EightPointShape<Number>::evaluate_gradients(const Number *values)
  {
    find_derivatives(values, displacements);
  }


  template <typename Number>
  void
  EightPointShape<Number>::evaluate_values(Number *values)
  {
    for (unsigned int d = 0; d < 3; ++d)
      to_modes(values + 8 * d);
    for (unsigned int q = 0; q < 8; ++q)
      {
        values_at_points[q] = Vector3();
        for (unsigned int i = 0; i < 8; ++i)
          {
            double product = 0.125; // of mode i at point q
            for (unsigned int k = 0; k < 3; ++k)
              if (i >> k & 1)
                product *= q >> k & 1 ? coordinate : -coordinate;
            values_at_points[q] += Number(product) * mode(values, i);
          }
      }
  }


  template <typename Number>
  void
  EightPointShape<Number>::find_derivatives(const Number *values,
                                            Derivatives  &derivatives) const
  {
    for (unsigned int d = 0; d < 3; ++d)
      {
        std::array<Number, 8> u;
        to_modes(values + 8 * d, u);
        for (unsigned int k = 0; k < 3; ++k)
          {
            // u_k + v_m xi_l + v_l xi_m + v_3 xi_l xi_m with l < m
            const unsigned int l = k == 0 ? 1 : 0, m = k == 2 ? 1 : 2,
                               along = 1 << k;
            const Number constant    = 0.125 * u[along],
                         first       = 0.125 * coordinate * u[along | 1 << l],
                         second      = 0.125 * coordinate * u[along | 1 << m],
                         both        = 0.125 * coordinate * coordinate * u[7];
            const Number low = constant - second, high = constant + second,
                         slope_low = first - both, slope_high = first + both;
            auto &of_pairs = derivatives[k];
            of_pairs[0][d] = low - slope_low;
            of_pairs[1][d] = low + slope_low;
            of_pairs[2][d] = high - slope_high;
            of_pairs[3][d] = high + slope_high;
          }
      }
  }


  template <typename Number>
  void
  EightPointShape<Number>::integrate_gradients(Number *forces_of_nodes)
  {
    for (unsigned int d = 0; d < 3; ++d)
      {
        std::array<Number, 8> f;
        f.fill(0.);
        // the transpose of `find_derivatives`
        for (unsigned int k = 0; k < 3; ++k)
          {
            const unsigned int l = k == 0 ? 1 : 0, m = k == 2 ? 1 : 2,
                               along = 1 << k;
            const auto  &g           = forces[k];
            const Number low = g[0][d] + g[1][d], high = g[2][d] + g[3][d],
                         slope_low  = g[1][d] - g[0][d],
                         slope_high = g[3][d] - g[2][d];
            f[along] += 0.125 * (low + high);
            f[along | 1 << l] += 0.125 * coordinate * (slope_low + slope_high);
            f[along | 1 << m] += 0.125 * coordinate * (high - low);
            f[7] += 0.125 * coordinate * coordinate * (slope_high - slope_low);
          }
        to_corners(f.data());
        for (unsigned int v = 0; v < 8; ++v)
          forces_of_nodes[8 * d + v] = f[v];
      }
  }


  template class EightPointShape<Lanes>;
  template class EightPointShape<Singles>;
} // namespace Voussoir
