#include "histories.h"
#include "layered_ground.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The place of a given motion: a motion of the free surface is reproduced
     * there, after twice the travel time of an S wave (see
     * `incident_for_surface`), in layers with damping; a motion of an outcrop
     * is twice the incident wave. Both use the same column, which is verified
     * by the surface over the outcrop against plane waves in closed form.
     */
    class Outcrop : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Uniform",
          uniform,
          "One material: the surface then moves as the outcrop, if it is not "
          "damped, and as level rock, later by the travel time.");
        prm.add_parameter("Place",
                          place,
                          "Where the motion is given in the uniform rock.");
        prm.add_parameter(
          "Thicknesses",
          thicknesses,
          "Thicknesses of the layers, in the order of the materials [m].");
        prm.add_parameter(
          "Frequencies",
          frequencies,
          "Frequencies at which the surface is compared with the outcrop [Hz].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto given = make_case(file)->ground_motion.build(file.folder());

        double delay = 0.;
        if (uniform)
          {
            evaluate_uniform(file, place, given, verdicts, communicator);
            return;
          }
        const auto at_surface =
          surface(file.with({"Ground motion/Given at=free surface"}),
                  delay,
                  communicator);
        for (unsigned int d = 0; d < 3; ++d)
          {
            double error = 0., peak = 0.;
            for (std::size_t i = 0; i < at_surface.times.size(); ++i)
              {
                const double wanted =
                  given[d]->displacement(at_surface.times[i] - delay);
                keep_largest(peak, std::abs(wanted));
                keep_largest(error,
                             std::abs(at_surface.displacement[0][i][d] -
                                      wanted));
              }
            verdicts.below(std::string("free surface ") + "xyz"[d] +
                             ": error over peak",
                           error / peak,
                           0.01);
          }

        const auto outcrop =
          surface(file.with({"Ground motion/Given at=outcrop"}),
                  delay,
                  communicator);
        const LayeredGround ground(*make_case(file), thicknesses);
        for (unsigned int d = 0; d < 3; ++d)
          {
            std::vector<double> wanted;
            for (const double time : outcrop.times)
              wanted.push_back(given[d]->displacement(time));
            ground.compare({"xyz"[d]},
                           d == 2,
                           outcrop.times,
                           outcrop.component(0, d),
                           wanted,
                           frequencies,
                           0.02,
                           verdicts);
          }
        const auto incident =
          surface(file.with({"Ground motion/Given at=incident wave",
                             "Ground motion/Overload factor=0.5"}),
                  delay,
                  communicator);
        double difference = 0., peak = 0.;
        for (std::size_t i = 0; i < outcrop.times.size(); ++i)
          {
            const Tensor<1, 3> &u = outcrop.displacement[0][i];
            keep_largest(peak, u.norm());
            keep_largest(difference, (u - incident.displacement[0][i]).norm());
          }
        verdicts.below("outcrop against half the incident wave",
                       difference / peak,
                       1e-12);
      }

    private:
      template <typename Given>
      static void
      evaluate_uniform(const ParameterFile &file,
                       const std::string   &place,
                       const Given         &given,
                       Verdicts            &verdicts,
                       const MPI_Comm       communicator)
      {
        double     delay = 0.;
        const auto motion =
          surface(file.with({"Ground motion/Given at=" + place}),
                  delay,
                  communicator);
        const auto parameters      = make_case(file);
        const auto simulation      = make_simulation(*parameters, communicator);
        const auto &[lower, upper] = simulation->model.boundary.extent();
        const ElasticConstants rock =
          simulation->model.solid.materials[0]->elastic_constants();
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double travel =
              place == "outcrop" ?
                (upper[2] - lower[2]) /
                  (d == 2 ? rock.p_wave_speed() : rock.s_wave_speed()) :
                delay;
            double error = 0., peak = 0.;
            for (std::size_t i = 0; i < motion.times.size(); ++i)
              {
                const double wanted =
                  given[d]->displacement(motion.times[i] - travel);
                keep_largest(peak, std::abs(wanted));
                keep_largest(error,
                             std::abs(motion.displacement[0][i][d] - wanted));
              }
            verdicts.below(std::string("uniform rock ") + "xyz"[d] +
                             ": error over peak",
                           error / peak,
                           0.01);
          }
      }

      /** Motion of the surface, and the delay of a motion given there. */
      static Histories
      surface(const ParameterFile &file,
              double              &delay,
              const MPI_Comm       communicator)
      {
        const auto parameters      = make_case(file);
        const auto simulation      = make_simulation(*parameters, communicator);
        const auto &[lower, upper] = simulation->model.boundary.extent();

        // twice the S travel time through the levels of one side, whole steps
        std::map<double, double> levels;
        for (const SideFace &face : simulation->model.boundary.side_faces())
          levels[face.lower] = (face.upper - face.lower) /
                               simulation->model.solid.materials[face.material]
                                 ->elastic_constants()
                                 .s_wave_speed();
        double travel_time = 0.;
        for (const auto &level : levels)
          travel_time += level.second;
        delay = std::ceil(2. * travel_time / simulation->run.time_step.length) *
                simulation->run.time_step.length;
        return run_and_record(*simulation, {{"surface", upper}});
      }

      bool                uniform = false;
      std::string         place   = "outcrop";
      std::vector<double> thicknesses, frequencies;
    };

    // Reference: closed form
    const Registry<Check>::Add<Outcrop>
      registered("outcrop", "Motions given at the surface or an outcrop.");
  } // namespace
} // namespace Voussoir
