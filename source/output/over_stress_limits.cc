#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/output/over_stress_limits.h>

#include <algorithm>
#include <functional>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  OverStressLimits::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Ratios",
                      ratios,
                      "Demand-capacity ratios above which time and area "
                      "are summed up, increasing from 1 [-]." +
                        usually(Usual::demand_capacity_ratio),
                      Patterns::List(Patterns::Double(0.), 1));
    prm.add_parameter(
      "Longest time",
      longest_time,
      "Accumulated time above the ratio 1 that is allowed in a linear "
      "analysis [s]. It falls linearly to zero at the \"Largest ratio\". The "
      "default comes from no code of practice: the user chooses the limit." +
        usually(Usual::accumulated_time),
      Patterns::Double(0.));
    prm.add_parameter(
      "Largest ratio",
      largest_ratio,
      "Demand-capacity ratio that is allowed in a linear analysis [-]. The "
      "default comes from no code of practice: the user chooses the limit." +
        usually(Usual::demand_capacity_ratio),
      Patterns::Double(1.));
    prm.add_parameter(
      "Largest share",
      largest_share,
      "Share of a face above the ratio 1 at any time that is allowed in a "
      "linear analysis [%]. The default comes from no code of practice: the "
      "user chooses the limit.",
      Patterns::Double(0., 100.));
  }


  void
  OverStressLimits::check(const std::string &section) const
  {
    if (ratios[0] != 1. ||
        std::adjacent_find(ratios.begin(),
                           ratios.end(),
                           std::greater_equal<double>()) != ratios.end())
      throw UserError("\"Ratios\" in " + section +
                      " must begin with 1 and increase from each to the "
                      "next; sort them and remove repeated ones.");
    if (longest_time > 0. && largest_ratio <= 1.)
      throw UserError("\"Largest ratio\" in " + section +
                      " must be above 1, so that the time allowed can fall "
                      "to zero there; set \"Longest time = 0\" to allow "
                      "none.");
  }


  double
  OverStressLimits::allowed_time(const double ratio) const
  {
    return ratio >= largest_ratio ?
             0. :
             longest_time * (largest_ratio - ratio) / (largest_ratio - 1.);
  }


  std::vector<std::string>
  OverStressLimits::reasons_of(const FaceOverStress &face) const
  {
    std::vector<std::string> reasons;
    if (!(face.largest <= largest_ratio))
      reasons.push_back("the demand-capacity ratio of the " + face.name +
                        " reaches " + text(face.largest) + ", more than " +
                        text(largest_ratio));
    const double share = 100. * face.ever[0] / face.area;
    if (!(share <= largest_share))
      reasons.push_back(text(share) + " % of the " + face.name +
                        " is above the ratio 1 at some time, more than " +
                        text(largest_share) + " %");
    if (face.largest_at_rest > 1.)
      reasons.push_back("the demand-capacity ratio of the " + face.name +
                        " is " + text(face.largest_at_rest) +
                        " in the static state");
    // the ratio at which the time is furthest above its limit; the static state
    // has no duration
    unsigned int worst  = 0;
    double       excess = 0.;
    for (unsigned int r = 0; r < ratios.size(); ++r)
      if (const double own = face.beyond_rest[r] - allowed_time(ratios[r]);
          own > excess && ratios[r] < largest_ratio)
        {
          worst  = r;
          excess = own;
        }
    if (excess > 0.)
      reasons.push_back("the " + face.name + " is above the ratio " +
                        text(ratios[worst]) + " for " +
                        text(face.beyond_rest[worst]) + " s, longer than " +
                        text(allowed_time(ratios[worst])) + " s");
    return reasons;
  }


  nlohmann::json
  OverStressLimits::json(const FaceOverStress &face) const
  {
    nlohmann::json result{
      {"largest ratio", face.largest},
      {"at the time [s]", face.time},
      {"at [m]", {face.where[0], face.where[1], face.where[2]}},
      {"largest ratio at rest", face.largest_at_rest},
      {"time of the largest ratio at rest [s]", 0.},
      {"place of the largest ratio at rest [m]",
       {face.where_at_rest[0], face.where_at_rest[1], face.where_at_rest[2]}},
      {"area [m2]", face.area}};
    for (unsigned int r = 0; r < ratios.size(); ++r)
      result["above " + text(ratios[r])] = {
        {"accumulated time [s]", face.accumulated[r]},
        {"accumulated time of what is below at rest [s]", face.beyond_rest[r]},
        {"share at rest [%]", 100. * face.resting[r] / face.area},
        {"area at any time [m2]", face.ever[r]},
        {"share at any time [%]", 100. * face.ever[r] / face.area},
        {"largest area at once [m2]", face.at_once[r]},
        {"largest share at once [%]", 100. * face.at_once[r] / face.area},
        {"time of the largest area at once [s]", face.time_at_once[r]}};
    return result;
  }


  std::string
  OverStressLimits::text(const double value)
  {
    std::ostringstream out;
    out << std::setprecision(3) << value;
    return out.str();
  }
} // namespace Voussoir
