#ifndef voussoir_output_over_stress_limits_h
#define voussoir_output_over_stress_limits_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** Over-stress of a face set over the run. */
  struct FaceOverStress
  {
    std::string name;
    double      area; // [m2]

    // largest demand-capacity ratio [-], its time [s] and place [m]
    double           largest, time;
    dealii::Point<3> where;

    // largest ratio of the static state [-], and its place [m]
    double           largest_at_rest;
    dealii::Point<3> where_at_rest;

    // of each ratio of the list: longest accumulated time of a point [s], the
    // same of the points below the ratio in the static state, area above the
    // ratio in the static state, ever, and at most at one moment [m2]
    std::vector<double> accumulated, beyond_rest, resting, ever, at_once,
      time_at_once;
  };


  /**
   * Limits up to which a linear analysis suffices: ratio, area and accumulated
   * time, the quantities of Ghanaat (2004). The defaults come from no code of
   * practice.
   */
  struct OverStressLimits
  {
    std::vector<double>
      ratios{1., 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.};

    double longest_time  = 0.4; // [s]
    double largest_ratio = 2.;
    double largest_share = 20.; // [%]

    void
    declare_parameters(dealii::ParameterHandler &prm);

    /** @param section of these entries, for messages */
    void
    check(const std::string &section) const;

    /** Accumulated time that a linear analysis allows above a ratio [s]. */
    double
    allowed_time(const double ratio) const;

    /** Reasons why a face calls for a non-linear analysis; none if it does not.
     */
    std::vector<std::string>
    reasons_of(const FaceOverStress &face) const;

    /** Results of a face for the summary. */
    nlohmann::json
    json(const FaceOverStress &face) const;

    /** A ratio, time or share with three digits. */
    static std::string
    text(const double value);
  };
} // namespace Voussoir

#endif
