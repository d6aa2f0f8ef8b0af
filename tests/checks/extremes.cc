#include <voussoir/base/error.h>

#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The numbers of the summary do not depend on the interval of lines: the
     * largest motion of a block that moves by a (1 - cos(2 pi f t)) is 2 a,
     * 2 pi f a and (2 pi f)^2 a at every interval, and the results of observers
     * are the same at all intervals.
     */
    class Extremes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Amplitude", amplitude, "Half the distance [m].");
        prm.add_parameter("Frequency",
                          frequency,
                          "Frequency of the motion [Hz].");
        prm.add_parameter("Intervals", intervals, "Of lines [s].");
        prm.add_parameter("Observers", observers, "With such an interval.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        std::vector<nlohmann::json> summaries;
        for (const std::string &interval : split_list(intervals))
          {
            const std::string        folder = "every_" + interval;
            std::vector<std::string> changes{"Output/Folder=" + folder};
            for (const std::string &observer : split_list(observers))
              changes.push_back("Output/" + observer + "/Interval=" + interval);
            const auto parameters = make_case(file.with(changes));
            make_simulation_with_files(*parameters, communicator)->run.march();
            MPI_Barrier(communicator);
            summaries.push_back(read_summary(folder));
            if (amplitude > 0.)
              compare_motion(summaries.back(),
                             "every " + interval + " s",
                             verdicts);
          }
        for (const std::string &observer : split_list(observers))
          for (std::size_t i = 1; i < summaries.size(); ++i)
            compare(observer,
                    summaries[0],
                    summaries[i],
                    "every " + split_list(intervals)[i] + " s",
                    verdicts);
      }

    private:
      void
      compare_motion(const nlohmann::json &summary,
                     const std::string    &name,
                     Verdicts             &verdicts) const
      {
        const double omega = 2. * numbers::PI * frequency;
        const auto  &top   = summary.at("histories").at("top");
        verdicts.near(name + ", largest displacement",
                      top.at("largest displacement [m]"),
                      2. * amplitude,
                      1e-4,
                      "m");
        verdicts.near(name + ", largest velocity",
                      top.at("largest velocity [m/s]"),
                      omega * amplitude,
                      1e-4,
                      "m/s");
        verdicts.near(name + ", largest acceleration",
                      top.at("largest acceleration of a single step [m/s2]"),
                      omega * omega * amplitude,
                      1e-3,
                      "m/s2");
      }

      /** All numbers that an observer finds largest or smallest. */
      static void
      compare(const std::string    &observer,
              const nlohmann::json &fine,
              const nlohmann::json &coarse,
              const std::string    &name,
              Verdicts             &verdicts)
      {
        const auto a = fine.at(observer).flatten(),
                   b = coarse.at(observer).flatten();
        std::vector<std::array<double, 2>> pairs;
        double                             scale = 0.;
        for (const auto &[path, value] : a.items())
          if (value.is_number() && (path.find("largest") != std::string::npos ||
                                    path.find("smallest") != std::string::npos))
            {
              pairs.push_back({{value, b.at(path)}});
              keep_largest(scale, std::abs(pairs.back()[0]));
            }
        // numbers below this share of the largest are round-off of zero
        double worst = 0.;
        for (const auto &[x, y] : pairs)
          keep_largest(worst,
                       std::abs(x - y) / std::max(std::abs(x), 1e-12 * scale));
        verdicts.is_true(observer + ": there are numbers to compare",
                         !pairs.empty());
        verdicts.below(observer + ", " + name +
                         ": farthest from the finest lines (%)",
                       100. * worst,
                       2.);
      }

      double      amplitude = 0., frequency = 0.;
      std::string intervals = "0.002, 0.2", observers;
    };

    // Reference: closed form
    const Registry<Check>::Add<Extremes>
      registered("extremes", "Of motions and forces at several intervals.");
  } // namespace
} // namespace Voussoir
