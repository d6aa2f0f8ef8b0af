#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A body cut by interfaces that are tied has the modes of the uncut body.
     */
    class TiedModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cut",
                          interface,
                          "Entry of the interface's section.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        std::vector<std::string> changes{"Interfaces/Names=cut"};
        changes.push_back("Interfaces/cut/" + interface);
        const auto uncut = make_case(file), cut = make_case(file.with(changes));
        const auto whole = make_simulation(*uncut, communicator),
                   tied  = make_simulation(*cut, communicator);
        verdicts.above(
          "unknowns more than in the whole",
          double(tied->model.solid.discretization.dof_handler.n_dofs()) -
            double(whole->model.solid.discretization.dof_handler.n_dofs()),
          3.);
        double frequency = 0., effective = 0., mass = 0.;
        for (unsigned int j = 0; j < uncut->modes.number; ++j)
          {
            const Mode &a = tied->modes.list.at(j),
                       &b = whole->modes.list.at(j);
            keep_largest(frequency, std::abs(a.frequency / b.frequency - 1.));
            keep_largest(mass, std::abs(a.mass / b.mass - 1.));
            keep_largest(effective,
                         (a.effective_mass - b.effective_mass).norm() /
                           whole->modes.moving_mass.norm());
          }
        verdicts.below("largest difference of a frequency", frequency, 1e-8);
        verdicts.below("largest difference of a modal mass", mass, 1e-4);
        verdicts.below("largest difference of an effective mass",
                       effective,
                       1e-4);
        verdicts.below(
          "difference of the moving mass",
          (tied->modes.moving_mass - whole->modes.moving_mass).norm() /
            whole->modes.moving_mass.norm(),
          1e-10);
        verdicts.below("largest jump of a mode", largest_jump(*tied), 1e-12);
      }

    private:
      std::string interface;

      /** Between the nodes of the interfaces on one rank. */
      static double
      largest_jump(const Simulation &simulation)
      {
        double         largest = 0.;
        const Contact &contact = *simulation.model.contact;
        for (const Mode &mode : simulation.modes.list)
          {
            Contact at(contact);
            State   state;
            state.displacement = mode.shape;
            state.velocity =
              simulation.model.solid.discretization.create_vector();
            at.start(state);
            for (unsigned int k = 0; k < at.points().size(); ++k)
              keep_largest(
                largest, (at.points()[k].gap - contact.points()[k].gap).norm());
          }
        return Utilities::MPI::max(largest,
                                   simulation.model.grid.communicator());
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<TiedModes>
      registered_tied("tied modes", "Against those of the uncut body.");


    /**
     * A rod between two walls, cut in two unequal parts: axial modes after a
     * weight has opened or closed the cut, and with the cut tied in either
     * state.
     */
    class OpenedModes : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Lengths", lengths, "Lengths of the two parts [m].");
        prm.add_parameter("Tolerance", tolerance, "Relative.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        std::vector<double> whole, halves; // k, omega = k c
        for (unsigned int j = 1; j < 6; ++j)
          {
            whole.push_back(j * numbers::PI / (lengths[0] + lengths[1]));
            for (const double length : lengths)
              halves.push_back((j - 0.5) * numbers::PI / length);
          }
        std::sort(halves.begin(), halves.end());
        const auto evaluate = [&](const std::string              &name,
                                  const std::vector<std::string> &changes,
                                  const std::vector<double>      &expected) {
          const auto   parameters = make_case(file.with(changes));
          const auto   simulation = make_simulation(*parameters, communicator);
          const double c          = simulation->model.solid.materials[0]
                             ->elastic_constants()
                             .p_wave_speed();
          for (unsigned int j = 0; j < parameters->modes.number; ++j)
            verdicts.near(name + ", mode " + std::to_string(j + 1),
                          2. * numbers::PI *
                            simulation->modes.list[j].frequency / c,
                          expected[j],
                          tolerance,
                          "1/m");
        };
        evaluate("opened by its weight",
                 {"Loads/weight/Cell sets=lower"},
                 halves);
        evaluate("closed by its weight",
                 {"Loads/weight/Cell sets=upper"},
                 whole);
        evaluate("opened, but tied",
                 {"Loads/weight/Cell sets=lower", "Modes/Interfaces=all tied"},
                 whole);
        evaluate("with a gap",
                 {"Loads/weight/Cell sets=upper",
                  "Interfaces/cut/Initial gap=1e-3"},
                 halves);
      }

    private:
      std::vector<double> lengths;
      double              tolerance = 1e-3;
    };

    // Reference: closed form
    const Registry<Check>::Add<OpenedModes>
      registered_opened("opened modes", "Of a rod whose cut opens or closes.");
  } // namespace
} // namespace Voussoir
