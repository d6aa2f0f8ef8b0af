#ifndef voussoir_driver_sensitivity_h
#define voussoir_driver_sensitivity_h

#include <voussoir/base/parameter_file.h>
#include <voussoir/driver/study_parameters.h>

namespace Voussoir
{
  /** A number of a parameter file, moved by a small share. */
  struct MovedNumber
  {
    std::string entry;
    double      value;
    std::string name;   // of the entry, and its place in a list of numbers
    double      change; // over the value
    std::string text;   // of the entry with the moved number
  };

  /** Each real number of a file that is not zero, twice: moved down and up by a
   *  share.
   *
   *  @param prm of the case, whose patterns show which entries are numbers */
  std::vector<MovedNumber>
  moved_numbers(const ParameterFile            &file,
                const dealii::ParameterHandler &prm,
                const StudyParameters          &parameters);

  /** Sensitivity of a quantity to a number. */
  struct Sensitivity
  {
    /**
     * @param as_given the quantity
     * @param moved    change of the number over its value, and the quantity
     *   there
     */
    Sensitivity(const double                                  as_given,
                const std::vector<std::pair<double, double>> &moved);

    // both over the quantity as given, or the largest one where that is zero
    double largest_change = 0.,
           per_change     = 0.; // of the number: 1 is proportional, -1 inverse
  };
} // namespace Voussoir

#endif
