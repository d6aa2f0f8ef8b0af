#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A pressure p f'(t) on the surface z = 0 of a column sends down the pulse
     * u = p / (rho c) f(t - |z|/c), f = T/4 (s (1 - s))^4 with s = t/T.
     *
     * An S wave needs sides without vertical motion, which the check provides.
     */
    class Pulse : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Wave", wave, "", Patterns::Selection("P|S"));
        prm.add_parameter("Tolerance", tolerance, "Over the largest motion.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string quadrature : {"Gauss", "one point"})
          {
            const auto parameters =
              make_case(file.with({"Discretization/Quadrature=" + quadrature}));
            const auto simulation = make_simulation(*parameters, communicator);
            const bool shear      = wave == "S";
            const auto rock =
              simulation->model.solid.materials[0]->elastic_constants();
            const double c = shear ? rock.s_wave_speed() : rock.p_wave_speed();
            const double factor = 1e6 / (rock.density * c);
            const double depth = 800., duration = 0.4;

            const auto histories = run_and_record(
              *simulation,
              {{"depth", Point<3>(5., 5., -depth)}},
              [&](State &state) {
                if (shear)
                  for (unsigned int node = 0;
                       node <
                       simulation->model.solid.discretization.n_owned_nodes();
                       ++node)
                    {
                      state.displacement.local_element(3 * node + 2) = 0.;
                      state.velocity.local_element(3 * node + 2)     = 0.;
                    }
              });
            const auto u          = histories.component(0, shear ? 0 : 2);
            double     difference = 0., weighted = 0., sum = 0.;
            for (unsigned int i = 0; i < u.size(); ++i)
              {
                const double s = (histories.times[i] - depth / c) / duration;
                const double exact =
                  s > 0. && s < 1. ?
                    factor * 0.25 * duration * std::pow(s * (1. - s), 4) :
                    0.;
                keep_largest(difference, std::abs(u[i] - exact));
                weighted += u[i] * histories.times[i];
                sum += u[i];
              }
            const std::string name = quadrature + ", " + wave + " wave: ";
            verdicts.near(name + "speed",
                          depth / (weighted / sum - 0.5 * duration),
                          c,
                          0.002,
                          "m/s");
            verdicts.below(name + "motion against d'Alembert, over the largest",
                           difference /
                             (factor * 0.25 * duration * std::pow(0.5, 8)),
                           tolerance);
          }
      }

    private:
      std::string wave      = "P";
      double      tolerance = 0.02;
    };

    // Reference: closed form
    const Registry<Check>::Add<Pulse>
      registered("pulse", "A plane wave in irregular cells.");
  } // namespace
} // namespace Voussoir
