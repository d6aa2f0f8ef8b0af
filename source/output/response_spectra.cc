#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/loads/response_spectrum.h>
#include <voussoir/output/point_recorder.h>

#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string section = "in section \"Output/response spectra\"";
    const std::string place   = "\"Points\" " + section;
    const std::string reference_place = "\"Reference\" " + section;

    /** Response spectra of the absolute acceleration of chosen points. */
    class ResponseSpectra : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points",
                          points_text,
                          "Named points \"name: x y z\" [m], separated by "
                          "\";\".");
        prm.add_parameter("Components",
                          components,
                          "Directions of motion.",
                          Patterns::MultipleSelection("x|y|z"));
        prm.add_parameter("Reference",
                          reference_name,
                          "Name of the point whose largest acceleration the "
                          "amplification in the summary is relative to; empty "
                          "for none.");
        prm.add_parameter("Damping ratio",
                          damping_ratio,
                          "Of the oscillators [-].",
                          Patterns::Double(0., 0.99));
        prm.add_parameter("Shortest period",
                          shortest,
                          "Of the oscillators [s].",
                          Patterns::Double(1e-3));
        prm.add_parameter("Longest period",
                          longest,
                          "Of the oscillators [s].",
                          Patterns::Double(1e-3));
        prm.add_parameter("Number of periods",
                          n_periods,
                          "At constant ratio [-].",
                          Patterns::Integer(2));
        prm.add_parameter("Interval",
                          interval,
                          "Time between two samples of the acceleration [s]; a "
                          "whole number of steps is taken, at least one.",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &model) const override
      {
        if (longest <= shortest)
          throw UserError("\"Longest period\" " + section +
                          " must be longer than the \"Shortest period\".");
        const auto parsed = parse_points(points_text, place);
        if (parsed.empty())
          throw UserError(place + " is empty; name at least one point.");
        find_point(reference_name, parsed, reference_place);
        PointWeights(model.discretization, parsed, place);
      }

      void
      prepare(const ObservedModel &model, const double, const bool) override
      {
        folder       = model.folder;
        communicator = model.discretization.grid.communicator();
        points       = parse_points(points_text, place);
        reference    = find_point(reference_name, points, reference_place);
        sample_step =
          model.time_step *
          std::max(1., std::floor(interval / model.time_step + 1e-9));
        recorder =
          std::make_unique<PointRecorder>(model, points, place, sample_step);
        for (const std::string &component : split_list(components))
          directions.push_back(component[0] - 'x');
        accelerations.resize(points.size() * directions.size());
      }

      void
      observe(const State &state) override
      {
        recorder->observe(state);
        if (recorder->n_waiting() >= 1000)
          collect();
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        collect();
        const auto periods = logarithmic_grid(shortest, longest, n_periods);
        std::vector<ResponseSpectrum> spectra;
        auto                         &result = summary["response spectra"];
        for (unsigned int p = 0; p < points.size(); ++p)
          for (unsigned int i = 0; i < directions.size(); ++i)
            {
              const auto &record = accelerations[p * directions.size() + i];
              spectra.push_back(response_spectrum({sample_step, record},
                                                  periods,
                                                  damping_ratio));
              const auto &values = spectra.back().pseudo_acceleration;
              const auto  highest =
                std::max_element(values.begin(), values.end());
              auto &entry =
                result[points[p].name][std::string(1, "xyz"[directions[i]])];
              entry["peak acceleration [m/s2]"]      = peak(record);
              entry["largest spectral value [m/s2]"] = *highest;
              entry["at period [s]"] = periods[highest - values.begin()];
              if (reference >= 0)
                {
                  const double base =
                    peak(accelerations[reference * directions.size() + i]);
                  if (base > 0.)
                    entry["amplification of the peak"] = peak(record) / base;
                }
            }
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          write(periods, spectra);
      }

      nlohmann::json
      save() override
      {
        collect();
        return accelerations;
      }

      void
      load(const nlohmann::json &saved) override
      {
        if (saved.size() == accelerations.size())
          saved.get_to(accelerations);
      }

    private:
      void
      collect()
      {
        for (const auto &line : recorder->take())
          for (unsigned int p = 0; p < points.size(); ++p)
            for (unsigned int i = 0; i < directions.size(); ++i)
              accelerations[p * directions.size() + i].push_back(
                line.points[p][2][directions[i]]);
      }

      void
      write(const std::vector<double>           &periods,
            const std::vector<ResponseSpectrum> &spectra) const
      {
        std::ofstream file(folder + "/response_spectra.csv");
        file << std::setprecision(9) << "period [s]";
        for (const NamedPoint &point : points)
          for (const unsigned int d : directions)
            file << ',' << point.name << ' ' << "xyz"[d] << " [m/s2]";
        file << '\n';
        for (unsigned int i = 0; i < periods.size(); ++i)
          {
            file << periods[i];
            for (const ResponseSpectrum &spectrum : spectra)
              file << ',' << spectrum.pseudo_acceleration[i];
            file << '\n';
          }
      }

      std::string  points_text, reference_name;
      std::string  components    = "x, y, z";
      double       damping_ratio = 0.05;
      double       shortest = 0.02, longest = 4.;
      unsigned int n_periods = 100;
      double       interval  = 0.005;

      std::string                      folder;
      MPI_Comm                         communicator;
      std::vector<NamedPoint>          points;
      std::vector<unsigned int>        directions;
      int                              reference = -1; // none
      std::unique_ptr<PointRecorder>   recorder;
      double                           sample_step = 0.;
      std::vector<std::vector<double>> accelerations; // by point, direction
    };

    const Registry<Observer>::Add<ResponseSpectra>
      registered("response spectra",
                 "Pseudo-acceleration response spectra of chosen points, in "
                 "response_spectra.csv, and their amplification.");
  } // namespace
} // namespace Voussoir
