#include <filesystem>

#include "check.h"
#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Columns x, y, z of a set [N] and their times [s]. */
    struct ForceHistory
    {
      ForceHistory(const std::string &folder, const std::string &set)
      {
        const CsvTable table(folder + "/support_forces.csv");
        times = table.numbers("time [s]");
        for (unsigned int d = 0; d < 3; ++d)
          {
            const auto column = table.numbers(set + ' ' + "xyz"[d] + " [MN]");
            force.resize(column.size());
            for (std::size_t i = 0; i < column.size(); ++i)
              force[i][d] = 1e6 * column[i];
          }
      }

      std::vector<double>       times;
      std::vector<Tensor<1, 3>> force;
    };


    std::string
    folder_of(const std::string &name)
    {
      return (std::filesystem::current_path() / name).string();
    }


    /**
     * The end of a rod moves axially as prescribed. In uniaxial strain, until
     * waves return, R = rho c A v(t) there and 2 rho c A v(t - L/c) at the
     * other end, which is fixed. With free sides and slow motion, in uniaxial
     * stress, R = E A u / L, with a contraction of nu u / L.
     */
    class RodForces : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance", tolerance, "Over the largest force.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        waves(file, verdicts, communicator);
        slowly(file, verdicts, communicator);
      }

    private:
      void
      waves(const ParameterFile &file,
            Verdicts            &verdicts,
            const MPI_Comm       communicator) const
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder_of("rod_waves"),
                               "Boundaries/Roller=left, right, front, back"}));
        const auto simulation =
          make_simulation_with_files(*parameters, communicator);
        simulation->run.march();
        const auto c =
          simulation->model.solid.materials[0]->elastic_constants();
        const double speed  = c.p_wave_speed(),
                     factor = c.density * speed * 2. * 3.; // area 2 m x 3 m
        const auto velocity = [](const double t) { // of 0.02 (t/0.02)^3 m
          return t < 0. ? 0. : 3. * std::pow(t / 0.02, 2);
        };
        MPI_Barrier(communicator);
        const ForceHistory pulled("rod_waves", "top"),
          fixed("rod_waves", "bottom");
        double of_pulled = 0., of_fixed = 0.;
        for (std::size_t i = 0; i < pulled.times.size(); ++i)
          {
            const double t = pulled.times[i];
            keep_largest(of_pulled,
                         std::abs(pulled.force[i][2] - factor * velocity(t)));
            keep_largest(of_fixed,
                         std::abs(fixed.force[i][2] +
                                  2. * factor * velocity(t - 20. / speed)));
          }
        const double end = pulled.times.back();
        verdicts.above("lines of the table", pulled.times.size(), 15);
        verdicts.near("end of the table, before waves are back, over L/c",
                      end * speed / 20.,
                      1.9,
                      0.05);
        verdicts.near("force at the end that is moved",
                      1e-6 * pulled.force.back()[2],
                      1e-6 * factor * velocity(end),
                      tolerance,
                      "MN");
        verdicts.below("its error over time",
                       of_pulled / (factor * velocity(end)),
                       tolerance);
        verdicts.near("force at the end that is fixed",
                      1e-6 * fixed.force.back()[2],
                      -2e-6 * factor * velocity(end - 20. / speed),
                      2. * tolerance,
                      "MN");
        verdicts.below("its error over time",
                       of_fixed / (2. * factor * velocity(end - 20. / speed)),
                       2. * tolerance);
        // sampled also between the lines of the table, but not in every step
        const auto   summary = read_summary("rod_waves");
        const double last    = double(summary.at("end time [s]")) -
                            double(summary.at("time step [s]"));
        verdicts.near(
          "summary, largest at the moved end",
          summary.at("support forces").at("top").at("largest z [MN]"),
          1e-6 * factor * velocity(last),
          3. * tolerance,
          "MN");
      }

      void
      slowly(const ParameterFile &file,
             Verdicts            &verdicts,
             const MPI_Comm       communicator) const
      {
        const auto parameters = make_case(
          file.with({"Output/Folder=" + folder_of("rod_slow"),
                     "Boundaries/Fixed=",
                     "Boundaries/Roller=bottom, left, front",
                     "Constraints/pull/Time function=if(t<0.5, sin(pi*t)^2, 1)",
                     "Damping/Model=mass proportional",
                     "Damping/Ratio=0.3",
                     "Damping/Lowest frequency=19",
                     "Output/support forces/Interval=0.01",
                     "Time/End time=0.8"}));
        const auto simulation =
          make_simulation_with_files(*parameters, communicator);
        simulation->run.march();
        const auto c =
          simulation->model.solid.materials[0]->elastic_constants();
        MPI_Barrier(communicator);
        const ForceHistory pulled("rod_slow", "top"),
          fixed("rod_slow", "bottom");
        const double force = c.young_modulus * 6. * 0.02 / 20.;
        verdicts.near("slowly, sides free: force E A u/L",
                      1e-6 * pulled.force.back()[2],
                      1e-6 * force,
                      1e-4,
                      "MN");
        verdicts.near("the other end",
                      1e-6 * fixed.force.back()[2],
                      -1e-6 * force,
                      1e-4,
                      "MN");
        double                contraction = 0., across = 0.;
        const Discretization &discretization =
          simulation->model.solid.discretization;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          if (const Point<3> &x = discretization.node_positions[node];
              x[0] > 2. - 1e-9)
            {
              const double u =
                simulation->run.state.displacement.local_element(3 * node);
              keep_largest(across,
                           std::abs(u + c.poisson_ratio * 0.02 / 20. * 2.));
              contraction += u;
            }
        verdicts.below(
          "contraction of all sections, the moved one too, over nu u/L",
          Utilities::MPI::max(across, communicator) /
            (c.poisson_ratio * 0.02 / 20. * 2.),
          1e-3);
        verdicts.is_true("it contracts",
                         Utilities::MPI::sum(contraction, communicator) < 0.);
      }

      double tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<RodForces>
      registered_rod("forces of a rod", "Fixed and moved ends over time.");


    /**
     * Forces of all supports of a damped block on a rigid base, with weight,
     * against the change of its momentum,
     *   R + W = d/dt sum m (v + v_base) ,
     * and those of the static state against its weight.
     */
    class MomentumBalance : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string stages : {"weight", ""})
          balance(file, stages, verdicts, communicator);
      }

    private:
      static void
      balance(const ParameterFile &file,
              const std::string   &stages,
              Verdicts            &verdicts,
              const MPI_Comm       communicator)
      {
        const std::string folder =
          stages.empty() ? "balance_over_time" : "balance_from_rest";
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder_of(folder),
                               "Static state/Stages=" + stages,
                               std::string("Loads/weight/Time function=") +
                                 (stages.empty() ? "sin(8*t)" : "")}));
        const auto simulation =
          make_simulation_with_files(*parameters, communicator);
        Run         &run = simulation->run;
        const double mass =
          simulation->model.solid.mass.total[0]; // fixed nodes too
        const auto momentum = [&] {
          Tensor<1, 3>  sum;
          const Vector &m = simulation->model.solid.mass.mass;
          for (unsigned int i = 0; i < m.locally_owned_size(); ++i)
            sum[i % 3] +=
              m.local_element(i) * run.state.velocity.local_element(i);
          return Utilities::MPI::sum(sum, communicator);
        };
        std::vector<Tensor<1, 3>> wanted;
        Tensor<1, 3>              before;
        const double              dt = run.time_step.length;
        for (unsigned long long n = 0; n < run.n_steps(); ++n)
          {
            const double t = run.state.time;
            for (const auto &observer : run.setup->plan.observers)
              observer.second->observe(run.state);
            run.scheme.step(run.state);
            const Tensor<1, 3> now = momentum();
            Tensor<1, 3>       rate =
              (now - before) / dt +
              mass * run.setup->earthquake.base.acceleration(t);
            rate[2] += mass * 9.81 * (stages.empty() ? std::sin(8. * t) : 1.);
            wanted.push_back(rate);
            before = now;
          }
        nlohmann::json summary;
        for (const auto &observer : run.setup->plan.observers)
          observer.second->observe(run.state);
        for (const auto &observer : run.setup->plan.observers)
          observer.second->finish(run.state, summary);
        MPI_Barrier(communicator);

        ForceHistory all(folder, "bottom");
        for (const std::string set : {"left", "back"})
          {
            const ForceHistory more(folder, set);
            for (std::size_t i = 0; i < all.force.size(); ++i)
              all.force[i] += more.force.at(i);
          }
        double error = 0., largest = 0.;
        for (std::size_t i = 0; i < all.times.size(); ++i)
          {
            const auto step =
              static_cast<std::size_t>(std::lround(all.times[i] / dt));
            keep_largest(largest, wanted.at(step).norm());
            keep_largest(error, (all.force[i] - wanted[step]).norm());
          }
        const std::string name =
          stages.empty() ? "weight over time: " : "weight from the start: ";
        verdicts.above(name + "lines", all.times.size(), 20);
        verdicts.near(name + "force at t = 0",
                      1e-6 * all.force[0][2],
                      stages.empty() ? 0. : 1e-6 * mass * 9.81,
                      1e-6,
                      "MN");
        verdicts.above(name + "largest over the weight",
                       largest / (mass * 9.81),
                       stages.empty() ? 0.5 : 1.2);
        verdicts.below(name + "supports against momentum",
                       error / largest,
                       1e-7);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<MomentumBalance>
      registered_balance("momentum balance", "Of a block and its supports.");
  } // namespace
} // namespace Voussoir
