#ifndef voussoir_driver_calibration_h
#define voussoir_driver_calibration_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

namespace Voussoir
{
  /**
   * A Gauss-Newton step towards the entries that fit computed to measured
   * numbers, by least squares of the differences of their logarithms.
   */
  struct CalibrationStep
  {
    /**
     * @param sensitivity change of the logarithm of a number (row) over that of
     *   an entry (column)
     * @param misfit      logarithms of computed over measured numbers
     * @param error       relative standard error of a measured number
     */
    CalibrationStep(const dealii::FullMatrix<double> &sensitivity,
                    const dealii::Vector<double>     &misfit,
                    const double                      error);

    /** Whether the numbers determine the entries; if not, there is no step. */
    bool determined = false;

    /** Change of the logarithms of the entries. */
    dealii::Vector<double> change;

    /** Relative standard errors of the entries. */
    dealii::Vector<double> deviation;
  };
} // namespace Voussoir

#endif
