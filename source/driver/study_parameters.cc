#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/study_parameters.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Entries that are varied together: their values in each run. */
    using PairedEntries = std::vector<StudyValues>;

    PairedEntries
    paired_entries(const std::string &text)
    {
      PairedEntries runs;
      for (const std::string &part : split_list(text, '&'))
        {
          const auto        equals = part.find('=');
          const std::string entry  = Utilities::trim(part.substr(0, equals));
          const char        separator =
            part.find('|') == std::string::npos ? ',' : '|';
          const auto values = equals == std::string::npos ?
                                std::vector<std::string>() :
                                split_list(part.substr(equals + 1), separator);
          if (values.empty())
            throw UserError("\"Vary\" in section \"Study\" gives \"" + entry +
                            "\" no values; write \"Section/Entry = 1, 2\".");
          if (runs.empty())
            runs.resize(values.size());
          if (values.size() != runs.size())
            throw UserError("\"Vary\" in section \"Study\" pairs " +
                            std::to_string(values.size()) + " values of \"" +
                            entry + "\" with " + std::to_string(runs.size()) +
                            " of \"" + runs[0][0].first +
                            "\"; give as many, or cross them by \";\" instead "
                            "of \"&\".");
          for (std::size_t i = 0; i < values.size(); ++i)
            runs[i].emplace_back(entry, values[i]);
        }
      return runs;
    }


    std::vector<Criterion>
    criteria_of(const std::string &list, const std::string &place)
    {
      std::vector<Criterion> result;
      for (const std::string &text : split_list(list, ';'))
        result.emplace_back(text, place);
      return result;
    }
  } // namespace


  void
  StudyParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Vary",
      vary,
      "Entries of this file with the values they take, separated by "
      "semicolons, as in \"Ground motion/Overload factor = 1, 1.2, 1.4; "
      "Materials/rock/Young's modulus = 15e9, 20e9\". Each combination is a "
      "run of its own. \"&\" instead of a semicolon pairs two entries: the "
      "first values of both together, then the second. \"|\" separates values "
      "that are lists, as in \"Mesh/box/Cells = 1, 1, 10 | 1, 1, 20\". \"" +
        strength_reduction +
        "\" divides the entries of \"Reduced strengths\".");
    prm.add_parameter(
      "Spread over",
      spread,
      "Varied entries, separated by semicolons, over which "
      "study_statistics.csv gives mean, spread and fractiles of each quantity, "
      "for each combination of the others: of records, for an incremental "
      "dynamic analysis. Empty: no statistics.");
    prm.add_parameter(
      "Reduced strengths",
      reduced,
      "Entries that the " + strength_reduction +
        " divides, separated by semicolons, as in \"Interfaces/planes/Friction "
        "coefficient; Interfaces/planes/Cohesion\"; of an angle of friction, "
        "its tangent. Other strengths of the case stay unchanged; log and "
        "study.json name them.");
    prm.add_parameter(
      "Quantities",
      quantities,
      "Numbers of summary.json in the columns of study.csv, by their paths, "
      "separated by semicolons; a star stands for any letters, and of "
      "several matching numbers the largest is taken, or the smallest if the "
      "last name begins with \"smallest\". Empty: displacements of the "
      "histories, opening, slip and safety of interfaces and blocks, share "
      "of the faces and time of over-stress, cracks that go through, energy "
      "lost in cracks.");
    prm.add_parameter(
      "Ranks of a run",
      ranks_of_run,
      "Ranks of each run, so that several runs are computed at the same "
      "time; 0: all ranks, for one run after the other.",
      Patterns::Integer(0));

    prm.enter_subsection("Limit");
    declare_limit(prm);
    prm.leave_subsection();
    prm.enter_subsection("Extrapolation");
    declare_extrapolation(prm);
    prm.leave_subsection();
    prm.enter_subsection("Fragility");
    declare_fragility(prm);
    prm.leave_subsection();
    prm.enter_subsection("Sensitivity");
    declare_sensitivity(prm);
    prm.leave_subsection();
    prm.enter_subsection("Calibration");
    declare_calibration(prm);
    prm.leave_subsection();
  }


  void
  StudyParameters::declare_limit(ParameterHandler &prm)
  {
    prm.add_parameter("Entry",
                      varied_to_limit,
                      "Entry that grows until a criterion is met, as \"Ground "
                      "motion/Overload factor\" or \"" +
                        strength_reduction +
                        "\", in each combination; empty: no limit is sought.");
    prm.add_parameter("From", from, "Value at which the criterion is not met.");
    prm.add_parameter("To", to, "Value at which the criterion is met.");
    prm.add_parameter("Accuracy",
                      accuracy,
                      "Width of the bracket at which the search ends.",
                      Patterns::Double(1e-9));
    prm.add_parameter(
      "Criterion",
      criterion,
      "Criterion of the limit: \"PATH > VALUE\" or \"PATH < VALUE\" of a "
      "number of summary.json, or \"stopped\", for a static stage without "
      "equilibrium or a run that is stopped because of its energy; of "
      "several criteria, separated by semicolons, one is enough. A run that "
      "fails otherwise meets no criterion and ends the search.");
    prm.add_parameter(
      "Extend",
      extend,
      "Whether to search beyond \"From\" and \"To\", by up to four times "
      "their distance, where the limit is not between them.");
  }


  void
  StudyParameters::declare_extrapolation(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Over",
      refined,
      "Varied entries, separated by semicolons, that make cells or time "
      "steps smaller, in at least three runs: study_convergence.csv then "
      "gives, by Richardson's extrapolation, the observed order of "
      "convergence of each quantity, its value for cells and steps of size "
      "zero and a band, or the reason why there is none. Empty: no "
      "extrapolation.");
    prm.add_parameter(
      "Order",
      method_order,
      "Theoretical order of convergence for smooth solutions: 2 for time "
      "steps and displacements of elements of degree 1. An observed order "
      "above it is not relied on [-].",
      Patterns::Double(0.5, 10.));
    prm.add_parameter(
      "Dimensions",
      dimensions,
      "Directions in which cells become smaller: their size is the number of "
      "cells to the power of minus one over this. Where all runs have the "
      "same number of cells, the size is the time step.",
      Patterns::Integer(1, 3));
  }


  void
  StudyParameters::declare_fragility(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Intensity",
      intensity,
      "Varied entry that is the intensity of the motion, as \"Ground "
      "motion/Overload factor\": study_fragility.csv then has the lognormal "
      "probability that the criterion is met, by maximum likelihood, from all "
      "runs over \"Spread over\" at each intensity. Empty: no fragility.");
    prm.add_parameter("Criterion",
                      fragility_criterion,
                      "Criterion of the curve, as in section \"Study/Limit\".");
    prm.add_parameter("Confidence",
                      confidence,
                      "Probability that median and dispersion lie within "
                      "their bounds [-].",
                      Patterns::Double(0.5, 0.999));
  }


  void
  StudyParameters::declare_sensitivity(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Change",
      change,
      "Share by which each number that the file gives is moved down and up, "
      "in two runs of its own, as 0.01; study_sensitivity.csv lists the "
      "changes of the quantities, the largest first. Integers, zeros and "
      "numbers within texts are not moved. 0: no sensitivity [-].",
      Patterns::Double(0., 0.5));
    prm.add_parameter("Entries",
                      moved,
                      "Entries that are moved, by their paths, separated by "
                      "semicolons; a star stands for any letters, as in "
                      "\"Materials/*\".");
  }


  void
  StudyParameters::declare_calibration(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Fitted",
      fitted,
      "Entries that are fitted to measured numbers, separated by semicolons, "
      "as \"Materials/concrete/Young's modulus; Materials/rock/Young's "
      "modulus\", in each combination. The search begins at their values in "
      "this file; study_calibration.csv has the values found. Empty: no "
      "calibration.");
    prm.add_parameter(
      "Measured",
      measured,
      "Measured numbers, separated by semicolons, \"PATH = VALUE\" by their "
      "paths in summary.json, as \"modes/modes/0/frequency [Hz] = 5.45\", at "
      "least as many as fitted entries. The search minimises the sum of the "
      "squares of the logarithms of computed over measured numbers.");
    prm.add_parameter(
      "Error",
      measurement_error,
      "Relative standard error of a measured number, from which the standard "
      "errors of the fitted entries follow [-].",
      Patterns::Double(1e-6, 1.));
    prm.add_parameter(
      "Accuracy",
      calibration_accuracy,
      "Relative change of the fitted entries at which the search ends [-].",
      Patterns::Double(1e-6, 0.1));
    prm.add_parameter("Iterations",
                      max_iterations,
                      "Largest number of steps of the search; each takes one "
                      "run and a further one for each fitted entry.",
                      Patterns::Integer(1, 100));
  }


  bool
  StudyParameters::wanted() const
  {
    return !vary.empty() || seeks_limit() || moves_numbers() || calibrates();
  }


  bool
  StudyParameters::seeks_limit() const
  {
    return !varied_to_limit.empty();
  }


  bool
  StudyParameters::moves_numbers() const
  {
    return change > 0.;
  }


  bool
  StudyParameters::calibrates() const
  {
    return !fitted.empty();
  }


  bool
  StudyParameters::reduces_strengths() const
  {
    return (vary + ";" + varied_to_limit).find(strength_reduction) !=
           std::string::npos;
  }


  void
  StudyParameters::check() const
  {
    combinations();
    spread_entries();
    if (seeks_limit() && criteria().empty())
      throw UserError(
        "\"Criterion\" in section \"Study/Limit\" is empty; give the "
        "condition that is met at the limit of \"" +
        varied_to_limit + "\".");
    if (seeks_limit() && !(from < to))
      throw UserError(
        "\"From\" in section \"Study/Limit\" is not below \"To\"; "
        "give the smaller value first.");
    if (reduces_strengths() && reduced.empty())
      throw UserError("Section \"Study\" has a " + strength_reduction +
                      ", but \"Reduced strengths\" names no entries.");
    check_calibration();
    check_evaluations();
  }


  void
  StudyParameters::check_calibration() const
  {
    if (!calibrates())
      return;
    if (seeks_limit() || moves_numbers() || !refined.empty() ||
        !intensity.empty())
      throw UserError(
        "\"Fitted\" in section \"Study/Calibration\" goes with \"Vary\" only; "
        "leave the entries of sections \"Limit\", \"Sensitivity\", "
        "\"Extrapolation\" and \"Fragility\" of section \"Study\" empty.");
    const auto n_numbers = measured_numbers().size(),
               n_entries = fitted_entries().size();
    if (n_numbers < n_entries)
      throw UserError("\"Measured\" in section \"Study/Calibration\" has " +
                      counted(n_numbers, "number", "numbers") + " for " +
                      counted(n_entries, "fitted entry", "fitted entries") +
                      "; give at least as many numbers as entries.");
  }


  void
  StudyParameters::check_evaluations() const
  {
    if (moves_numbers() && (!vary.empty() || seeks_limit()))
      throw UserError("\"Change\" in section \"Study/Sensitivity\" moves each "
                      "number of the case; leave \"Vary\" and the entry of "
                      "section \"Study/Limit\" empty for it.");
    for (const auto &[list, place] :
         {std::pair(refined, "\"Over\" in section \"Study/Extrapolation\""),
          std::pair(intensity, "\"Intensity\" in section \"Study/Fragility\"")})
      if (!list.empty() && seeks_limit())
        throw UserError(std::string(place) +
                        " is evaluated from runs that are all done; leave it "
                        "or the entry of section \"Study/Limit\" empty.");

    std::set<StudyValues> others;
    for (const StudyValues &values : combinations())
      others.insert(other_values(values, refined_entries()));
    if (const auto n = combinations().size() / others.size();
        !refined.empty() && n < 3)
      throw UserError("\"Over\" in section \"Study/Extrapolation\" has " +
                      counted(n, "value", "values") + " of \"" + refined +
                      "\" in \"Vary\"; give at least three.");

    fragility_entries();
    if (intensity.empty())
      return;
    if (fragility_criteria().empty())
      throw UserError("\"Criterion\" in section \"Study/Fragility\" is empty; "
                      "give the condition that is met at larger intensities.");
    for (const StudyValues &values : combinations())
      for (const auto &[entry, value] : values)
        if (entry == intensity && !(parse_number(value).value_or(0.) > 0.))
          throw UserError(
            "\"Vary\" in section \"Study\" gives the intensity \"" + entry +
            "\" the value \"" + value + "\"; give it numbers above zero.");
  }


  std::vector<StudyValues>
  StudyParameters::combinations() const
  {
    std::vector<StudyValues> result(1);
    for (const std::string &group : split_list(vary, ';'))
      {
        std::vector<StudyValues> longer;
        for (const StudyValues &before : result)
          for (const StudyValues &values : paired_entries(group))
            {
              longer.push_back(before);
              longer.back().insert(longer.back().end(),
                                   values.begin(),
                                   values.end());
            }
        result = std::move(longer);
      }
    return result;
  }


  std::vector<std::string>
  StudyParameters::with_partners(const std::string &list,
                                 const std::string &place) const
  {
    const auto               wanted = split_list(list, ';');
    std::vector<std::string> result;
    for (const std::string &group : split_list(vary, ';'))
      {
        const PairedEntries      runs = paired_entries(group);
        std::vector<std::string> entries;
        for (const auto &item : runs.at(0))
          entries.push_back(item.first);
        if (std::any_of(entries.begin(), entries.end(), [&](const auto &entry) {
              return std::find(wanted.begin(), wanted.end(), entry) !=
                     wanted.end();
            }))
          result.insert(result.end(), entries.begin(), entries.end());
      }
    for (const std::string &entry : wanted)
      if (std::find(result.begin(), result.end(), entry) == result.end())
        throw UserError(place + " names \"" + entry +
                        "\", which \"Vary\" does not vary.");
    return result;
  }


  std::vector<std::string>
  StudyParameters::spread_entries() const
  {
    return with_partners(spread, "\"Spread over\" in section \"Study\"");
  }


  std::vector<std::string>
  StudyParameters::refined_entries() const
  {
    return with_partners(refined,
                         "\"Over\" in section \"Study/Extrapolation\"");
  }


  std::vector<std::string>
  StudyParameters::fragility_entries() const
  {
    std::vector<std::string> result =
      with_partners(intensity, "\"Intensity\" in section \"Study/Fragility\"");
    for (const std::string &entry : spread_entries())
      result.push_back(entry);
    return result;
  }


  std::vector<std::string>
  StudyParameters::fitted_entries() const
  {
    return split_list(fitted, ';');
  }


  std::vector<std::pair<SummaryNumber, double>>
  StudyParameters::measured_numbers() const
  {
    std::vector<std::pair<SummaryNumber, double>> result;
    for (const std::string &text : split_list(measured, ';'))
      {
        const auto                  equals = text.rfind('=');
        const std::optional<double> value =
          equals == std::string::npos ?
            std::optional<double>() :
            parse_number(Utilities::trim(text.substr(equals + 1)));
        if (!value || !(*value > 0.))
          throw UserError(
            "\"Measured\" in section \"Study/Calibration\" has \"" + text +
            "\"; write \"PATH = VALUE\" with the path of a "
            "number in summary.json and a value above zero, as "
            "\"modes/modes/0/frequency [Hz] = 5.45\".");
        result.emplace_back(
          SummaryNumber(Utilities::trim(text.substr(0, equals))), *value);
      }
    return result;
  }


  NamedNumbers
  StudyParameters::named_numbers() const
  {
    NamedNumbers result;
    if (!quantities.empty())
      for (const SummaryNumber &number : numbers())
        result.emplace_back(number, "\"Quantities\" in section \"Study\"");
    for (const auto &[section, of_section] :
         {std::pair("Limit", criteria()),
          std::pair("Fragility", fragility_criteria())})
      for (const Criterion &criterion : of_section)
        if (criterion.about() != nullptr)
          result.emplace_back(*criterion.about(),
                              std::string("\"Criterion\" in section "
                                          "\"Study/") +
                                section + "\"");
    for (const auto &number : measured_numbers())
      result.emplace_back(number.first,
                          "\"Measured\" in section \"Study/Calibration\"");
    return result;
  }


  std::vector<SummaryNumber>
  StudyParameters::numbers() const
  {
    static const std::string usual =
      "histories/*/largest displacement [m];"
      "interfaces/surfaces/*/largest opening [mm];"
      "interfaces/surfaces/*/residual slip [mm];"
      "interfaces/surfaces/*/slip rate at the end [mm/s];"
      "interfaces/blocks/*/smallest safety;"
      "interfaces/blocks/*/slip at the end [mm];"
      "over-stress/*/largest ratio;"
      "over-stress/*/above 1/share at any time [%];"
      "over-stress/*/above 1/accumulated time [s];"
      "through cracks/largest opening from face to face at one moment [mm];"
      "energy balance/lost to cracks and plastic flow [J]";
    std::vector<SummaryNumber> result;
    if (quantities.empty() && calibrates())
      {
        for (const auto &number : measured_numbers())
          result.push_back(number.first);
        return result;
      }
    for (const std::string &path :
         split_list(quantities.empty() ? usual : quantities, ';'))
      result.emplace_back(path);
    return result;
  }


  std::vector<Criterion>
  StudyParameters::criteria() const
  {
    return criteria_of(criterion, "\"Criterion\" in section \"Study/Limit\"");
  }


  std::vector<Criterion>
  StudyParameters::fragility_criteria() const
  {
    return criteria_of(fragility_criterion,
                       "\"Criterion\" in section \"Study/Fragility\"");
  }


  std::string
  description(const StudyValues &values)
  {
    std::vector<std::string> parts;
    for (const auto &[entry, value] : values)
      parts.push_back(entry.substr(entry.rfind('/') + 1) + " = " + value);
    return join(parts, ", ");
  }


  StudyValues
  other_values(const StudyValues              &values,
               const std::vector<std::string> &entries)
  {
    StudyValues others;
    for (const auto &item : values)
      if (std::find(entries.begin(), entries.end(), item.first) ==
          entries.end())
        others.push_back(item);
    return others;
  }
} // namespace Voussoir
