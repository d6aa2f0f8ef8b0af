#include "csv_table.h"
#include "histories.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string folder = "intervals";


    std::string
    exactly(const double value)
    {
      std::ostringstream text;
      text.precision(17);
      text << value;
      return text.str();
    }


    /** Runs a case to its end with its files in the folder of these checks. */
    std::unique_ptr<Simulation>
    run_with_files(const Case &parameters, const MPI_Comm communicator)
    {
      auto simulation = make_simulation_with_files(parameters, communicator);
      simulation->run.march();
      return simulation;
    }


    /** The time step is fitted to the interval of the histories if that costs
     *  little; the lines of histories.csv are at equal intervals in any case.
     */
    class EqualIntervals : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double interval =
          std::stod(file.given("Output/histories/Interval"));
        const auto   free_case = make_case(file);
        const double limit =
          make_simulation(*free_case, communicator)->run.time_step.limit;
        const auto automatic = [&](const double steps) {
          return "Time/Safety factor=" + exactly(interval / steps / limit);
        };
        // steps of the interval before the fit and after it
        for (const auto &[wanted, fitted] :
             std::vector<std::array<double, 2>>{{{6.8, 7.}}, {{1.97, 2.}}})
          evaluate(file.with({automatic(wanted)}),
                   std::to_string(wanted).substr(0, 4) + " steps, fitted",
                   fitted,
                   interval,
                   communicator,
                   verdicts);
        // a fit would cost more than a tenth: every second step, each step
        for (const auto &[wanted, lines] :
             std::vector<std::array<double, 2>>{{{1.6, 2.}}, {{0.8, 1.}}})
          evaluate(file.with({automatic(wanted)}),
                   std::to_string(wanted).substr(0, 3) + " steps, not fitted",
                   wanted,
                   lines / wanted * interval,
                   communicator,
                   verdicts);
        // a given step is not changed
        evaluate(file.with({"Time/Time step=" + exactly(interval / 2.5)}),
                 "2.5 steps, given",
                 2.5,
                 3. / 2.5 * interval,
                 communicator,
                 verdicts);
      }

    private:
      static void
      evaluate(const ParameterFile &file,
               const std::string   &name,
               const double         steps,
               const double         between_lines,
               const MPI_Comm       communicator,
               Verdicts            &verdicts)
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        const auto   simulation = run_with_files(*parameters, communicator);
        const double interval =
          std::stod(file.given("Output/histories/Interval"));
        verdicts.near(name + ": interval over time step",
                      interval / simulation->run.time_step.length,
                      steps,
                      1e-9);

        const auto times =
          CsvTable(folder + "/histories.csv").numbers("time [s]");
        double smallest = 1e300, largest = 0.;
        for (std::size_t i = 1; i < times.size(); ++i)
          {
            keep_smallest(smallest, times[i] - times[i - 1]);
            keep_largest(largest, times[i] - times[i - 1]);
          }
        verdicts.near(name + ": smallest time between two lines",
                      1e3 * smallest,
                      1e3 * between_lines,
                      1e-9,
                      "ms");
        verdicts.near(name + ": largest time between two lines",
                      1e3 * largest,
                      1e3 * between_lines,
                      1e-9,
                      "ms");
        verdicts.is_true(name + ": lines from the start to the end",
                         times.front() == 0. &&
                           times.back() >=
                             parameters->time.end_time - between_lines - 1e-9);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<EqualIntervals>
      registered("equal intervals", "Of the lines of histories.csv.");


    /**
     * The filtered acceleration is the mean over T = 0.443/f, which leaves the
     * part sin(pi f0 T)/(pi f0 T) of a sine of frequency f0: for a block that
     * is moved, and for the ground under a rigid base.
     */
    class FilteredAcceleration : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Frequencies",
                          frequencies,
                          "Frequencies of the motion [Hz].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double f : frequencies)
          {
            const std::string frequency = exactly(f);
            compare("ground, " + frequency + " Hz",
                    file.with({"Ground motion/Sine/Frequency=" + frequency}),
                    f,
                    communicator,
                    verdicts);
            compare("block, " + frequency + " Hz",
                    file.with({"Ground motion/Type=none",
                               "Boundaries/Fixed=",
                               "Constraints/Names=block",
                               "Constraints/block/Face sets=bottom, top",
                               "Constraints/block/Displacement=0.01, 0, 0",
                               "Constraints/block/Time function=1-cos(2*pi*" +
                                 frequency + "*t)"}),
                    f,
                    communicator,
                    verdicts);
          }

        // without a frequency: S waves with eight nodes per wavelength
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder,
                               "Output/histories/Filter frequency=0",
                               "Time/End time=0.1"}));
        const auto simulation = run_with_files(*parameters, communicator);
        const auto rock =
          simulation->model.solid.materials[0]->elastic_constants();
        const double  longest_edge = 10.;
        std::ifstream in(folder + "/summary.json");
        verdicts.near("filtered at, by the mesh",
                      nlohmann::json::parse(in)
                        .at("histories")
                        .at("base")
                        .at("filtered at [Hz]"),
                      std::sqrt(rock.young_modulus /
                                (2. * (1. + rock.poisson_ratio)) /
                                rock.density) /
                        (8. * longest_edge),
                      1e-12,
                      "Hz");
      }

    private:
      static void
      compare(const std::string   &name,
              const ParameterFile &file,
              const double         f,
              const MPI_Comm       communicator,
              Verdicts            &verdicts)
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        const auto     simulation = run_with_files(*parameters, communicator);
        const CsvTable table(folder + "/histories.csv");
        const auto     times     = table.numbers("time [s]");
        const auto     amplitude = [&](const std::string &quantity) {
          // whole periods, after the start has left the window
          const double half = 0.5 * simulation->run.time_step.length;
          return std::abs(
            fourier_sum(times,
                        table.numbers("base " + quantity + " x [m/s2]"),
                        f,
                        0.2 - half,
                        1.2 - half));
        };
        const double step = simulation->run.time_step.length;
        const double given =
          std::stod(file.given("Output/histories/Filter frequency"));
        const double x =
          numbers::PI * f * step * std::round(0.443 / given / step);
        verdicts.near(name + ": filtered over raw acceleration",
                      amplitude("filtered acceleration") /
                        amplitude("acceleration"),
                      std::abs(std::sin(x) / x),
                      0.002);
      }

      std::vector<double> frequencies;
    };

    // Reference: closed form
    const Registry<Check>::Add<FilteredAcceleration>
      registered_filter("filtered acceleration", "Of a sine.");
  } // namespace
} // namespace Voussoir
