#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The integral over tau from 0 of Pekeris' solution g(tau) of Lamb's
     * problem for nu = 1/4: u = P/(pi G r) g(cs t/r) is the vertical
     * displacement of the surface at distance r from a vertical step load P.
     */
    double
    pekeris_integral(const double tau)
    {
      const double root      = std::sqrt(3.);
      const double p_arrival = 1. / root,
                   rayleigh  = std::sqrt(0.75 + root / 4.);
      const double a = std::sqrt(3. * root + 5.), b = std::sqrt(3. * root - 5.);
      const double third = std::sqrt(0.75 - root / 4.);
      const auto   first = [&](const double x) {
        return (6. * x - root * std::acosh(2. * x) -
                a * std::asin(x / rayleigh) + b * std::acosh(x / third)) /
               32.;
      };
      const auto second = [&](const double x) {
        return (6. * x - a * std::asin(std::min(1., x / rayleigh))) / 16.;
      };
      double sum = 0.;
      if (tau > p_arrival)
        sum += first(std::min(tau, 1.)) - first(p_arrival);
      if (tau > 1.)
        sum += second(std::min(tau, rayleigh)) - second(1.);
      if (tau > rayleigh)
        sum += 0.375 * (tau - rayleigh);
      return sum;
    }


    /**
     * Lamb's problem: a vertical force on the surface that grows to P as
     * s^4 (35 - 84 s + 70 s^2 - 20 s^3), s = t/T, on a quarter of the model
     * between two planes of symmetry.
     */
    class Lamb : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Force", force, "P on the full half-space [N].");
        prm.add_parameter("Rise time", rise_time, "T [s].");
        prm.add_parameter("Points", points, "On the surface.");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Error over the static displacement.");
        prm.add_parameter("Coarser cells",
                          coarser_cells,
                          "A coarser box, whose error must be larger.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto places = parse_points(points, "\"Points\"");
        const auto fine   = errors(file, places, communicator);
        for (unsigned int p = 0; p < places.size(); ++p)
          verdicts.below(places[p].name + ": error over static displacement",
                         fine[p],
                         tolerance);
        if (coarser_cells.empty())
          return;
        const auto coarse =
          errors(file.with({"Mesh/box/Cells=" + coarser_cells}),
                 places,
                 communicator);
        for (unsigned int p = 0; p < places.size(); ++p)
          verdicts.is_true(places[p].name +
                             ": the error falls with the mesh size",
                           fine[p] < coarse[p]);
      }

    private:
      std::vector<double>
      errors(const ParameterFile           &file,
             const std::vector<NamedPoint> &places,
             const MPI_Comm                 communicator) const
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto histories  = run_and_record(*simulation, places);
        const auto rock =
          simulation->model.solid.materials[0]->elastic_constants();
        const double cs = rock.s_wave_speed();

        std::vector<double> result;
        for (unsigned int p = 0; p < places.size(); ++p)
          {
            const double r = places[p].position.norm();
            const double unit =
              force / (numbers::PI * rock.shear_modulus() * r);
            // u = (r/cs) integral of G(cs (t - s)/r) S''(s) ds
            const unsigned int n     = 400;
            double             error = 0.;
            for (std::size_t i = 0; i < histories.times.size(); ++i)
              {
                double expected = 0.;
                for (unsigned int k = 0; k < n; ++k)
                  {
                    const double s = (k + 0.5) / n;
                    const double curvature =
                      420. * std::pow(s * (1. - s), 2) * (1. - 2. * s);
                    expected +=
                      r / (cs * rise_time) / n * curvature *
                      pekeris_integral(
                        cs * (histories.times[i] - s * rise_time) / r);
                  }
                keep_largest(error,
                             std::abs(-histories.displacement[p][i][2] / unit -
                                      expected));
              }
            result.push_back(error / 0.375);
          }
        return result;
      }

      double      force = 1e9, rise_time = 0.1, tolerance = 0.05;
      std::string points, coarser_cells;
    };

    // Reference: closed form
    const Registry<Check>::Add<Lamb>
      registered("Lamb", "A point load on a half-space.");
  } // namespace
} // namespace Voussoir
