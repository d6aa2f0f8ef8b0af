#include <voussoir/base/error.h>
#include <voussoir/loads/ground_motion.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  std::optional<double>
  GroundMotion::peak_acceleration(const unsigned int component) const
  {
    const std::string &entry = peak_entries[component];
    if (entry == as_recorded)
      return {};
    if (!dealii::Patterns::Double(0., 10.).match(entry))
      throw UserError("\"Peak acceleration " + axis_names[component] +
                      "\" in section \"Ground motion\" cannot be \"" + entry +
                      "\"; it must be a number from 0 to 10 [g], or \"" +
                      as_recorded + "\".");
    return dealii::Utilities::string_to_double(entry);
  }


  bool
  GroundMotion::has_record(const unsigned int component) const
  {
    return type == GroundMotionType::record && !record.files[component].empty();
  }


  bool
  GroundMotion::moves(const unsigned int component) const
  {
    const std::optional<double> peak = peak_acceleration(component);
    return type == GroundMotionType::record ?
             has_record(component) && peak != 0. :
             type != GroundMotionType::none && peak.value_or(0.) > 0.;
  }


  double
  GroundMotion::sign(const unsigned int component) const
  {
    return reversed.find(axis_names[component]) == std::string::npos ? 1. : -1.;
  }


  namespace
  {
    std::unique_ptr<Signal>
    scaled(TimeSeries acceleration, const double factor)
    {
      for (double &value : acceleration.values)
        value *= factor;
      return std::make_unique<Tabulated>(acceleration);
    }

    /** The corrected record of one component. */
    TimeSeries
    read_component(const GroundMotion::Record &record,
                   const unsigned int          component,
                   const std::string          &folder)
    {
      // An absolute path replaces the folder.
      const std::string file =
        (std::filesystem::path(folder) / record.files[component]).string();
      TimeSeries whole;
      try
        {
          whole = read_record(
            file, {record.unit, record.time_step, record.columns[component]});
        }
      catch (const UserError &error)
        {
          throw UserError(
            "\"File " + GroundMotion::axis_names[component] +
            "\" in section \"Ground motion/Record\": " + error.what());
        }

      const auto largest = std::max_element(whole.values.begin(),
                                            whole.values.end(),
                                            [](const double a, const double b) {
                                              return std::abs(a) < std::abs(b);
                                            });
      if (std::abs(*largest) > 1e6 * standard_gravity)
        {
          std::ostringstream text;
          text << "\"File " << GroundMotion::axis_names[component]
               << "\" in section \"Ground motion/Record\": the record '" << file
               << "' has an acceleration of " << *largest << " m/s2 at "
               << whole.time_step * (largest - whole.values.begin())
               << " s; repair it, or choose another \"Unit\".";
          throw UserError(text.str());
        }

      const TimeSeries part =
        time_window(whole, record.start_time, record.duration);
      if (part.values.size() < 2)
        throw UserError(
          "\"Start time\" and \"Duration\" in section \"Ground motion/Record\" "
          "leave no motion of the record '" +
          file + "', which lasts " +
          std::to_string(whole.time_step * (whole.values.size() - 1.)) +
          " s; choose an earlier start or a longer duration.");

      return {part.time_step, record.baseline.apply(part).acceleration};
    }

    void
    check_it_moves(const double peak, const unsigned int component)
    {
      if (peak == 0)
        throw UserError("\"Peak acceleration " +
                        GroundMotion::axis_names[component] +
                        "\" in section \"Ground motion\" cannot be reached, "
                        "because the part of the record that is used is zero "
                        "throughout; choose another file or time window.");
    }
  } // namespace


  GroundMotionSignals
  GroundMotion::build_matched(const std::string        &folder,
                              std::vector<SpectrumFit> *fits) const
  {
    std::vector<TimeSeries>  records;
    std::vector<SpectrumFit> components;
    for (unsigned int c = 0; c < 3; ++c)
      if (moves(c))
        {
          records.push_back(read_component(record, c, folder));
          check_it_moves(peak(records.back().values), c);
          SpectrumFit &fit = components.emplace_back();
          fit.component    = c;
          fit.periods      = match.periods();
          for (const double period : fit.periods)
            fit.target.push_back(standard_gravity * *peak_acceleration(c) *
                                 spectrum.target(c).amplification(period));
        }
    fit_to_spectrum(records, match, spectrum.damping_ratio, components);
    GroundMotionSignals signals;
    for (SpectrumFit &fit : components)
      {
        fit.multiply(overload_factor);
        for (double &value : fit.acceleration.values)
          value *= sign(fit.component);
        signals[fit.component] = std::make_unique<Tabulated>(fit.acceleration);
      }
    if (fits != nullptr)
      *fits = std::move(components);
    return signals;
  }


  GroundMotionSignals
  GroundMotion::build(const std::string        &folder,
                      std::vector<SpectrumFit> *fits) const
  {
    if (type == GroundMotionType::record && match.wanted())
      return build_matched(folder, fits);

    std::array<TimeSeries, 3> artificial;
    if (type == GroundMotionType::spectrum)
      artificial = spectrum.generate();

    GroundMotionSignals signals;
    for (unsigned int c = 0; c < 3; ++c)
      {
        if (!moves(c))
          continue;

        const std::optional<double> own    = peak_acceleration(c);
        const double                factor = sign(c) * overload_factor;
        const double largest = factor * standard_gravity * own.value_or(0.);
        if (type == GroundMotionType::record)
          {
            const TimeSeries motion    = read_component(record, c, folder);
            const double     unchanged = peak(motion.values);
            if (own)
              check_it_moves(unchanged, c);
            signals[c] = scaled(motion, own ? largest / unchanged : factor);
          }
        else if (type == GroundMotionType::ricker)
          signals[c] =
            std::make_unique<Voussoir::Ricker>(ricker.quantity,
                                               ricker.frequency,
                                               ricker.middle > 0 ?
                                                 ricker.middle :
                                                 1.5 / ricker.frequency,
                                               largest);
        else if (type == GroundMotionType::sine)
          signals[c] = std::make_unique<Voussoir::Sine>(sine.frequency,
                                                        largest,
                                                        sine.cycles,
                                                        sine.ramp_cycles);
        else if (type == GroundMotionType::pulse)
          signals[c] = std::make_unique<Voussoir::Pulse>(pulse.quantity,
                                                         pulse.duration,
                                                         largest);
        else
          signals[c] = scaled(artificial[c], largest);
      }
    return signals;
  }


  namespace
  {
    /** The motion at constant time step from 0 to @p end_time. */
    Motion
    sample(const Signal &signal, const double time_step, const double end_time)
    {
      Motion            motion{time_step, {}, {}, {}};
      const std::size_t n_steps = std::round(end_time / time_step);
      for (std::size_t i = 0; i <= n_steps; ++i)
        {
          motion.acceleration.push_back(signal.acceleration(i * time_step));
          motion.velocity.push_back(signal.velocity(i * time_step));
          motion.displacement.push_back(signal.displacement(i * time_step));
        }
      return motion;
    }

    /** The value to four decimals, never a negative zero. */
    double
    rounded(const double value)
    {
      return std::round(value * 1e4) / 1e4 + 0.;
    }
  } // namespace


  std::string
  GroundMotion::summary(const GroundMotionSignals &signals,
                        const double               end_time) const
  {
    constexpr double resolution = 1e-3;

    std::ostringstream text;
    text << std::fixed << std::setprecision(4);
    for (unsigned int c = 0; c < 3; ++c)
      if (signals[c])
        {
          const Motion motion = sample(*signals[c], resolution, end_time);
          text << "Ground motion " << axis_names[c] << " (" << axis_meanings[c]
               << "): peak acceleration "
               << peak(motion.acceleration) / standard_gravity
               << " g, velocity " << peak(motion.velocity)
               << " m/s, displacement " << peak(motion.displacement)
               << " m; at the end velocity " << rounded(motion.velocity.back())
               << " m/s, displacement " << rounded(motion.displacement.back())
               << " m\n";
        }
    if (type != GroundMotionType::spectrum)
      return text.str();

    for (unsigned int c = 0; c < 3; ++c)
      {
        if (!signals[c])
          continue;
        const std::vector<double> a =
          sample(*signals[c], spectrum.time_step, spectrum.duration)
            .acceleration;
        text << "Ground motion " << axis_names[c]
             << ": mean deviation from the design spectrum "
             << 100. * spectrum.mean_deviation({spectrum.time_step, a},
                                               peak(a),
                                               spectrum.target(c))
             << " %\n";
        for (unsigned int d = 0; d < c; ++d)
          if (signals[d])
            text << "Ground motion " << axis_names[d] << " and "
                 << axis_names[c] << ": correlation "
                 << correlation(a,
                                sample(*signals[d],
                                       spectrum.time_step,
                                       spectrum.duration)
                                  .acceleration)
                 << "\n";
      }
    return text.str();
  }
} // namespace Voussoir
