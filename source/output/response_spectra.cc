#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/files/table.h>
#include <voussoir/output/point_recorder.h>
#include <voussoir/signals/response_spectrum.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string spectra_section = "Output/response spectra";


    /** Response spectra of the absolute acceleration of chosen points. */
    class ResponseSpectra : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        recorder.declare_parameters(
          prm,
          "Name of the point whose largest acceleration is the reference of "
          "the amplification in summary.json; empty for none.");
        prm.add_parameter("Components",
                          components,
                          "Directions of motion.",
                          Patterns::MultipleSelection("x|y|z"));
        prm.add_parameter("Damping ratio",
                          damping_ratio,
                          "Damping ratio of the oscillators [-].",
                          Patterns::Double(0., 0.99));
        prm.add_parameter("Shortest period",
                          shortest,
                          "Shortest period of the oscillators [s].",
                          Patterns::Double(1e-3));
        prm.add_parameter("Longest period",
                          longest,
                          "Longest period of the oscillators [s].",
                          Patterns::Double(1e-3));
        prm.add_parameter("Number of periods",
                          n_periods,
                          "Number of periods, at constant ratio [-].",
                          Patterns::Integer(2));
        prm.add_parameter("Interval",
                          interval,
                          "Time between two samples of the acceleration [s]; "
                          "rounded to a whole number of steps, at least one, "
                          "and to no more than a twentieth of the shortest "
                          "period that the mesh carries with eight nodes per "
                          "wavelength.",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &model) const override
      {
        const std::string place = "in section \"" + spectra_section + "\" ";
        if (longest <= shortest)
          throw UserError("\"Longest period\" " + place +
                          "must be longer than the \"Shortest period\".");
        if (recorder.check(model) == 0)
          throw UserError("\"Points\" " + place +
                          "is empty; name at least one point.");
      }

      void
      observe(const State &state) override
      {
        recorder.observe(state);
        if (recorder.n_waiting() >= 1000)
          flush();
      }

    private:
      void
      prepare() override
      {
        sample_step = run().time_step *
                      std::max(1.,
                               std::floor(run().sampling_interval(interval) /
                                            run().time_step +
                                          1e-9));
        recorder.prepare(run(), sample_step);
        directions.clear();
        for (const std::string &component : split_list(components))
          directions.push_back(component[0] - 'x');
        keep("accelerations",
             accelerations,
             std::vector<std::vector<double>>(recorder.points().size() *
                                              directions.size()));
      }

      void
      conclude(const State &, nlohmann::json &summary) override
      {
        const auto periods = logarithmic_grid(shortest, longest, n_periods);
        std::vector<std::string>         titles{"period [s]"};
        std::vector<std::vector<double>> columns{periods};
        for (unsigned int p = 0; p < recorder.points().size(); ++p)
          for (unsigned int i = 0; i < directions.size(); ++i)
            {
              const std::string &name      = recorder.points()[p].name;
              const char         component = "xyz"[directions[i]];
              columns.push_back(response_spectrum({sample_step, record(p, i)},
                                                  periods,
                                                  damping_ratio)
                                  .pseudo_acceleration);
              titles.push_back(name + ' ' + component + " [m/s2]");
              describe(
                p,
                i,
                periods,
                columns.back(),
                summary["response spectra"][name][std::string(1, component)]);
            }
        write(titles, columns);
      }

      void
      flush() override
      {
        for (const auto &line : recorder.take())
          for (unsigned int p = 0; p < line.points.size(); ++p)
            for (unsigned int i = 0; i < directions.size(); ++i)
              accelerations[p * directions.size() + i].push_back(
                line.points[p][2][directions[i]]);
      }

      /** Acceleration of a point in one of the chosen directions [m/s2]. */
      const std::vector<double> &
      record(const unsigned int point, const unsigned int direction) const
      {
        return accelerations[point * directions.size() + direction];
      }

      /** Adds a spectrum to the summary. */
      void
      describe(const unsigned int         point,
               const unsigned int         direction,
               const std::vector<double> &periods,
               const std::vector<double> &spectrum,
               nlohmann::json            &entry) const
      {
        const double largest = peak(record(point, direction));
        const auto highest = std::max_element(spectrum.begin(), spectrum.end());
        entry["peak acceleration [m/s2]"]      = largest;
        entry["largest spectral value [m/s2]"] = *highest;
        entry["at period [s]"] = periods[highest - spectrum.begin()];
        if (recorder.reference() >= 0)
          {
            const double base = peak(record(recorder.reference(), direction));
            if (base > 0.)
              entry["amplification of the peak"] = largest / base;
          }
      }

      void
      write(const std::vector<std::string>         &titles,
            const std::vector<std::vector<double>> &columns) const
      {
        if (Utilities::MPI::this_mpi_process(communicator()) != 0)
          return;
        const std::string file = run().folder + "/response_spectra.csv";
        run().log.attempted(file,
                            write_file(file, csv_of_columns(titles, columns)));
      }

      std::string  components    = "x, y, z";
      double       damping_ratio = 0.05;
      double       shortest = 0.02, longest = 4.;
      unsigned int n_periods = 100;
      double       interval  = 0.005;

      PointRecorder recorder{spectra_section, "Reference"};

      std::vector<unsigned int>        directions;
      double                           sample_step = 0.; // [s]
      std::vector<std::vector<double>> accelerations;    // by point, direction
    };

    const Registry<Observer>::Add<ResponseSpectra> registered_response_spectra(
      "response spectra",
      "Pseudo-acceleration response spectra of chosen points, in "
      "response_spectra.csv, and their amplification.");
  } // namespace
} // namespace Voussoir
