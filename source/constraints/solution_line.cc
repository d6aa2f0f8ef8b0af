#include <voussoir/constraints/solution_line.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace Voussoir
{
  namespace Dense
  {
    double
    largest(const Vector &v)
    {
      double result = 0.;
      for (const double value : v)
        result = std::max(result, std::abs(value));
      return result;
    }


    double
    product(const Vector &a, const Vector &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    }


    Vector
    sum(Vector a, const double factor, const Vector &b)
    {
      for (std::size_t i = 0; i < a.size(); ++i)
        a[i] += factor * b[i];
      return a;
    }


    double
    distance(const Vector &a, const Vector &b)
    {
      const Vector difference = sum(a, -1., b);
      return std::sqrt(product(difference, difference));
    }


    Line
    solve(std::vector<Vector> matrix, Vector right)
    {
      const unsigned int        n = right.size();
      std::vector<unsigned int> column(n + 1);
      std::iota(column.begin(), column.end(), 0);
      double sign = 1.;
      for (unsigned int p = 0; p < n; ++p)
        {
          unsigned int row = p, place = p;
          for (unsigned int i = p; i < n; ++i)
            for (unsigned int j = p; j <= n; ++j)
              if (std::abs(matrix[i][column[j]]) >
                  std::abs(matrix[row][column[place]]))
                {
                  row   = i;
                  place = j;
                }
          std::swap(matrix[row], matrix[p]);
          std::swap(right[row], right[p]);
          std::swap(column[place], column[p]);
          const double pivot = matrix[p][column[p]];
          if ((row != p) != (place != p))
            sign = -sign;
          if (pivot < 0.)
            sign = -sign;
          for (unsigned int i = p + 1; i < n; ++i)
            if (const double factor = matrix[i][column[p]] / pivot;
                factor != 0.)
              {
                matrix[i] = sum(std::move(matrix[i]), -factor, matrix[p]);
                right[i] -= factor * right[p];
              }
        }
      Line result{Vector(n + 1), Vector(n + 1)};
      result.direction[column[n]] = sign;
      for (unsigned int p = n; p-- > 0;)
        {
          double along = 0., rest = right[p];
          for (unsigned int j = p + 1; j <= n; ++j)
            {
              along -= matrix[p][column[j]] * result.direction[column[j]];
              rest -= matrix[p][column[j]] * result.nearest[column[j]];
            }
          result.direction[column[p]] = along / matrix[p][column[p]];
          result.nearest[column[p]]   = rest / matrix[p][column[p]];
        }
      const double size =
        std::sqrt(product(result.direction, result.direction));
      for (double &value : result.direction)
        value /= size;
      result.nearest = sum(result.nearest,
                           -product(result.nearest, result.direction),
                           result.direction);
      return result;
    }
  } // namespace Dense
} // namespace Voussoir
