#include <voussoir/fem/nodal_values.h>
#include <voussoir/output/observer.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <filesystem>
#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The folder that the observers of these checks write to. */
    ObservedRun
    model_with_folder(const Simulation &simulation)
    {
      ObservedRun model = simulation.run.observed;
      model.folder      = "observed";
      if (Utilities::MPI::this_mpi_process(
            simulation.model.grid.communicator()) == 0)
        std::filesystem::create_directories(model.folder);
      MPI_Barrier(simulation.model.grid.communicator());
      return model;
    }


    /** The stress envelopes are the extremes over all samples of the principal
     *  stresses, computed here by deal.II's own functions. */
    class StressEnvelopes : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto model      = model_with_folder(*simulation);
        const auto observer =
          Registry<Observer>::create("envelopes", "the check");
        ParameterHandler prm;
        observer->declare_parameters(prm);
        prm.set("Stress interval", 1e-9);
        prm.set("Stress in", "soil");
        observer->begin(model);

        const Discretization &discretization =
          simulation->model.solid.discretization;
        std::map<std::uint64_t, std::array<double, 2>> expected;
        for (unsigned int sample = 0; sample < 3; ++sample)
          {
            State state = simulation->run.state;
            state.step  = sample;
            for (unsigned int i = 0; i < discretization.node_positions.size();
                 ++i)
              for (unsigned int d = 0; d < 3; ++d)
                {
                  const Point<3> &x = discretization.node_positions[i];
                  state.displacement.local_element(3 * i + d) =
                    1e-3 * std::sin((0.1 + 0.02 * sample) * x[0] + 0.07 * x[1] -
                                    0.05 * x[2] + 2. * d + sample);
                }
            observer->observe(state);
            reference(*simulation, state.displacement, expected);
          }

        double      difference = 0., size = 0.;
        std::size_t n_cells = 0;
        const auto  envelopes =
          observer->checkpoint_values().at("principal stress");
        for (const auto &[key, values] : envelopes.items)
          for (unsigned int i = 0; i < 2; ++i)
            {
              keep_largest(size, std::abs(expected.at(key)[i]));
              keep_largest(difference,
                           std::abs(values[i] - expected.at(key)[i]));
              n_cells += i;
            }
        verdicts.is_true("all cells of the set, and no others",
                         Utilities::MPI::sum(n_cells, communicator) ==
                           Utilities::MPI::sum(expected.size(), communicator));
        verdicts.below("largest difference over the largest stress",
                       Utilities::MPI::max(difference, communicator) /
                         Utilities::MPI::max(size, communicator),
                       1e-9);
        nlohmann::json summary;
        observer->finish(simulation->run.state, summary);
        verdicts.is_true("envelopes.vtu is written",
                         std::filesystem::file_size("observed/envelopes.vtu") >
                           1000);
      }

    private:
      static void
      reference(const Simulation                               &simulation,
                const Vector                                   &displacement,
                std::map<std::uint64_t, std::array<double, 2>> &expected)
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const Vector full = with_ghosts(discretization, displacement);
        FEValues<3>  values(discretization.mapping,
                           discretization.fe,
                           // the points of pictures
                           QIterated<3>(QTrapezoid<1>(), discretization.degree),
                           update_gradients);
        std::vector<SymmetricTensor<2, 3>> strain(values.n_quadrature_points);
        const std::vector<bool> soil = simulation.model.grid.tags_in({"soil"});
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned() && soil[cell->material_id()])
            {
              values.reinit(cell);
              values[FEValuesExtractors::Vector(0)]
                .get_function_symmetric_gradients(full, strain);
              auto &extremes =
                expected.insert({Grid::global_key(cell), {{-1e300, 1e300}}})
                  .first->second;
              for (const auto &one : strain)
                {
                  const auto principal = eigenvalues(
                    simulation.model.solid.material_of(cell).stress(one));
                  keep_largest(extremes[0], principal[0]);
                  extremes[1] = std::min(extremes[1], principal[2]);
                }
            }
      }
    };

    // Reference: other program
    const Registry<Check>::Add<StressEnvelopes>
      registered("stress envelopes", "Envelopes of principal stress.");


    /** A sine of constant amplitude: at its own period the oscillator reaches
     *  1/(2 xi) times the amplitude. */
    class Spectrum : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        ObservedRun model      = model_with_folder(*simulation);
        model.time_step        = 0.005;
        const auto observer =
          Registry<Observer>::create("response spectra", "the check");
        ParameterHandler prm;
        observer->declare_parameters(prm);
        prm.set("Points", "base: 5 5 0; top: 5 5 10");
        prm.set("Reference", "base");
        prm.set("Components", "x");
        prm.set("Shortest period", 0.02);
        prm.set("Longest period", 1.);
        prm.set("Number of periods", 3L);
        observer->check(model);
        observer->begin(model);

        // a = sin(w t) m/s2 at the base, three times that at the top
        const double omega = 2. * numbers::PI, dt = model.time_step;
        const auto   u = [&](const double t, const double z) {
          return -(1. + 0.2 * z) * std::sin(omega * t) / (omega * omega);
        };
        State       state = simulation->run.state;
        const auto &positions =
          simulation->model.solid.discretization.node_positions;
        for (state.step = 0; state.step <= 8001; ++state.step)
          {
            state.time = state.step * dt;
            for (unsigned int i = 0; i < positions.size(); ++i)
              {
                const double now  = u(state.time, positions[i][2]),
                             last = u(state.time - dt, positions[i][2]);
                state.displacement.local_element(3 * i) = now;
                state.velocity.local_element(3 * i)     = (now - last) / dt;
              }
            observer->observe(state);
          }
        nlohmann::json summary;
        observer->finish(state, summary);
        const auto &base = summary["response spectra"]["base"]["x"];
        const auto &top  = summary["response spectra"]["top"]["x"];
        verdicts.near("peak acceleration [m/s2]",
                      base.at("peak acceleration [m/s2]"),
                      1.,
                      1e-3);
        verdicts.near("spectral value at resonance [m/s2]",
                      base.at("largest spectral value [m/s2]"),
                      10.,
                      1e-3);
        verdicts.near("its period [s]", base.at("at period [s]"), 1., 1e-12);
        verdicts.near("amplification from base to top",
                      top.at("amplification of the peak"),
                      3.,
                      1e-9);
        // a stiff oscillator follows the ground
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          {
            std::ifstream in("observed/response_spectra.csv");
            std::string   heading;
            double        period, value;
            char          comma;
            std::getline(in, heading);
            in >> period >> comma >> value;
            verdicts.same_text("heading",
                               heading,
                               "period [s],base x [m/s2],top x [m/s2]");
            verdicts.near("spectral value at 0.02 s [m/s2]", value, 1., 1e-3);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<Spectrum>
      registered_spectrum("recorded spectrum", "Response spectrum of a sine.");
  } // namespace
} // namespace Voussoir
