#include "check.h"
#include "momentum.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Largest entry of Phi^T M Phi - I and of Phi^T K Phi / omega^2 - I, M
     *  with the added mass. */
    std::pair<double, double>
    orthogonality(const Simulation &simulation)
    {
      std::pair<double, double> error(0., 0.);
      Vector force = simulation.model.solid.discretization.create_vector(),
             momentum(force);
      for (const Mode &a : simulation.modes.list)
        {
          simulation.model.solid.internal_force.apply(force, a.shape);
          momentum           = momentum_with_water(simulation.model, a.shape);
          const double omega = 2. * numbers::PI * a.frequency;
          for (const Mode &b : simulation.modes.list)
            {
              const double size = std::sqrt(a.mass * b.mass);
              const double unit = &a == &b ? 1. : 0.;
              keep_largest(error.first,
                           std::abs(momentum * b.shape / size - unit));
              keep_largest(error.second,
                           std::abs(force * b.shape / (size * omega * omega) -
                                    unit));
            }
        }
      return error;
    }


    /** Modes with other parameters and terms than those of the simulation. */
    Modes
    compute_modes(const Simulation     &simulation,
                  const Case           &parameters,
                  const ModeParameters &mode_parameters,
                  const NodalTerms     &terms)
    {
      Log log(simulation.model.grid.communicator(), true);
      return find_modes({simulation.model.solid,
                         parameters.material_names(),
                         parameters.boundaries,
                         terms},
                        mode_parameters,
                        log);
    }


    /** Natural frequencies against known ones, and the modes' properties. */
    class NaturalModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Circular frequencies", expected, "[rad/s]");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Modes &modes      = simulation->modes;
        double       residual   = 0.;
        for (unsigned int j = 0; j < modes.list.size(); ++j)
          {
            if (j < expected.size())
              verdicts.near("mode " + std::to_string(j + 1),
                            2. * numbers::PI * modes.list[j].frequency,
                            expected[j],
                            tolerance,
                            "rad/s");
            keep_largest(residual, modes.list[j].residual);
          }
        verdicts.below("largest residual",
                       residual,
                       parameters->modes.tolerance);
        // with compressible water the modes include its pressures
        if (parameters->modes.water == WaterInModes::compressible)
          return;
        const auto [mass, stiffness] = orthogonality(*simulation);
        verdicts.below("orthogonality in the mass", mass, 1e-8);
        verdicts.below("orthogonality in the stiffness", stiffness, 1e-6);
      }

    private:
      std::vector<double> expected;
      double              tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<NaturalModes>
      registered_modes("natural modes", "Against known frequencies.");


    /**
     * A rod along z, fixed below and free to move axially only: modes and
     * effective masses in closed form, also with water that weighs as much as
     * the rod on its free end.
     */
    class RodModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Modes &modes      = simulation->modes;
        const double length     = 20.;
        const auto   material =
          simulation->model.solid.materials[0]->elastic_constants();
        const double base = material.p_wave_speed() / length; // [rad/s]

        // of the whole rod, fixed end included, as in the closed form
        const double mass = simulation->model.solid.mass.total[0];
        double       sum  = 0.;
        for (unsigned int j = 0; j < modes.list.size(); ++j)
          {
            const Mode  &mode  = modes.list[j];
            const double k     = (j + 0.5) * numbers::PI;
            const double share = mode.effective_mass[2] / mass;
            sum += share;
            if (j > 2)
              continue;
            const std::string name = "mode " + std::to_string(j + 1);
            verdicts.near(name + " over c/L",
                          2. * numbers::PI * mode.frequency / base,
                          k,
                          tolerance);
            verdicts.near(name + ", effective mass",
                          share,
                          2. / (k * k),
                          2. * tolerance);
            verdicts.near(name + ", participation",
                          std::abs(mode.participation[2]),
                          2. / k,
                          2. * tolerance);
          }
        verdicts.near("sum of the effective masses",
                      sum,
                      0.979736,
                      tolerance); // sum of 2/k^2 of ten modes

        const NodalTerms  loaded = with_end_mass(*simulation, mass);
        std::vector<Mode> wet; // whole cross-sections move in these
        for (const Mode &mode :
             compute_modes(*simulation, *parameters, parameters->modes, loaded)
               .list)
          if (mode.effective_mass[2] > 1e-6 * mass)
            wet.push_back(mode);
        const std::array<double, 3> roots{
          {0.8603335890193798, 3.425618459481728, 6.437298179171947}};
        for (unsigned int j = 0; j < 3; ++j) // k tan k = 1
          verdicts.near("with added mass, mode " + std::to_string(j + 1) +
                          " over c/L",
                        2. * numbers::PI * wet.at(j).frequency / base,
                        roots[j],
                        tolerance);
        // phi = sin(k z/L): (1 - cos k + sin k)^2 / (1/2 - sin 2k/4k + sin^2 k)
        const double k = roots[0], s = std::sin(k), c = std::cos(k);
        verdicts.near("with added mass, effective mass over that of the rod",
                      wet[0].effective_mass[2] / mass,
                      std::pow((1. - c) / k + s, 2) /
                        (0.5 - s * c / (2. * k) + s * s),
                      2. * tolerance);
        ModeParameters without_water = parameters->modes;
        without_water.water          = WaterInModes::none;
        const auto dry =
          compute_modes(*simulation, *parameters, without_water, loaded);
        verdicts.near("without water, mode 1 over c/L",
                      2. * numbers::PI * dry.list[0].frequency / base,
                      0.5 * numbers::PI,
                      tolerance);
      }

    private:
      static NodalTerms
      with_end_mass(const Simulation &simulation, const double mass)
      {
        // the nodes at the end share the added mass in the ratio of their own
        // masses
        const Discretization &discretization =
          simulation.model.solid.discretization;
        NodalTerms terms             = simulation.model.terms;
        double     sum               = 0.;
        const auto for_each_end_node = [&](const auto &visit) {
          for (unsigned int node = 0; node < discretization.n_owned_nodes();
               ++node)
            if (discretization.node_positions[node][2] > 20. - 1e-9)
              visit(node,
                    simulation.model.solid.mass.mass.local_element(3 * node +
                                                                   2));
        };
        for_each_end_node(
          [&](const unsigned int, const double m) { sum += m; });
        sum = Utilities::MPI::sum(sum, discretization.grid.communicator());
        for_each_end_node([&](const unsigned int node, const double m) {
          NodalTerm term{node, {}, {}, {}};
          term.added_mass[2][2] = mass * m / sum;
          terms.add({term});
        });
        return terms;
      }

      double tolerance = 0.001;
    };

    // Reference: closed form
    const Registry<Check>::Add<RodModes>
      registered_rod("modes of a rod", "With and without added mass.");


    /** Koyna's section on rock that is rigid, without mass, and with mass. */
    class FoundationModes : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto with_rock = [&](const std::vector<std::string> &changes) {
          const auto parameters = make_case(file.with(changes));
          return make_simulation(*parameters, communicator)->modes;
        };
        const Modes without  = with_rock({}),
                    rigid    = with_rock({"Modes/Fixed materials=rock"}),
                    massless = with_rock({"Modes/Massless materials=rock"});
        Case dam_alone(
          ParameterFile(file.resolve("../data/koyna_section.prm")));
        const Modes fixed = make_simulation(dam_alone, communicator)->modes;
        verdicts.near("rigid rock, mode 1 of a fixed base",
                      rigid.list[0].frequency,
                      fixed.list[0].frequency,
                      1e-6,
                      "Hz");
        verdicts.above("rigid rock over rock without mass, mode 1",
                       rigid.list[0].frequency / massless.list[0].frequency,
                       1.);
        verdicts.above("rock without mass over rock with mass, mode 1",
                       massless.list[0].frequency / without.list[0].frequency,
                       1.);
        verdicts.near("mass that moves on rock without mass",
                      1e-6 * massless.moving_mass[1],
                      1e-6 * dam_mass,
                      1e-8,
                      "kt");
      }

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Mass", dam_mass, "Mass of the dam [kg].");
      }

    private:
      double dam_mass = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<FoundationModes>
      registered_foundation("modes and foundation", "Rigid, massless, massed.");


    /** Rayleigh damping has the given ratio at the modes that are named. */
    class DampingFromModes : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        for (const unsigned int mode : {1, 2, 3})
          verdicts.near("ratio in mode " + std::to_string(mode),
                        100. * simulation->run.damping.ratio(
                                 simulation->modes.list[mode - 1].frequency),
                        expected[mode - 1],
                        1e-6,
                        "%");
      }

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Ratios", expected, "In modes 1, 2, 3 [%].");
      }

    private:
      std::vector<double> expected;
    };

    // Reference: closed form
    const Registry<Check>::Add<DampingFromModes>
      registered_damping("damping from modes", "Its ratio at two modes.");
  } // namespace
} // namespace Voussoir
