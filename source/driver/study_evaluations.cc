#include <voussoir/base/parse_numbers.h>
#include <voussoir/driver/convergence.h>
#include <voussoir/driver/fragility.h>
#include <voussoir/driver/study.h>

#include <cmath>

namespace Voussoir
{
  namespace
  {
    /** The first columns of a line: values of entries. */
    nlohmann::ordered_json
    line_of(const StudyValues &values)
    {
      auto line = nlohmann::ordered_json::object();
      for (const auto &[entry, value] : values)
        line[entry] = value;
      return line;
    }


    /** The value, or null for none. */
    nlohmann::ordered_json
    or_null(const std::optional<double> &number)
    {
      return number ? nlohmann::ordered_json(*number) :
                      nlohmann::ordered_json();
    }


    void
    add_bounded(nlohmann::ordered_json               &line,
                const std::string                    &name,
                const std::optional<BoundedEstimate> &estimate)
    {
      for (const auto &[column, number] :
           {std::pair(name, &BoundedEstimate::value),
            std::pair(name + " from", &BoundedEstimate::lower),
            std::pair(name + " to", &BoundedEstimate::upper)})
        line[column] =
          estimate ? or_null((*estimate).*number) : nlohmann::ordered_json();
    }


    bool
    is_complete(const RunSummary &summary)
    {
      return summary.end == RunEnd::complete && summary.model && summary.step;
    }
  } // namespace


  Study::Table
  Study::convergence() const
  {
    Table lines;
    if (parameters.refined.empty())
      return lines;
    for (const auto &group : grouped(outcomes, parameters.refined_entries()))
      {
        std::vector<const Outcome *> runs;
        for (const Outcome *run : group.runs)
          if (is_complete(run->summary))
            runs.push_back(run);
        const bool same_cells =
          std::all_of(runs.begin(), runs.end(), [&](const Outcome *run) {
            return run->summary.model->n_cells ==
                   runs[0]->summary.model->n_cells;
          });
        const auto size_of = [&](const Outcome &run) {
          return same_cells ? run.summary.step->length :
                              std::pow(double(run.summary.model->n_cells),
                                       -1. / parameters.dimensions);
        };
        for (const SummaryNumber &number : parameters.numbers())
          {
            std::vector<std::pair<double, double>> points; // size and number
            for (const Outcome *run : runs)
              if (const std::optional<double> value = number.in(run->numbers))
                points.emplace_back(size_of(*run), *value);
            if (points.size() < 3)
              continue;
            std::sort(points.begin(), points.end());
            const ThreeSizes sizes{
              {points[2].first, points[1].first, points[0].first}},
              values{{points[2].second, points[1].second, points[0].second}};
            const Convergence found(sizes, values, parameters.method_order);
            nlohmann::ordered_json line     = line_of(group.others);
            line["quantity"]                = number.path;
            line["coarse"]                  = values[0];
            line["middle"]                  = values[1];
            line["fine"]                    = values[2];
            line["coarse over middle"]      = sizes[0] / sizes[1];
            line["middle over fine"]        = sizes[1] / sizes[2];
            line["observed order"]          = or_null(found.order);
            line["extrapolated"]            = or_null(found.limit);
            line["band about the fine one"] = or_null(found.band);
            line["verdict"]                 = found.verdict;
            lines.push_back(line);
          }
      }
    return lines;
  }


  Study::Table
  Study::fragility() const
  {
    Table lines;
    if (parameters.intensity.empty())
      return lines;
    for (const auto &group : grouped(outcomes, parameters.fragility_entries()))
      {
        std::map<double, IntensityLevel> by_intensity;
        for (const Outcome *run : group.runs)
          if (const auto met =
                met_criteria(parameters.fragility_criteria(), run->summary))
            for (const auto &[entry, value] : run->values)
              if (entry == parameters.intensity)
                {
                  const double    intensity = parse_number(value).value();
                  IntensityLevel &level     = by_intensity[intensity];
                  level.intensity           = intensity;
                  ++level.n_runs;
                  level.n_met += !met->empty();
                }
        if (by_intensity.empty())
          continue;
        std::vector<IntensityLevel> levels;
        for (const auto &item : by_intensity)
          levels.push_back(item.second);
        const FragilityCurve curve(levels, parameters.confidence);
        for (const IntensityLevel &level : levels)
          {
            nlohmann::ordered_json line = line_of(group.others);
            line["intensity"]           = level.intensity;
            line["runs"]                = level.n_runs;
            line["criterion met"]       = level.n_met;
            line["probability"] =
              curve.median ? or_null(curve.probability(level.intensity)) :
                             nlohmann::ordered_json();
            add_bounded(line, "median", curve.median);
            add_bounded(line, "dispersion", curve.dispersion);
            line["verdict"] = curve.verdict;
            lines.push_back(line);
          }
      }
    return lines;
  }


  Study::Table
  Study::sensitivities() const
  {
    Table lines;
    if (!parameters.moves_numbers())
      return lines;
    std::map<StudyValues, const Outcome *> run_of;
    for (const Outcome &outcome : outcomes)
      if (is_complete(outcome.summary))
        run_of[outcome.values] = &outcome;
    if (run_of.count({}) == 0)
      return lines;
    const Outcome               &as_given = *run_of.at({});
    std::vector<const Outcome *> run_of_move;
    for (const MovedNumber &move : moves)
      run_of_move.push_back(run_of[{{move.entry, move.text}}]);
    for (const SummaryNumber &number : parameters.numbers())
      {
        const std::optional<double> value = number.in(as_given.numbers);
        if (!value)
          continue;
        // moves of one number follow each other
        for (auto move = moves.begin(); move != moves.end();)
          {
            const auto                             first = move;
            std::vector<std::pair<double, double>> points;
            std::array<std::optional<double>, 2>   moved; // down and up
            for (; move != moves.end() && move->name == first->name; ++move)
              if (const Outcome *run = run_of_move[move - moves.begin()])
                if (const auto there = number.in(run->numbers))
                  {
                    points.emplace_back(move->change, *there);
                    moved[move->change > 0.] = there;
                  }
            if (points.empty()) // its runs failed
              continue;
            const Sensitivity      found(*value, points);
            nlohmann::ordered_json line;
            line["number"]             = first->name;
            line["value"]              = first->value;
            line["quantity"]           = number.path;
            line["as given"]           = *value;
            line["moved down"]         = or_null(moved[0]);
            line["moved up"]           = or_null(moved[1]);
            line["largest change [%]"] = 100. * found.largest_change;
            line["change over that of the number"] = found.per_change;
            lines.push_back(line);
          }
      }
    std::stable_sort(lines.begin(),
                     lines.end(),
                     [](const auto &one, const auto &other) {
                       return one.at("largest change [%]") >
                              other.at("largest change [%]");
                     });
    return lines;
  }
} // namespace Voussoir
