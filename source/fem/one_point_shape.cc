#include <voussoir/fem/one_point_shape.h>
#include <voussoir/fem/trilinear_modes.h>

namespace Voussoir
{
  using namespace dealii;
  using namespace TrilinearModes;

  template <typename Number>
  void
  OnePointShape<Number>::reinit(const Values &corners)
  {
    for (unsigned int d = 0; d < 3; ++d)
      {
        std::array<Number, 8> modes;
        to_modes(corners.data() + 8 * d, modes);
        for (unsigned int k = 0; k < 3; ++k)
          edges[k][d] = 0.125 * modes[linear[k]];
        for (unsigned int k = 0; k < 4; ++k)
          warps[k][d] = 0.125 * modes[hourglass[k]];
      }

    // Means of the cofactors of the Jacobian matrix times the derivatives of
    // the modes; those of the last one vanish.
    Number trace = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        b_linear[k] = cross_product_3d(edges[l], edges[m]) -
                      cross_product_3d(warps[l], warps[m]) * Number(1. / 3.);
        b_hourglass[k] = (cross_product_3d(edges[m], warps[l]) -
                          cross_product_3d(edges[l], warps[m])) *
                         Number(1. / 3.);
        trace += edges[k] * b_linear[k] + warps[k] * b_hourglass[k];
      }
    // a linear displacement has its gradient: three times the mean determinant;
    // an eighth of it, as `to_modes` gives eight times the parts
    const Number scale = 0.375 / trace;
    volume             = (8. / 3.) * trace;
    for (unsigned int k = 0; k < 3; ++k)
      {
        b_linear[k] *= scale;
        b_hourglass[k] *= scale;
      }

    std::array<Number, 3> length_square;
    for (unsigned int k = 0; k < 3; ++k)
      {
        length_square[k]         = edges[k].norm_square();
        inverse_length_square[k] = 1. / length_square[k];
      }
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        const Number       product = edges[l] * edges[m];
        const Number       factor =
          1. / (length_square[l] * length_square[m] - product * product);
        inverse_metric[k] = {factor * length_square[m],
                             factor * length_square[l],
                             -factor * product};
      }
  }


  template <typename Number>
  void
  OnePointShape<Number>::evaluate_values(Number *u)
  {
    for (unsigned int d = 0; d < 3; ++d)
      to_modes(u + 8 * d);
    mean_value = Number(0.125) * mode(u, 0);
    for (unsigned int k = 0; k < 3; ++k)
      value_gradient[k] = 0.125 * u[linear[k]];
  }


  template <typename Number>
  void
  OnePointShape<Number>::evaluate_gradients(Number *u)
  {
    for (unsigned int d = 0; d < 3; ++d)
      to_modes(u + 8 * d);

    Tensor<2, 3, Number> gradient;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int k = 0; k < 3; ++k)
        gradient[d] += u[8 * d + linear[k]] * b_linear[k] +
                       u[8 * d + hourglass[k]] * b_hourglass[k];
    mean_strain = symmetrize(gradient);

    std::array<Vector3, 4> q;
    for (unsigned int k = 0; k < 4; ++k)
      q[k] = 0.125 * mode(u, hourglass[k]) - gradient * warps[k];
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        strain.planes[k] = {edges[l] * q[m],
                            edges[m] * q[l],
                            0.5 * (edges[m] * q[m] + edges[l] * q[l])};
        strain.bars[k]   = edges[k] * q[3];
      }
  }


  template <typename Number>
  DEAL_II_ALWAYS_INLINE inline void
  OnePointShape<Number>::find_stress(Fields       &result,
                                     const Fields &of_strain,
                                     const double  young_modulus,
                                     const double  poisson_ratio) const
  {
    // squares of one unit coordinate and of two have the means 1/3 and 1/9
    const Number plate =
      young_modulus / (3. * (1. - poisson_ratio * poisson_ratio)) * volume;
    const Number bar = young_modulus / 9. * volume;
    for (unsigned int k = 0; k < 3; ++k)
      {
        // sigma = E/(1 - nu^2) ((1 - nu) A^-1 e A^-1 + nu (A^-1 : e) A^-1)
        // with the metric A of the plane
        const auto  &e = of_strain.planes[k], &a = inverse_metric[k];
        const Number m11   = a.ll * e.ll + a.lm * e.lm,
                     m12   = a.ll * e.lm + a.lm * e.mm,
                     m21   = a.lm * e.ll + a.mm * e.lm,
                     m22   = a.lm * e.lm + a.mm * e.mm;
        const Number shear = (1. - poisson_ratio) * plate,
                     trace = poisson_ratio * plate * (m11 + m22);
        result.planes[k]   = {shear * (m11 * a.ll + m12 * a.lm) + trace * a.ll,
                              shear * (m21 * a.lm + m22 * a.mm) + trace * a.mm,
                              shear * (m11 * a.lm + m12 * a.mm) + trace * a.lm};
        result.bars[k]     = bar * inverse_length_square[k] *
                         inverse_length_square[k] * of_strain.bars[k];
      }
  }


  template <typename Number>
  void
  OnePointShape<Number>::submit_stabilisation(const double young_modulus,
                                              const double poisson_ratio)
  {
    find_stress(stress, strain, young_modulus, poisson_ratio);
  }


  template <typename Number>
  typename OnePointShape<Number>::Fields
  OnePointShape<Number>::stabilising_stress(const Fields &of_strain,
                                            const double  young_modulus,
                                            const double  poisson_ratio) const
  {
    Fields result;
    find_stress(result, of_strain, young_modulus, poisson_ratio);
    return result;
  }


  template <typename Number>
  void
  OnePointShape<Number>::scale_stabilisation(const Number &factor)
  {
    stress.for_each_number([&](Number &number) { number *= factor; });
  }


  template <typename Number>
  void
  OnePointShape<Number>::add_stabilisation(const Number &factor,
                                           const Fields &of_strain,
                                           const double  young_modulus,
                                           const double  poisson_ratio)
  {
    stress.add(factor,
               stabilising_stress(of_strain, young_modulus, poisson_ratio));
  }


  template <typename Number>
  void
  OnePointShape<Number>::expand(const double expansion)
  {
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        const Number       factor = expansion * value_gradient[k];
        strain.planes[k]          = {factor * edges[l].norm_square(),
                                     factor * edges[m].norm_square(),
                                     factor * (edges[l] * edges[m])};
        strain.bars[k]            = 0.;
      }
  }


  template <typename Number>
  Number
  OnePointShape<Number>::work(const Fields &stress, const Fields &strain)
  {
    Number work = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const auto &s = stress.planes[k], &e = strain.planes[k];
        work += s.ll * e.ll + s.mm * e.mm + 2. * s.lm * e.lm +
                stress.bars[k] * strain.bars[k];
      }
    return work;
  }


  template <typename Number>
  void
  OnePointShape<Number>::integrate_gradients(Number *f)
  {
    // the stress that works on the strains of `evaluate`
    std::array<Vector3, 4> force;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        const auto        &s = stress.planes[k];
        force[m] += s.ll * edges[l] + s.lm * edges[m];
        force[l] += s.mm * edges[m] + s.lm * edges[l];
        force[3] += stress.bars[k] * edges[k];
      }
    Tensor<2, 3, Number> total = volume * mean_stress;
    for (unsigned int k = 0; k < 4; ++k)
      total -= outer_product(force[k], warps[k]);

    for (unsigned int d = 0; d < 3; ++d)
      {
        std::array<Number, 8> modes;
        modes[0] = 0.;
        for (unsigned int k = 0; k < 3; ++k)
          {
            modes[linear[k]] = total[d] * b_linear[k];
            modes[hourglass[k]] =
              total[d] * b_hourglass[k] + 0.125 * force[k][d];
          }
        modes[hourglass[3]] = 0.125 * force[3][d];
        to_corners(modes.data());
        for (unsigned int v = 0; v < 8; ++v)
          f[8 * d + v] = modes[v];
      }
  }

  template class OnePointShape<Lanes>;
  template class OnePointShape<Singles>;
} // namespace Voussoir
