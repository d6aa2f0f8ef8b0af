#ifndef voussoir_driver_calibration_h
#define voussoir_driver_calibration_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

namespace Voussoir
{
  /**
   * A step of Gauss and Newton towards the entries for which computed numbers
   * are as near as possible to measured ones, in the least squares of their
   * logarithms.
   */
  struct CalibrationStep
  {
    /**
     * @param sensitivity change of the logarithm of a number, its row, over
     *   that of an entry, its column
     * @param misfit      logarithms of computed over measured numbers
     * @param error       relative standard error of a measured number
     */
    CalibrationStep(const dealii::FullMatrix<double> &sensitivity,
                    const dealii::Vector<double>     &misfit,
                    const double                      error);

    /** Whether the numbers tell the entries apart; if not, there is no step. */
    bool determined = false;

    /** Of the logarithms of the entries. */
    dealii::Vector<double> change;

    /** Relative standard errors of the entries. */
    dealii::Vector<double> deviation;
  };
} // namespace Voussoir

#endif
