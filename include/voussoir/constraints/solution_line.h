#ifndef voussoir_constraints_solution_line_h
#define voussoir_constraints_solution_line_h

#include <vector>

namespace Voussoir
{
  /** Small dense vectors and systems. */
  namespace Dense
  {
    using Vector = std::vector<double>;

    double
    largest(const Vector &v);

    double
    product(const Vector &a, const Vector &b);

    /** a + factor b */
    Vector
    sum(Vector a, const double factor, const Vector &b);

    double
    distance(const Vector &a, const Vector &b);


    /** The line of solutions of n equations in n + 1 unknowns. */
    struct Line
    {
      Vector nearest;   // to zero
      Vector direction; // as last row it makes the determinant positive
    };

    /** The line of n equations, by elimination with complete pivoting. */
    Line
    solve(std::vector<Vector> matrix, Vector right);
  } // namespace Dense
} // namespace Voussoir

#endif
