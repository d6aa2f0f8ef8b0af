#include <complex>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Complex = std::complex<double>;

    /** Springs and dashpots per area of the boundary, as published; springs
     *  times r. */
    struct PublishedSet
    {
      double normal_spring, tangential_spring, dashpots; // [Pa], [Pa], [-]
    };


    PublishedSet
    published_set(const std::string &name, const ElasticConstants &rock)
    {
      const double G = rock.shear_modulus(), E = rock.young_modulus,
                   M = rock.lame_lambda() + 2. * G;
      if (name == "viscous")
        return {0., 0., 1.};
      if (name == "paper")
        return {E / 2., G / 2., 1.};
      if (name == "Liu 2D" || name == "Deeks-Randolph")
        return {G, G / 2., 1.};
      if (name == "Liu 3D")
        return {4. / 3. * G, 2. / 3. * G, 1.};
      AssertThrow(name == "Du-Zhao", ExcInternalError());
      return {M / 1.8, G / 1.8, 1.1};
    }


    /** A downward wave exp i(w t - k x + q z), in rock over a level boundary at
     *  z = 0 with normal and tangential impedances. */
    struct PlaneWave
    {
      const std::string      kind;
      const ElasticConstants rock;
      const Complex          normal, tangential; // K + i w C

      double
      speed(const bool shear) const
      {
        return shear ? rock.s_wave_speed() : rock.p_wave_speed();
      }

      /** Shares of the incident energy that are reflected as the same kind of
       *  wave and, for P and SV, as the other kind. */
      std::array<double, 2>
      shares(const double w, const double k) const
      {
        const Complex i(0., 1.);
        const double  G = rock.shear_modulus();
        const auto    q = [&](const bool shear) {
          const double square = std::pow(w / speed(shear), 2) - k * k;
          return square >= 0. ? Complex(std::sqrt(square)) :
                                   -i * std::sqrt(-square);
        };
        if (kind == "SH")
          {
            const Complex stiff = i * G * q(true);
            return {
              {std::norm((stiff - tangential) / (stiff + tangential)), 0.}};
          }
        // polarisation, then sigma_xz - Z_t u_x and sigma_zz - Z_n u_z
        const auto rest = [&](const bool shear, const double up) {
          const double  size = w / speed(shear);
          const Complex qz   = -up * q(shear);
          const Complex ux   = (shear ? qz : k) / size,
                        uz   = (shear ? Complex(k) : -qz) / size;
          const Complex x_x = -i * k * ux, x_z = i * qz * ux, z_x = -i * k * uz,
                        z_z = i * qz * uz;
          return std::array<Complex, 2>{
            {G * (x_z + z_x) - tangential * ux,
             rock.lame_lambda() * (x_x + z_z) + 2. * G * z_z - normal * uz}};
        };
        const bool shear    = kind == "SV";
        const auto incident = rest(shear, -1.), same = rest(shear, 1.),
                   other          = rest(!shear, 1.);
        const Complex determinant = same[0] * other[1] - same[1] * other[0];
        const Complex a =
          -(incident[0] * other[1] - incident[1] * other[0]) / determinant;
        const Complex b =
          -(same[0] * incident[1] - same[1] * incident[0]) / determinant;
        // flux: rho c^2 q w / k per unit of amplitude
        const auto flux = [&](const bool s) {
          return std::pow(speed(s), 2) * q(s).real();
        };
        return {{std::norm(a), std::norm(b) * flux(!shear) / flux(shear)}};
      }
    };


    /**
     * A packet of waves travels down a strip of rock and meets its absorbing
     * bottom at an angle: on sides that only slide (free ones for SH waves),
     * two crossing waves form a mode cos(k x), and k = pi / width and the
     * frequency determine the angle. The reflected share of the energy, against
     * the closed form for plane waves, over the packet's components.
     */
    class ReflectionAngle : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Wave", wave, "", Patterns::Selection("SH|P|SV"));
        prm.add_parameter("Angles",
                          angles,
                          "Angle from the vertical [degrees].");
        prm.add_parameter("Sets", sets, "Sets of coefficients, or viscous.");
        prm.add_parameter("Distances",
                          distances,
                          "r of the springs over the wavelength of S / 2 pi.");
        prm.add_parameter("Tolerance", tolerance, "On the share itself.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto rock =
          make_case(file)->material_list().front()->elastic_constants();
        for (const std::string &set : split_list(sets))
          for (const double distance : distances)
            {
              if (set == "viscous" && distance != distances.front())
                continue;
              for (const double angle : angles)
                {
                  std::ostringstream name;
                  name << wave << ", " << set;
                  if (set != "viscous")
                    name << ", w r / cs = " << distance;
                  name << ", " << angle << " degrees: energy thrown back [%]";
                  const auto [found, expected] =
                    thrown_back(file, rock, set, distance, angle, communicator);
                  if (expected > tolerance)
                    verdicts.near(name.str(),
                                  100. * found,
                                  100. * expected,
                                  tolerance / expected);
                  else
                    verdicts.below(name.str(),
                                   100. * found,
                                   100. * (expected + tolerance));
                }
            }
      }

    private:
      /** Found, and by the closed form. */
      std::pair<double, double>
      thrown_back(const ParameterFile    &file,
                  const ElasticConstants &rock,
                  const std::string      &set,
                  const double            distance,
                  const double            angle,
                  const MPI_Comm          communicator) const
      {
        const bool   shear = wave != "P";
        const double c     = shear ? rock.s_wave_speed() : rock.p_wave_speed();
        const double w    = 2. * numbers::PI * rock.s_wave_speed() / wavelength;
        const double sine = std::sin(angle * numbers::PI / 180.);
        const double k = w / c * sine, q = std::sqrt(w * w / (c * c) - k * k);
        const double width = sine > 0. ? numbers::PI / k : wavelength / 3.;
        // most of it between 0.6 and 1.4 of q
        const double sigma = 2. * numbers::PI / q, start = 3.5 * sigma;
        const double r = distance * wavelength / (2. * numbers::PI);

        const auto cells = [&](const double length) {
          return std::to_string(unsigned(std::ceil(4. * length / wavelength)));
        };
        const auto parameters = make_case(file.with(
          {"Mesh/box/Upper corner=" + std::to_string(width) + ", " +
             std::to_string(wavelength / 3.) + ", " +
             std::to_string(2. * start),
           "Mesh/box/Cells=" + cells(width) + ", 1, " + cells(2. * start),
           "Boundaries/Radius=" + std::to_string(r),
           set == "viscous" ? "Boundaries/Absorbing type=viscous" :
                              "Boundaries/Coefficients=" + set,
           wave == "SH" ? "Boundaries/Antisymmetric=front, back" :
                          "Boundaries/Roller=front, back, left, right"}));
        const auto simulation = make_simulation(*parameters, communicator);

        // Gaussian packet
        constexpr int       n = 40;
        std::vector<double> wavenumbers, weights;
        for (int j = -n; j <= n; ++j)
          {
            const double x = 3.5 * j / n;
            wavenumbers.push_back(q + x / sigma);
            weights.push_back(std::exp(-0.5 * x * x));
          }
        const auto frequency = [&](const double qj) {
          return c * std::hypot(k, qj);
        };

        State      &state          = simulation->run.state;
        const auto &discretization = simulation->model.solid.discretization;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &x     = discretization.node_positions[node];
            const double    along = std::cos(k * x[0]),
                         across   = std::sin(k * x[0]);
            for (unsigned int j = 0; j < weights.size(); ++j)
              {
                const double qj = wavenumbers[j], wj = frequency(qj);
                const double phase = qj * (x[2] - start);
                // velocities are half a step earlier
                const double half = 0.5 * wj * simulation->run.time_step.length;
                const double s    = weights[j] * std::sin(phase),
                             t    = weights[j] * std::cos(phase);
                const double sv   = weights[j] * std::sin(phase - half),
                             tv   = weights[j] * std::cos(phase - half);
                Tensor<1, 3> u, v;
                if (wave == "SH")
                  {
                    u[1] = along * t;
                    v[1] = -wj * along * sv;
                  }
                else if (wave == "P") // gradient of cos(k x) cos(q z + w t)
                  {
                    u =
                      Tensor<1, 3>({-k * across * t, 0., -qj * along * s}) / wj;
                    v = Tensor<1, 3>({k * across * sv, 0., -qj * along * tv});
                  }
                else // curl of sin(k x) sin(q z + w t)
                  {
                    u =
                      Tensor<1, 3>({-qj * across * t, 0., k * along * s}) / wj;
                    v = Tensor<1, 3>({qj * across * sv, 0., k * along * tv});
                  }
                for (unsigned int d = 0; d < 3; ++d)
                  if (simulation->model.solid.mass.mass.local_element(3 * node +
                                                                      d) > 0.)
                    {
                      state.displacement.local_element(3 * node + d) += u[d];
                      state.velocity.local_element(3 * node + d) += v[d];
                    }
              }
          }

        const double before = energy(*simulation);
        // until the slow components have returned, too
        const double end = 2.5 * start * w / (c * c * q);
        while (state.time < end)
          simulation->run.scheme.step(state);

        const PublishedSet coefficients = published_set(set, rock);
        double             back = 0., all = 0.;
        for (unsigned int j = 0; j < weights.size(); ++j)
          {
            const double    wj = frequency(wavenumbers[j]);
            const Complex   damping(0.,
                                  wj * coefficients.dashpots * rock.density);
            const PlaneWave plane{wave,
                                  rock,
                                  coefficients.normal_spring / r +
                                    damping * rock.p_wave_speed(),
                                  coefficients.tangential_spring / r +
                                    damping * rock.s_wave_speed()};
            const auto [same, other] = plane.shares(wj, k);
            const double weight      = std::pow(weights[j] * wj, 2);
            back += weight * (same + other);
            all += weight;
          }
        return {energy(*simulation) / before, back / all};
      }

      static double
      energy(const Simulation &simulation)
      {
        const State &state = simulation.run.state;
        Vector force    = simulation.model.solid.discretization.create_vector(),
               momentum = state.velocity;
        simulation.model.solid.internal_force.apply(force, state.displacement);
        momentum.scale(simulation.model.solid.mass.mass);
        return 0.5 * (force * state.displacement + momentum * state.velocity);
      }

      static constexpr double wavelength = 100.; // of S [m]

      std::string         wave = "SH", sets = "viscous";
      std::vector<double> angles, distances{5.};
      double              tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<ReflectionAngle>
      registered("reflection at an angle",
                 "Energy that the absorbing boundary reflects.");
  } // namespace
} // namespace Voussoir
