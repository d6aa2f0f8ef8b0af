#include <filesystem>

#include "check.h"
#include "folders.h"
#include "quiet_options.h"
#include "same.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A run that continues while a crack closes equals the uninterrupted run,
     * bit for bit, its energies included.
     */
    class RestartCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"straight", "in_two"}, communicator);

        const double closing = time_of_closing(file, communicator);
        const auto   whole =
          make_case(with(file, "straight", closing, 2.5 * closing));
        Simulation straight(*whole, quiet_options(false), communicator);
        straight.run.march();

        const auto first =
          make_case(with(file, "in_two", closing, 1.5 * closing));
        Simulation(*first, quiet_options(false), communicator).run.march();
        const auto second =
          make_case(with(file, "in_two", closing, 2.5 * closing));
        Simulation going_on(*second, quiet_options(true), communicator);
        verdicts.near(
          "continues from the time at which the crack closes, over it",
          going_on.run.state.time / closing,
          1.,
          0.01);
        verdicts.is_true("where an impact acts",
                         largest_impact(going_on.run, communicator) > 0.);
        going_on.run.march();

        Run &a = straight.run, &b = going_on.run;
        verdicts.is_true("same displacement, bit for bit",
                         same(a.state.displacement, b.state.displacement));
        verdicts.is_true("same velocity, bit for bit",
                         same(a.state.velocity, b.state.velocity));
        for (unsigned int i = 0; i < a.state.memory.size(); ++i)
          verdicts.is_true("same damping memory, bit for bit",
                           same(a.state.memory[i], b.state.memory[i]));
        for (unsigned int m = 0; m < straight.model.solid.materials.size(); ++m)
          if (PointHistory *history = a.state.material_memory.of(m))
            verdicts.is_true(
              "same memory of the points, bit for bit",
              same(history->checkpoint_values(),
                   b.state.material_memory.of(m)->checkpoint_values(),
                   communicator));
        const nlohmann::json of_a = a.energy.summary(),
                             of_b = b.energy.summary();
        verdicts.above("energies compared", of_a.size(), 12.);
        for (const auto &[name, value] : of_a.items())
          verdicts.is_true("same " + name + ", bit for bit",
                           value == of_b.at(name) && value.is_number());
        verdicts.above("lost in cracks over the work",
                       double(of_a["lost to cracks and plastic flow [J]"]) /
                         double(of_a["work of constraints [J]"]),
                       0.05);
        verdicts.above("lost by cracks that closed over the work",
                       double(of_a["lost by cracks that closed [J]"]) /
                         double(of_a["work of constraints [J]"]),
                       1e-6);
        verdicts.is_true("same energy.csv",
                         text_of("straight/energy.csv") ==
                             text_of("in_two/energy.csv") &&
                           text_of("straight/energy.csv").size() > 1000);
      }

    private:
      static ParameterFile
      with(const ParameterFile &file,
           const std::string   &folder,
           const double         checkpoint,
           const double         end)
      {
        std::ostringstream every, last;
        every << std::setprecision(17) << checkpoint;
        last << std::setprecision(17) << end;
        return file.with({"Output/Folder=" + folder,
                          "Output/Checkpoint time=" + every.str(),
                          "Time/End time=" + last.str()});
      }


      /** [Pa] */
      static double
      largest_impact(const Run &run, const MPI_Comm communicator)
      {
        double largest = 0.;
        for (unsigned int m = 0; m < run.model.solid.materials.size(); ++m)
          if (const PointHistory *history = run.state.material_memory.of(m))
            for (const auto &[cell, place] : history->cells())
              for (unsigned int q = 0; q < history->n_points(); ++q)
                if (history->is_active(place.batch, q))
                  keep_largest(largest,
                               std::abs(history->active_point(place.batch, q)
                                          .impact[place.lane]));
        return Utilities::MPI::max(largest, communicator);
      }


      /** Time of the largest impact of a closing crack [s]. */
      static double
      time_of_closing(const ParameterFile &file, const MPI_Comm communicator)
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        Run       &run        = simulation->run;
        double     largest = 0., time = 0.;
        while (run.state.step < run.n_steps())
          {
            run.scheme.step(run.state);
            const double now = largest_impact(run, communicator);
            if (now > largest)
              {
                largest = now;
                time    = run.state.time;
              }
          }
        return time;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<RestartCrack>
      registered("restart crack", "On from the middle of a crack that closes.");
  } // namespace
} // namespace Voussoir
