#include <voussoir/base/parameter_file.h>
#include <voussoir/output/stress_points.h>

#include "observed.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** An observer with some entries, called during a run. */
    class Watch
    {
    public:
      Watch(const std::string                        &name,
            const std::map<std::string, std::string> &entries,
            const Run                                &run)
        : name(name)
        , observer(Registry<Observer>::create(name, "the check"))
      {
        ParameterHandler prm;
        observer->declare_parameters(prm);
        for (const auto &[entry, value] : entries)
          prm.set(entry, value);
        ObservedRun model           = run.observed;
        model.folder                = "watched";
        const MPI_Comm communicator = run.log.communicator();
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          std::filesystem::create_directories(model.folder);
        MPI_Barrier(communicator);
        observer->check(model);
        observer->begin(model);
      }

      void
      observe(const State &state)
      {
        observer->observe(state);
      }

      nlohmann::json
      finish(const State &state)
      {
        nlohmann::json summary;
        observer->finish(state, summary);
        return summary[name];
      }

    private:
      const std::string         name;
      std::unique_ptr<Observer> observer;
    };


    /**
     * A short bar along z, on rollers at its bottom, whose top is pulled and
     * pushed by T(t) = P (1 - exp(-(t/t_0)^2)) sin(2 pi f t) in addition to a
     * static pull. The bar is too short for waves, so its stress is that
     * traction, independent of its strain under damping: an amplitude P around
     * the static pull, and above a strength as long as the traction is.
     */
    class ReportedStress : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Variants",
                          variants,
                          "Separated by semicolons, each \"name: Section/Entry "
                          "= value | ...\", the entries that differ.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        this->verdicts = &verdicts;
        for (const std::string &variant : split_list(variants, ';'))
          {
            const auto colon = variant.find(':');
            const auto name  = Utilities::trim(variant.substr(0, colon));
            const auto list  = split_list(variant.substr(colon + 1), '|');
            std::vector<std::string> changes;
            for (const std::string &change : list)
              {
                const auto equals = change.find('=');
                changes.push_back(Utilities::trim(change.substr(0, equals)) +
                                  "=" +
                                  Utilities::trim(change.substr(equals + 1)));
              }
            for (const double frequency : {1., 10.})
              evaluate(file.with(changes), name, frequency, communicator);
          }
      }

    private:
      static constexpr double amplitude = 1., // P [MPa]
        thickness                       = 0.5;

      void
      evaluate(const ParameterFile &file,
               const std::string   &variant,
               const double         frequency,
               const MPI_Comm       communicator) const
      {
        const double n_periods = frequency < 5. ? 3. : 6., // twice t_0 is one
          period               = 1. / frequency;
        std::ostringstream factor, end;
        factor << std::setprecision(17) << "(1 - exp(-(t*" << 2. * frequency
               << ")^2))*sin(2*pi*" << frequency << "*t)";
        end << std::setprecision(17) << n_periods * period;
        const auto parameters =
          make_case(file.with({"Loads/shaking/Time function=" + factor.str(),
                               "Time/End time=" + end.str()}));
        const auto simulation = make_simulation(*parameters, communicator);
        Run       &run        = simulation->run;
        const bool cracks     = run.model.solid.internal_force.has_memory();

        const double at_rest =
          parameters->static_state.stage_names().empty() ? 0. : 0.4;
        const double strength = at_rest + amplitude / 1.5;

        Watch faces("face stresses",
                    {{"Face sets", "front, back"},
                     {"Envelope interval", "1e-5"}},
                    run),
          section("section forces",
                  {{"Sections", "middle: 0.2 0.37"},
                   {"Upstream", "back"},
                   {"Downstream", "front"},
                   {"Interval", "1e-5"}},
                  run),
          envelopes("envelopes", {{"Stress interval", "1e-5"}}, run);
        std::unique_ptr<Watch> over;
        if (!cracks)
          over = std::make_unique<Watch>("over-stress",
                                         std::map<std::string, std::string>{
                                           {"Face sets", "front, back"},
                                           {"Tensile strength",
                                            std::to_string(1e6 * strength)}},
                                         run);
        double above_once = 0.; // before the last periods
        for (bool first = true; run.state.step < run.n_steps(); first = false)
          {
            if (!first)
              run.scheme.step(run.state);
            for (Watch *watch : {&faces, &section, &envelopes, over.get()})
              if (watch != nullptr)
                watch->observe(run.state);
            const double traction =
              at_rest +
              amplitude *
                (1. - std::exp(-std::pow(2. * frequency * run.state.time, 2))) *
                std::sin(2. * numbers::PI * frequency * run.state.time);
            if (traction > strength)
              above_once += run.time_step.length;
          }
        std::ostringstream text;
        text << variant << ", " << frequency << " Hz: ";
        const std::string name     = text.str();
        const auto        of_faces = faces.finish(run.state);
        near(name + "largest stress on the faces [MPa]",
             of_faces.at("largest cantilever stress [MPa]"),
             at_rest + amplitude);
        near(name + "smallest",
             of_faces.at("smallest cantilever stress [MPa]"),
             at_rest - amplitude);
        const auto line = section.finish(run.state).at("middle");
        near(name + "largest force in a section over its area [MPa]",
             line.at("largest cantilever force [MN/m]").get<double>() /
               thickness,
             at_rest + amplitude);
        near(name + "smallest",
             line.at("smallest cantilever force [MN/m]").get<double>() /
               thickness,
             at_rest - amplitude);
        double largest = -1e300;
        for (const auto &material : envelopes.finish(run.state))
          keep_largest(
            largest,
            material.at("largest principal stress [MPa]").get<double>());
        near(name + "largest of the envelopes", largest, at_rest + amplitude);
        if (!over)
          return;
        const auto face = over->finish(run.state).at("front");
        near(name + "demand over the strength",
             face.at("largest ratio"),
             (at_rest + amplitude) / strength);
        const double accumulated =
          face.at("above 1").at("accumulated time [s]");
        verdicts->near(name + "accumulated time above it, in periods",
                       accumulated / period,
                       above_once / period,
                       2e-3);
      }

      void
      near(const std::string &name,
           const double       value,
           const double       reference) const
      {
        verdicts->near(name, value, reference, 2e-3);
      }

      std::string variants;
      Verdicts   *verdicts = nullptr;
    };

    /**
     * The same bar with a layer whose strength is below the largest traction:
     * no stress is above that strength, even though damping changes the strain,
     * and none remains once the crack is open.
     */
    class ReportedStressOfCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double frequency : {1., 10.})
          for (const std::string factor : {"1", "0.6"})
            evaluate(file.with(
                       {"Materials/weak/Static factor=" + factor,
                        "Materials/sound/Static factor=" + factor,
                        "Static state/Stages=" +
                          std::string(factor == "1" ? "" : "pull"),
                        "Loads/pull/Active=" +
                          std::string(factor == "1" ? "false" : "true")}),
                     frequency,
                     factor,
                     verdicts,
                     communicator);
      }

    private:
      static void
      evaluate(const ParameterFile &file,
               const double         frequency,
               const std::string   &static_factor,
               Verdicts            &verdicts,
               const MPI_Comm       communicator)
      {
        // the crack begins at a sine of 0.98, or, with the pull, 0.588
        std::ostringstream time, end;
        time << "1.02*sin(2*pi*t*" << frequency << ")";
        end << 0.25 / frequency;
        const auto parameters =
          make_case(file.with({"Loads/shaking/Time function=" + time.str(),
                               "Time/End time=" + end.str()}));
        const auto simulation = make_simulation(*parameters, communicator);
        Run       &run        = simulation->run;
        Watch      envelopes("envelopes", {{"Stress interval", "1e-5"}}, run);
        envelopes.observe(run.state);
        while (run.state.step < run.n_steps())
          {
            run.scheme.step(run.state);
            envelopes.observe(run.state);
          }
        std::ostringstream text;
        text << frequency << " Hz, static factor " << static_factor << ": ";
        const std::string name = text.str();
        verdicts.near(name + "largest stress of the cells that crack [MPa]",
                      envelopes.finish(run.state).at("weak").at(
                        "largest principal stress [MPa]"),
                      1.,
                      5e-3);

        std::vector<StressPoints::Place> places;
        for (const auto &cell : simulation->model.solid.discretization
                                  .dof_handler.active_cell_iterators())
          if (cell->is_locally_owned() &&
              run.observed.solid.grid().material(cell) == 0)
            places.push_back({cell, Point<3>(0.5, 0.5, 0.5)});
        StressPoints points(run.observed, places);
        double       left = 0.;
        for (const auto &stress : points.evaluate(run.state))
          keep_largest(left, 1e-6 * std::abs(stress[2][2]));
        left = Utilities::MPI::max(left, communicator);
        verdicts.below(name + "stress across the open crack [MPa]", left, 0.01);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<ReportedStressOfCrack>
      of_crack("reported stress of a crack",
               "Stress of concrete that cracks is its strength and none.");
    // Reference: closed form
    const Registry<Check>::Add<ReportedStress>
      registered("reported stress",
                 "Stress under damping is the traction that makes it.");
  } // namespace
} // namespace Voussoir
