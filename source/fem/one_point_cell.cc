#include <voussoir/fem/one_point_cell.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Places of u_k and v_k among the modes, which are in the order of the
    // products of unit coordinates whose factors are the bits of the index.
    constexpr unsigned int linear[3]    = {1, 2, 4};
    constexpr unsigned int hourglass[4] = {6, 5, 3, 7};

    // Eight times the parts u_0, u_k, v_k of a function from its corner values.
    void
    to_modes(Lanes *values)
    {
      for (const unsigned int bit : {1, 2, 4})
        for (unsigned int v = 0; v < 8; ++v)
          if ((v & bit) == 0)
            {
              const Lanes low = values[v], high = values[v | bit];
              values[v]       = low + high;
              values[v | bit] = high - low;
            }
    }

    // The transpose.
    void
    to_corners(Lanes *values)
    {
      for (const unsigned int bit : {1, 2, 4})
        for (unsigned int v = 0; v < 8; ++v)
          if ((v & bit) == 0)
            {
              const Lanes even = values[v], odd = values[v | bit];
              values[v]       = even - odd;
              values[v | bit] = even + odd;
            }
    }

    Tensor<1, 3, Lanes>
    mode(const Lanes *values, const unsigned int index)
    {
      Tensor<1, 3, Lanes> result;
      for (unsigned int d = 0; d < 3; ++d)
        result[d] = values[8 * d + index];
      return result;
    }
  } // namespace


  void
  OnePointCell::find_nodes(const unsigned int batch)
  {
    using namespace internal::MatrixFreeFunctions;
    first_entries = nullptr;
    if (dof_info.index_storage_variants[DoFInfo::dof_access_cell][batch] !=
        DoFInfo::IndexStorageVariants::interleaved)
      return;
    const auto &masks = dof_info.hanging_node_constraint_masks;
    if (!masks.empty())
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (masks[batch * Lanes::size() + lane] !=
            unconstrained_compressed_constraint_kind)
          return;
    // the entries of the first component; those of the others follow them, of
    // ghost nodes too
    const unsigned int *entries =
      dof_info.dof_indices_interleaved.data() +
      dof_info.row_starts[3 * batch * Lanes::size()].first;
    // the next batch is prefetched meanwhile
    for (unsigned int i = 0; i < 8 * Lanes::size(); i += 16)
      __builtin_prefetch(entries + 24 * Lanes::size() + i);
    // four entries are read, one more than needed
    unsigned int last = 0;
    for (unsigned int i = 0; i < 8 * Lanes::size(); ++i)
      last = std::max(last, entries[i]);
    if (last + 4 <= local_size)
      first_entries = entries;
  }


  void
  OnePointCell::read_dof_values(const Vector &vector)
  {
    if (first_entries == nullptr)
      {
        nodes.read_dof_values(vector);
        return;
      }
    Lanes *values = nodes.begin_dof_values();
    for (unsigned int v = 0; v < 8; ++v)
      {
        std::array<Lanes, 4> entries;
        vectorized_load_and_transpose(4,
                                      vector.begin(),
                                      first_entries + v * Lanes::size(),
                                      entries.data());
        for (unsigned int d = 0; d < 3; ++d)
          values[8 * d + v] = entries[d];
      }
  }


  void
  OnePointCell::distribute_local_to_global(Vector &vector)
  {
    if (first_entries == nullptr)
      {
        nodes.distribute_local_to_global(vector);
        return;
      }
    std::array<unsigned int, Lanes::size()> places;
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      places[lane] = 4 * lane;
    const Lanes *values = nodes.begin_dof_values();
    for (unsigned int v = 0; v < 8; ++v)
      {
        const std::array<Lanes, 4> entries{
          {values[v], values[8 + v], values[16 + v], Lanes(0.)}};
        std::array<double, 4 * Lanes::size()> by_lane;
        vectorized_transpose_and_store(
          false, 4, entries.data(), places.data(), by_lane.data());
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            double *node =
              vector.begin() + first_entries[v * Lanes::size() + lane];
            for (unsigned int d = 0; d < 3; ++d)
              node[d] += by_lane[4 * lane + d];
          }
      }
  }


  void
  OnePointCell::reinit(const unsigned int batch)
  {
    nodes.reinit(batch);
    find_nodes(batch);
    std::array<Lanes, 24> x;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const auto &corner = corners[batch][v];
        for (unsigned int d = 0; d < 3; ++d)
          x[8 * d + v] = 0.125 * corner[d];
      }
    for (unsigned int d = 0; d < 3; ++d)
      to_modes(x.data() + 8 * d);
    for (unsigned int k = 0; k < 3; ++k)
      edges[k] = mode(x.data(), linear[k]);
    for (unsigned int k = 0; k < 4; ++k)
      warps[k] = mode(x.data(), hourglass[k]);

    // Means of the cofactors of the Jacobian matrix times the derivatives of
    // the modes; those of the last one vanish.
    Lanes trace = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        b_linear[k] = cross_product_3d(edges[l], edges[m]) -
                      cross_product_3d(warps[l], warps[m]) * Lanes(1. / 3.);
        b_hourglass[k] = (cross_product_3d(edges[m], warps[l]) -
                          cross_product_3d(edges[l], warps[m])) *
                         Lanes(1. / 3.);
        trace += edges[k] * b_linear[k] + warps[k] * b_hourglass[k];
      }
    // a linear displacement has its gradient: three times the mean determinant
    const Lanes scale = 3. / trace;
    volume            = (8. / 3.) * trace;
    for (unsigned int k = 0; k < 3; ++k)
      {
        b_linear[k] *= scale;
        b_hourglass[k] *= scale;
      }

    std::array<Lanes, 3> length_square;
    for (unsigned int k = 0; k < 3; ++k)
      {
        length_square[k]         = edges[k].norm_square();
        inverse_length_square[k] = 1. / length_square[k];
      }
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        const Lanes        product = edges[l] * edges[m];
        const Lanes        factor =
          1. / (length_square[l] * length_square[m] - product * product);
        inverse_metric[k] = {factor * length_square[m],
                             factor * length_square[l],
                             -factor * product};
      }
  }


  void
  OnePointCell::evaluate(const EvaluationFlags::EvaluationFlags flags)
  {
    Lanes *u = nodes.begin_dof_values();
    for (unsigned int d = 0; d < 3; ++d)
      to_modes(u + 8 * d);

    if (flags & EvaluationFlags::values)
      {
        mean_value = 0.125 * mode(u, 0);
        for (unsigned int k = 0; k < 3; ++k)
          value_gradient[k] = 0.125 * u[linear[k]];
        return;
      }

    Tensor<2, 3, Lanes> gradient;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int k = 0; k < 3; ++k)
        gradient[d] += 0.125 * (u[8 * d + linear[k]] * b_linear[k] +
                                u[8 * d + hourglass[k]] * b_hourglass[k]);
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


  void
  OnePointCell::submit_stabilisation(const double young_modulus,
                                     const double poisson_ratio)
  {
    // squares of one unit coordinate and of two have the means 1/3 and 1/9
    const Lanes plate =
      young_modulus / (3. * (1. - poisson_ratio * poisson_ratio)) * volume;
    const Lanes bar = young_modulus / 9. * volume;
    for (unsigned int k = 0; k < 3; ++k)
      {
        // sigma = E/(1 - nu^2) ((1 - nu) A^-1 e A^-1 + nu (A^-1 : e) A^-1)
        // with the metric A of the plane
        const auto &e = strain.planes[k], &a = inverse_metric[k];
        const Lanes m11   = a.ll * e.ll + a.lm * e.lm,
                    m12   = a.ll * e.lm + a.lm * e.mm,
                    m21   = a.lm * e.ll + a.mm * e.lm,
                    m22   = a.lm * e.lm + a.mm * e.mm;
        const Lanes shear = (1. - poisson_ratio) * plate,
                    trace = poisson_ratio * plate * (m11 + m22);
        stress.planes[k]  = {shear * (m11 * a.ll + m12 * a.lm) + trace * a.ll,
                             shear * (m21 * a.lm + m22 * a.mm) + trace * a.mm,
                             shear * (m11 * a.lm + m12 * a.mm) + trace * a.lm};
        stress.bars[k]    = bar * inverse_length_square[k] *
                         inverse_length_square[k] * strain.bars[k];
      }
  }


  void
  OnePointCell::expand(const double expansion)
  {
    for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
        const Lanes        factor = expansion * value_gradient[k];
        strain.planes[k]          = {factor * edges[l].norm_square(),
                                     factor * edges[m].norm_square(),
                                     factor * (edges[l] * edges[m])};
        strain.bars[k]            = 0.;
      }
  }


  Lanes
  OnePointCell::stabilisation_work(const OnePointCell &other) const
  {
    Lanes work = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      {
        const auto &s = stress.planes[k], &e = other.strain.planes[k];
        work += s.ll * e.ll + s.mm * e.mm + 2. * s.lm * e.lm +
                stress.bars[k] * other.strain.bars[k];
      }
    return work;
  }


  void
  OnePointCell::integrate(const EvaluationFlags::EvaluationFlags)
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
    Tensor<2, 3, Lanes> total = volume * mean_stress;
    for (unsigned int k = 0; k < 4; ++k)
      total -= outer_product(force[k], warps[k]);

    Lanes *f = nodes.begin_dof_values();
    for (unsigned int d = 0; d < 3; ++d)
      {
        f[8 * d] = 0.;
        for (unsigned int k = 0; k < 3; ++k)
          {
            f[8 * d + linear[k]] = 0.125 * (total[d] * b_linear[k]);
            f[8 * d + hourglass[k]] =
              0.125 * (total[d] * b_hourglass[k] + force[k][d]);
          }
        f[8 * d + hourglass[3]] = 0.125 * force[3][d];
        to_corners(f + 8 * d);
      }
  }
} // namespace Voussoir
