#include <voussoir/loads/column_field.h>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A soft layer on rock under a vertical S wave (x) and P wave (z): the box
     * moves as the one-dimensional column does. Undamped, its surface amplifies
     * the motion of an outcrop by 1 / sqrt(cos^2 kH + alpha^2 sin^2 kH), alpha
     * the ratio of the impedances.
     */
    class LayeredColumn : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Layer", layer, "Thickness of the soft layer [m].");
        prm.add_parameter("Frequencies",
                          frequencies,
                          "Where to look at the amplification of S; that of P "
                          "at cp/cs times these [Hz].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto motion =
          parameters->ground_motion.build(parameters->file.folder());
        const auto &[lower, upper] = simulation->model.boundary.extent();
        const ElasticConstants
          rock = simulation->model.materials[0]->elastic_constants(),
          soil = simulation->model.materials[1]->elastic_constants();

        // the column, marched beside the model
        WaveColumn column(
          layers_of_sides(simulation->model.boundary.side_faces(),
                          {rock, soil},
                          {1., 1.},
                          simulation->model.discretization.degree,
                          simulation->run.time_step.length,
                          simulation->run.damping),
          simulation->model.discretization.degree,
          parameters->discretization.quadrature,
          simulation->run.damping,
          simulation->run.time_step.leap_frog());
        const auto surface = column.interpolation(upper[2]);

        const Point<3>            middle(0.5 * (lower[0] + upper[0]),
                              0.5 * (lower[1] + upper[1]),
                              upper[2]);
        std::vector<Tensor<1, 3>> of_column;
        const auto                histories = run_and_record(
          *simulation,
          {{"corner", upper}, {"middle", middle}},
          [&](const State &state) {
            // the column shows the displacement at the start of its step
            const double t = state.time - simulation->run.time_step.length;
            column.advance(Tensor<1, 3>(
              {motion[0]->velocity(t), 0., motion[2]->velocity(t)}));
            of_column.push_back(column.displacement(surface));
          });

        double spread = 0., difference = 0., peak = 0.;
        for (std::size_t i = 0; i + 1 < of_column.size(); ++i)
          {
            const Tensor<1, 3> &u = histories.displacement[0][i];
            keep_largest(peak, of_column[i].norm());
            keep_largest(spread, (u - histories.displacement[1][i]).norm());
            keep_largest(difference, (u - of_column[i + 1]).norm());
          }
        verdicts.below("surface, corner against middle: difference over peak",
                       spread / peak,
                       1e-10);
        verdicts.below("surface, box against column: difference over peak",
                       difference / peak,
                       1e-10);

        amplification("S",
                      soil.s_wave_speed(),
                      soil.density / rock.density * soil.s_wave_speed() /
                        rock.s_wave_speed(),
                      1.,
                      histories.times,
                      histories.component(0, 0),
                      *motion[0],
                      verdicts);
        amplification("P",
                      soil.p_wave_speed(),
                      soil.density / rock.density * soil.p_wave_speed() /
                        rock.p_wave_speed(),
                      soil.p_wave_speed() / soil.s_wave_speed(),
                      histories.times,
                      histories.component(0, 2),
                      *motion[2],
                      verdicts);
      }

    private:
      void
      amplification(const std::string         &wave,
                    const double               speed,
                    const double               impedance_ratio,
                    const double               frequency_factor,
                    const std::vector<double> &times,
                    const std::vector<double> &surface,
                    const Signal              &motion,
                    Verdicts                  &verdicts) const
      {
        std::vector<double> outcrop;
        for (const double t : times)
          outcrop.push_back(2. * motion.displacement(t));
        for (const double frequency : frequencies)
          {
            const double f  = frequency_factor * frequency;
            const double kH = 2. * numbers::PI * f / speed * layer;
            const double ratio =
              std::abs(fourier_sum(times, surface, f, 0., 1e300)) /
              std::abs(fourier_sum(times, outcrop, f, 0., 1e300));
            std::ostringstream name;
            name << wave << ", kH = " << kH / numbers::PI
                 << " pi: surface over outcrop";
            verdicts.near(name.str(),
                          ratio,
                          1. / std::hypot(std::cos(kH),
                                          impedance_ratio * std::sin(kH)),
                          0.02);
          }
      }

      double              layer = 10.;
      std::vector<double> frequencies;
    };

    const Registry<Check>::Add<LayeredColumn>
      registered("layered column", "Amplification by a soft layer.");
  } // namespace
} // namespace Voussoir
