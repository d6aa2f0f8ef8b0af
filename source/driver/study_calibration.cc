#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/driver/calibration.h>
#include <voussoir/driver/study.h>

#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Value of a fitted entry in the file. */
    double
    given_value(const ParameterFile &file, const std::string &entry)
    {
      const std::string           text  = file.given(entry);
      const std::optional<double> value = parse_number(text);
      if (!value || !(*value > 0.))
        throw UserError("\"Fitted\" in section \"Study/Calibration\" names \"" +
                        entry + "\", which is \"" + text +
                        "\" in this file; give it a number above zero, from "
                        "which the search begins.");
      return *value;
    }
  } // namespace


  StudyValues
  Study::fitted_values(StudyValues                   values,
                       const dealii::Vector<double> &logarithms) const
  {
    const auto entries = parameters.fitted_entries();
    for (unsigned int i = 0; i < entries.size(); ++i)
      values.emplace_back(entries[i],
                          number_text(given_value(file, entries[i]) *
                                        std::exp(logarithms[i]),
                                      fine_digits));
    return values;
  }


  dealii::Vector<double>
  Study::misfit(const StudyValues &values)
  {
    const Outcome run = outcome_of(values);
    if (run.summary.end != RunEnd::complete)
      throw UserError("The run in \"" + run.folder + "\" " +
                      run.summary.short_verdict() +
                      ", so that the calibration cannot continue; correct "
                      "that and start the study again.");
    const auto             measured = parameters.measured_numbers();
    dealii::Vector<double> result(measured.size());
    for (unsigned int i = 0; i < measured.size(); ++i)
      {
        const auto &[number, wanted]      = measured[i];
        const std::optional<double> value = number.in(run.numbers);
        if (!value || !(*value > 0.))
          throw UserError(
            "\"Measured\" in section \"Study/Calibration\" names \"" +
            number.path + "\", which in the run in \"" + run.folder + "\" is " +
            (value ? "not above zero" : "no number of the summary") +
            "; name others.");
        result[i] = std::log(*value / wanted);
      }
    return result;
  }


  void
  Study::calibrate(const StudyValues &values)
  {
    constexpr double difference = 0.02, // of logarithms, for the sensitivities
      largest_change            = 0.7;  // of logarithms, in one step
    const auto             entries  = parameters.fitted_entries();
    const auto             measured = parameters.measured_numbers();
    const auto             n        = entries.size();
    dealii::Vector<double> place(n), deviation(n);
    FullMatrix<double>     sensitivity(measured.size(), n);
    const auto misfit_at = [&](const dealii::Vector<double> &logarithms) {
      return misfit(fitted_values(values, logarithms));
    };
    const dealii::Vector<double> in_file = misfit_at(place);
    dealii::Vector<double>       here    = in_file;
    std::string verdict = "not found in this number of \"Iterations\"";
    for (unsigned int i = 0; i < parameters.max_iterations; ++i)
      {
        for (unsigned int j = 0; j < n; ++j)
          {
            dealii::Vector<double> beside = place;
            beside[j] += difference;
            const dealii::Vector<double> there = misfit_at(beside);
            for (unsigned int k = 0; k < measured.size(); ++k)
              sensitivity(k, j) = (there[k] - here[k]) / difference;
          }
        const CalibrationStep step(sensitivity,
                                   here,
                                   parameters.measurement_error);
        if (!step.determined)
          {
            verdict = "the measured numbers do not determine these entries";
            break;
          }
        deviation = step.deviation;
        if (step.change.linfty_norm() < parameters.calibration_accuracy)
          {
            verdict = "found";
            break;
          }
        // shortened until the misfit decreases
        double share = std::min(1., largest_change / step.change.linfty_norm());
        dealii::Vector<double> next, there;
        do
          {
            next = place;
            next.add(share, step.change);
            there = misfit_at(next);
            share *= 0.5;
          }
        while (!(there.l2_norm() < here.l2_norm()) &&
               share * step.change.linfty_norm() >
                 parameters.calibration_accuracy);
        if (!(there.l2_norm() < here.l2_norm()))
          {
            verdict = "found";
            break;
          }
        place = next;
        here  = there;
      }

    const StudyValues found = fitted_values(values, place);
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int k = 0; k < measured.size(); ++k)
        {
          const double           wanted = measured[k].second;
          nlohmann::ordered_json line   = nlohmann::ordered_json::object();
          for (const auto &[entry, value] : values)
            line[entry] = value;
          line["number"]      = entries[j];
          line["in the file"] = given_value(file, entries[j]);
          line["found"] = parse_number(found[values.size() + j].second).value();
          line["standard error [%]"]  = 100. * deviation[j];
          line["quantity"]            = measured[k].first.path;
          line["measured"]            = wanted;
          line["with the file"]       = wanted * std::exp(in_file[k]);
          line["with what was found"] = wanted * std::exp(here[k]);
          line["off by [%]"]          = 100. * std::expm1(here[k]);
          line["change over that of the number"] = sensitivity(k, j);
          line["verdict"]                        = verdict;
          calibrations.push_back(line);
        }
  }
} // namespace Voussoir
