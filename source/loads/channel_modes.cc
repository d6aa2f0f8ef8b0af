#include <voussoir/loads/channel_modes.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int max_iterations = 30;
    constexpr double       tolerance      = 1e-10; // of omega^2


    /** K + shift M over the nodes below the free surface. */
    class ShiftedMatrix
    {
    public:
      ShiftedMatrix(const SparseMatrix<double>      &stiffness,
                    const std::vector<double>       &areas,
                    const std::vector<unsigned int> &nodes,
                    const double                     shift)
      {
        constexpr unsigned int    none = numbers::invalid_unsigned_int;
        std::vector<unsigned int> number(areas.size(), none);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          number[nodes[i]] = i;
        const auto for_each_entry = [&](const auto &visit) {
          for (unsigned int i = 0; i < nodes.size(); ++i)
            for (auto entry = stiffness.begin(nodes[i]);
                 entry != stiffness.end(nodes[i]);
                 ++entry)
              if (number[entry->column()] != none)
                visit(i, number[entry->column()], entry->value());
        };
        DynamicSparsityPattern entries(nodes.size());
        for_each_entry([&](const unsigned int i, const unsigned int j, double) {
          entries.add(i, j);
        });
        pattern.copy_from(entries);
        matrix.reinit(pattern);
        for_each_entry([&](const unsigned int i,
                           const unsigned int j,
                           const double value) { matrix.set(i, j, value); });
        for (unsigned int i = 0; i < nodes.size(); ++i)
          matrix.add(i, i, shift * areas[nodes[i]]);
        inverse.factorize(matrix);
      }

      SparsityPattern      pattern;
      SparseMatrix<double> matrix;
      SparseDirectUMFPACK  inverse;
    };


    using Vectors = std::vector<dealii::Vector<double>>;


    double
    product(const dealii::Vector<double> &a,
            const std::vector<double>    &m,
            const dealii::Vector<double> &b)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < m.size(); ++i)
        sum += a(i) * m[i] * b(i);
      return sum;
    }


    void
    orthonormalize(Vectors &x, const std::vector<double> &m)
    {
      for (unsigned int a = 0; a < x.size(); ++a)
        {
          x[a] /= std::sqrt(product(x[a], m, x[a]));
          for (unsigned int b = 0; b < a; ++b)
            x[a].add(-product(x[b], m, x[a]), x[b]);
          x[a] /= std::sqrt(product(x[a], m, x[a]));
        }
    }


    /** Replaces the vectors by the Ritz vectors of their space, lowest first.
     *  @return eigenvalues */
    std::vector<double>
    ritz(Vectors &x, const ShiftedMatrix &matrix, const std::vector<double> &m)
    {
      const unsigned int       n_vectors = x.size(), n = m.size();
      LAPACKFullMatrix<double> stiffness(n_vectors), mass(n_vectors);
      dealii::Vector<double>   image(n);
      for (unsigned int a = 0; a < n_vectors; ++a)
        {
          matrix.matrix.vmult(image, x[a]);
          for (unsigned int b = 0; b < n_vectors; ++b)
            {
              stiffness(b, a) = x[b] * image;
              mass(b, a)      = product(x[b], m, x[a]);
            }
        }
      Vectors coefficients(n_vectors);
      stiffness.compute_generalized_eigenvalues_symmetric(mass, coefficients);
      const Vectors       old = x;
      std::vector<double> values(n_vectors);
      for (unsigned int a = 0; a < n_vectors; ++a)
        {
          values[a] = stiffness.eigenvalue(a).real();
          x[a]      = 0.;
          for (unsigned int b = 0; b < n_vectors; ++b)
            x[a].add(coefficients[a](b), old[b]);
        }
      return values;
    }
  } // namespace


  ChannelModes
  find_channel_modes(const SparseMatrix<double> &stiffness,
                     const std::vector<double>  &areas,
                     const std::vector<bool>    &in_surface,
                     const double                speed,
                     const unsigned int          number)
  {
    std::vector<unsigned int> nodes;
    std::vector<double>       m;
    for (unsigned int i = 0; i < areas.size(); ++i)
      if (!in_surface[i])
        {
          nodes.push_back(i);
          m.push_back(areas[i]);
        }
    const unsigned int n = nodes.size(), n_modes = std::min(number, n),
                       n_vectors = std::min(2 * n_modes, n);
    if (n == 0)
      return {};

    // without free surface K is singular; eigenvalues of a square of this area
    // are of the order 1/area
    const double        shift = 1. / std::accumulate(m.begin(), m.end(), 0.);
    const ShiftedMatrix matrix(stiffness, areas, nodes, shift);
    std::mt19937        random; // the same start vectors on all ranks
    Vectors             x(n_vectors, dealii::Vector<double>(n));
    for (auto &vector : x)
      for (double &entry : vector)
        entry = static_cast<double>(random()) / random.max() - 0.5;

    std::vector<double> values(n_vectors);
    double              change = 1.;
    for (unsigned int i = 0; i < max_iterations && change > tolerance; ++i)
      {
        for (auto &vector : x)
          {
            for (unsigned int j = 0; j < n; ++j)
              vector(j) *= m[j];
            matrix.inverse.solve(vector);
          }
        orthonormalize(x, m);
        const std::vector<double> last = values;
        values                         = ritz(x, matrix, m);
        change                         = 0.;
        for (unsigned int a = 0; a < n_modes; ++a)
          change = std::max(change, std::abs(1. - last[a] / values[a]));
      }

    ChannelModes modes;
    modes.shapes.resize(areas.size() * n_modes);
    for (unsigned int a = 0; a < n_modes; ++a)
      {
        modes.frequencies.push_back(speed *
                                    std::sqrt(std::max(values[a] - shift, 0.)));
        for (unsigned int i = 0; i < n; ++i)
          modes.shapes[nodes[i] * n_modes + a] = x[a](i);
      }
    return modes;
  }
} // namespace Voussoir
