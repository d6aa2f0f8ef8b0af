#include <voussoir/loads/column_field.h>

#include "histories.h"
#include "layered_ground.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A soft layer on rock under a vertical S wave (x) and P wave (z): the box
     * moves as the one-dimensional column does, and its surface over an outcrop
     * as plane waves in closed form.
     */
    class LayeredColumn : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Thicknesses",
          thicknesses,
          "Thicknesses of the layers, in the order of the materials [m].");
        prm.add_parameter(
          "Frequencies",
          frequencies,
          "Frequencies at which the amplification of S is compared; that of P "
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
          rock = simulation->model.solid.materials[0]->elastic_constants(),
          soil = simulation->model.solid.materials[1]->elastic_constants();

        // the column, integrated beside the model
        WaveColumn column(
          layers_of_sides(simulation->model.boundary.side_faces(),
                          {rock, soil},
                          {1., 1.},
                          simulation->model.solid.discretization.degree,
                          simulation->run.time_step.length,
                          simulation->run.damping),
          simulation->model.solid.discretization.degree,
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
            // the column has the displacement at the start of its step
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

        const LayeredGround ground(*parameters, thicknesses);
        for (const unsigned int d : {0, 2})
          {
            std::vector<double> outcrop, scaled;
            for (const double time : histories.times)
              outcrop.push_back(2. * motion[d]->displacement(time));
            for (const double frequency : frequencies)
              scaled.push_back(
                frequency *
                (d == 2 ? soil.p_wave_speed() / soil.s_wave_speed() : 1.));
            ground.compare(d == 2 ? "P" : "S",
                           d == 2,
                           histories.times,
                           histories.component(0, d),
                           outcrop,
                           scaled,
                           0.02,
                           verdicts);
          }
      }

    private:
      std::vector<double> thicknesses, frequencies;
    };

    // Reference: closed form
    const Registry<Check>::Add<LayeredColumn>
      registered("layered column", "Amplification by a soft layer.");
  } // namespace
} // namespace Voussoir
