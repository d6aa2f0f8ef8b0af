#include <voussoir/analysis/block.h>
#include <voussoir/base/mpi.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Rows treated at a time, of all vectors: they stay in the cache.
    constexpr std::size_t piece = 256;
    static_assert(piece % Lanes::size() == 0);

    // Vectors treated at a time: their sums stay in registers.
    constexpr unsigned int tile = 4;


    /** Vectors in whole tiles; beyond its end the last vector is repeated. */
    Columns
    filled_up(Columns columns)
    {
      columns.resize((columns.size() + tile - 1) / tile * tile, columns.back());
      return columns;
    }


    /** sums += products of the rows of tile x tile vectors. */
    void
    add_products(double *const    *a,
                 double *const    *b,
                 const std::size_t begin,
                 const std::size_t end,
                 double           *sums,
                 const std::size_t row_length)
    {
      std::array<std::array<Lanes, tile>, tile> sum{};
      for (std::size_t row = begin; row < end; row += Lanes::size())
        {
          std::array<Lanes, tile> x, y;
          for (unsigned int i = 0; i < tile; ++i)
            {
              x[i].load(a[i] + row);
              y[i].load(b[i] + row);
            }
          for (unsigned int i = 0; i < tile; ++i)
            for (unsigned int j = 0; j < tile; ++j)
              sum[i][j] += x[i] * y[j];
        }
      for (unsigned int i = 0; i < tile; ++i)
        for (unsigned int j = 0; j < tile; ++j)
          for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
            sums[i * row_length + j] += sum[i][j][lane];
    }


    /** The rows of tile targets, whose coefficients lie side by side. */
    void
    combine_rows(const Columns    &columns,
                 const double     *c,
                 const std::size_t row_length,
                 const std::size_t begin,
                 const std::size_t end,
                 double           *result)
    {
      for (std::size_t row = begin; row < end; row += Lanes::size())
        {
          std::array<Lanes, tile> sum{};
          for (std::size_t i = 0; i < columns.size(); ++i)
            {
              Lanes x;
              x.load(columns[i] + row);
              for (unsigned int j = 0; j < tile; ++j)
                sum[j] += c[i * row_length + j] * x;
            }
          for (unsigned int j = 0; j < tile; ++j)
            sum[j].store(result + j * piece + row - begin);
        }
    }
  } // namespace


  Block::Block(const std::size_t size, const unsigned int n_vectors)
    : stride((size + Lanes::size() - 1) / Lanes::size() * Lanes::size())
    , values(stride * n_vectors)
  {}


  FullMatrix<double>
  symmetric_products(const Columns    &a,
                     const Columns    &b,
                     const std::size_t padded_size,
                     const MPI_Comm    communicator)
  {
    const Columns       x = filled_up(a), y = filled_up(b);
    std::vector<double> sums(x.size() * y.size());
    for (std::size_t begin = 0; begin < padded_size; begin += piece)
      for (std::size_t i = 0; i < x.size(); i += tile)
        for (std::size_t j = i; j < y.size(); j += tile)
          add_products(&x[i],
                       &y[j],
                       begin,
                       std::min(begin + piece, padded_size),
                       &sums[i * y.size() + j],
                       y.size());
    sums = sum_over_ranks(sums, communicator);
    FullMatrix<double> result(a.size());
    for (unsigned int i = 0; i < a.size(); ++i)
      for (unsigned int j = i; j < a.size(); ++j)
        result(i, j) = result(j, i) = sums[i * y.size() + j];
    return result;
  }


  void
  combine(const Columns            &targets,
          const Columns            &columns,
          const FullMatrix<double> &c,
          const std::size_t         padded_size)
  {
    const std::size_t   n = filled_up(targets).size();
    std::vector<double> coefficients(columns.size() * n);
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t j = 0; j < targets.size(); ++j)
        coefficients[i * n + j] = c(i, j);
    AlignedVector<double> result(n * piece);
    for (std::size_t begin = 0; begin < padded_size; begin += piece)
      {
        const std::size_t end = std::min(begin + piece, padded_size);
        for (std::size_t j = 0; j < n; j += tile)
          combine_rows(
            columns, &coefficients[j], n, begin, end, &result[j * piece]);
        for (std::size_t j = 0; j < targets.size(); ++j)
          std::copy_n(&result[j * piece], end - begin, targets[j] + begin);
      }
  }
} // namespace Voussoir
