#include <voussoir/base/error.h>

#include <filesystem>

#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A run whose energy balance is violated reports it: a jump of velocity in
     * the middle adds energy that no term contains, or the time step is above
     * the stable one.
     */
    class WrongRun : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        march(file, "a sound run", 1., 0.9, communicator, verdicts);
        verdicts.is_true("a sound run: no stop", stop.empty());
        verdicts.is_true("a sound run: no warning",
                         summary["warnings"].empty() &&
                           summary["verdict"] == "no objection");

        march(file, "a small blow", 1.05, 0.9, communicator, verdicts);
        verdicts.is_true("a small blow: no stop", stop.empty());
        verdicts.is_true("a small blow: one warning",
                         summary["warnings"].size() == 1);
        verdicts.same_text("a small blow: verdict",
                           summary["verdict"],
                           "not met: energy-balance error; "
                           "energy-balance error over the losses");
        verdicts.near("a small blow: energy-balance error over input",
                      summary["energy balance"]["largest energy-balance error"],
                      expected,
                      0.01);

        march(file, "a large blow", 1.7, 0.9, communicator, verdicts);
        stopped("a large blow", "energy-balance error", verdicts);
        march(file, "a step too large", 1., 1.05, communicator, verdicts);
        stopped("a step too large", "a hundred times", verdicts);
      }

    private:
      /** @param blow factor on the velocity in the middle of the run */
      void
      march(const ParameterFile &file,
            const std::string   &name,
            const double         blow,
            const double         safety_factor,
            const MPI_Comm       communicator,
            Verdicts            &verdicts)
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        parameters->time.safety_factor = safety_factor;
        stop.clear();
        try
          {
            const auto simulation =
              make_simulation_with_files(*parameters, communicator);
            Run   &run     = simulation->run;
            double came_in = 0.;
            while (2 * run.state.step < run.n_steps() && blow != 1.)
              {
                run.energy.before_step(run.state);
                run.scheme.step(run.state);
                keep_largest(came_in, run.energy.evaluate(run.state).input);
              }
            const double stored = run.energy.evaluate(run.state).stored();
            run.state.velocity *= blow;
            expected =
              (run.energy.evaluate(run.state).stored() - stored) / came_in;
            run.march();
          }
        catch (const UserError &error)
          {
            stop = error.what();
          }
        summary = read_summary(folder);
        verdicts.is_true(name + ": there is a summary", !summary.is_null());
      }

      void
      stopped(const std::string &name,
              const std::string &reason,
              Verdicts          &verdicts) const
      {
        verdicts.is_true(name + ": stops, \"" + reason + "\"",
                         stop.find(reason) != std::string::npos);
        verdicts.is_true(name + ": said in the verdict",
                         std::string(summary["verdict"]).find(reason) !=
                           std::string::npos);
        verdicts.is_true(name + ": the last good state is there",
                         std::filesystem::exists(folder + "/last_good.vtu"));
      }

      const std::string folder = "wrong_run_output";
      std::string       stop;
      nlohmann::json    summary;
      double            expected = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<WrongRun>
      registered("wrong run",
                 "An energy-balance error is warned of, or stops the run.");
  } // namespace
} // namespace Voussoir
