#ifndef voussoir_analysis_secant_steps_h
#define voussoir_analysis_secant_steps_h

#include <voussoir/fem/discretization.h>

#include <deque>
#include <functional>

namespace Voussoir
{
  /**
   * Steps of the quasi-Newton method of Broyden, Fletcher, Goldfarb and Shanno
   * with limited memory (Matthies and Strang 1979; Nocedal 1980): the changes
   * of the residual in the last steps correct an approximate inverse of the
   * tangent.
   */
  class SecantSteps
  {
  public:
    /** result = B vector, an approximate inverse of the tangent, symmetric and
     *  positive definite. */
    using Inverse = std::function<void(Vector &, const Vector &)>;

    /** The quasi-Newton step for a residual, external less internal forces. */
    void
    find(Vector &step, const Vector &residual, const Inverse &inverse) const;

    /** Stores a step and the change of the residual that it made. */
    void
    add(const Vector &step, const Vector &taken);

    /** Whether no step is stored. */
    bool
    empty() const;

    /** Forgets all steps. */
    void
    clear();

  private:
    struct Pair
    {
      Vector step, taken;
      double work; // step . taken
    };

    std::deque<Pair> pairs; // the oldest first
  };
} // namespace Voussoir

#endif
