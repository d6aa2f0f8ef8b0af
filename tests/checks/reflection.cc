#include "check.h"
#include "reflected_shares.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A pulse travels down a column and is reflected by the springs of the
     * absorbing boundary: |R| = 1 / sqrt(1 + (2 w rho c / k)^2) for a spring k
     * per area beside a dashpot rho c, and nothing without springs.
     *
     * The column hangs from its surface at z = 0 and has one cell in x and y.
     * An S wave in it needs sides without vertical motion, which the check
     * provides.
     */
    class Reflection : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Wave",
                          wave,
                          "S in x, or P.",
                          Patterns::Selection("S|P"));
        prm.add_parameter("Frequencies",
                          frequencies,
                          "Frequencies of the comparison [Hz].");
        prm.add_parameter("Tolerance", tolerance, "On |R| itself.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto reference = make_case(file);
        const auto rock =
          reference->material_list().front()->elastic_constants();
        const bool   shear = wave == "S";
        const double G     = rock.shear_modulus();
        const double c     = shear ? rock.s_wave_speed() : rock.p_wave_speed();
        const double r     = reference->boundaries.absorbing.radius;

        // spring per area of the kind of wave
        const std::map<std::string, double> springs{
          {"Liu 3D", (shear ? 2. / 3. : 4. / 3.) * G / r},
          {"paper", (shear ? G : rock.young_modulus) / (2. * r)}};
        for (const auto &[set, spring] : springs)
          {
            const auto measured =
              reflections(file.with({"Boundaries/Coefficients=" + set}),
                          c,
                          communicator);
            for (const auto &[f, R] : measured)
              {
                std::ostringstream name;
                name << set << ", " << f << " Hz: |R|";
                const double expected =
                  1. /
                  std::hypot(1.,
                             4. * numbers::PI * f * rock.density * c / spring);
                verdicts.near(name.str(), R, expected, tolerance / expected);
              }
          }
        for (const auto &[f, R] :
             reflections(file.with({"Boundaries/Absorbing type=viscous"}),
                         c,
                         communicator))
          {
            std::ostringstream name;
            name << "viscous, " << f << " Hz: |R|";
            verdicts.below(name.str(), R, 0.005);
          }
      }

    private:
      /** |R| at the frequencies, from the pulses that pass the middle. */
      std::map<double, double>
      reflections(const ParameterFile &file,
                  const double         c,
                  const MPI_Comm       communicator) const
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double height     = -simulation->model.boundary.extent().first[2];
        const auto   histories  = run_and_record(
          *simulation,
          {{"middle", Point<3>(0., 0., -0.5 * height)}},
          [&](State &state) {
            if (wave == "S")
              for (unsigned int node = 0;
                   node <
                   simulation->model.solid.discretization.n_owned_nodes();
                   ++node)
                {
                  state.displacement.local_element(3 * node + 2) = 0.;
                  state.velocity.local_element(3 * node + 2)     = 0.;
                }
          });

        return reflected_shares(histories.times,
                                histories.component(0, wave == "S" ? 0 : 2),
                                frequencies,
                                height / c);
      }

      std::string         wave = "S";
      std::vector<double> frequencies{1., 2., 4.};
      double              tolerance = 0.02;
    };

    // Reference: closed form
    const Registry<Check>::Add<Reflection>
      registered("reflection", "Reflection by the springs of the boundary.");
  } // namespace
} // namespace Voussoir
