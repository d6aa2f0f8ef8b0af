#include <voussoir/materials/tension_split.h>
#include <voussoir/output/material_memory.h>

#include <boost/math/tools/toms748_solve.hpp>

#include "check.h"
#include "crack_line.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar along z between two walls cools until a layer of it cracks. With
     * the static factor a, the traction t over the opening w and the width l of
     * the layer, the stress is that for which
     *
     *   L alpha T = w + L sigma/(a E) ,   sigma = t(w) ,
     *
     * with t = ft (1 - w ft/(2 Gf)) (linear) or ft exp(-w ft/Gf) (exponential).
     * Under Lee and Fenves' law the opening of the layer is its plastic opening
     * k plus the elastic strain due to its damage D = 1 - (t/ft)^q,
     *
     *   w = k + l (sigma / (1 - D) - sigma)/(a E) ,   t = ft exp(-k ft/Gf) .
     *
     * The strength increase acts in the earthquake only and does not change
     * this state.
     */
    class FixedBar : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Curve",
                          curve,
                          "Traction over opening.",
                          Patterns::Selection("linear|exponential|lee-fenves"));
        prm.add_parameter("Strength", strength, "ft of the layer [Pa].");
        prm.add_parameter("Energy", fracture_energy, "Gf of the layer [N/m].");
        prm.add_parameter("Damage ratio", ratio, "q of lee-fenves.");
        prm.add_parameter("Layer", layer, "Its ends on z [m].");
        prm.add_parameter("Length", length, "L [m].");
        prm.add_parameter("Cooling", cooling, "In all [K].");
        prm.add_parameter("Static factors",
                          factors,
                          "Static factors a, one after the other.");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of ft, 2 Gf/ft and Gf.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const double factor : factors)
          for (const bool at_once : {true, false})
            {
              std::string stages = "c0";
              for (unsigned int i = 1; i < 10; ++i)
                stages += (at_once ? ", c" : "; c") + std::to_string(i);
              std::vector<std::string> entries{"Static state/Stages=" + stages};
              for (const std::string material : {"sound", "weak"})
                entries.push_back("Materials/" + material +
                                  "/Static factor=" + std::to_string(factor));
              const auto parameters = make_case(file.with(entries));
              const auto simulation =
                make_simulation(*parameters, communicator);
              std::ostringstream name;
              name << "factor " << factor << ", "
                   << (at_once ? "one stage" : "ten stages") << ": ";
              compare(*simulation, factor, name.str(), verdicts);
            }
      }

    private:
      void
      compare(Simulation        &simulation,
              const double       factor,
              const std::string &name,
              Verdicts          &verdicts) const
      {
        const Material &sound = *simulation.model.solid.materials[0];
        const double modulus = factor * sound.elastic_constants().young_modulus,
                     free_strain = sound.expansion * cooling; // prevented

        const double below  = displacement_at(simulation, layer[0]),
                     above  = displacement_at(simulation, layer[1]);
        const double stress = modulus * (below / layer[0] + free_strain);
        const double width  = layer[1] - layer[0];
        const double opening =
          above - below - width * (stress / modulus - free_strain);

        const double share = remaining_share(modulus, free_strain);
        verdicts.below(name + "stress less " +
                         rounded(1e-6 * share * strength) +
                         " MPa, over the strength",
                       (stress - share * strength) / strength,
                       tolerance);
        const double wanted =
          share == 0. ? length * free_strain : opening_at(share, modulus);
        verdicts.near(
          name + "opening", 1e3 * opening, 1e3 * wanted, 2. * tolerance, "mm");
        const double area   = 0.25;
        const auto  &stages = simulation.static_state.summary.at("stages");
        verdicts.near(
          name + "energy of the crack",
          stages.back().at("dissipated by materials [J]").get<double>() / area,
          energy_at(share, modulus),
          2. * tolerance,
          "N/m");

        // without an earthquake
        Run &run = simulation.run;
        verdicts.below(name + "velocity afterwards [m/s]",
                       fastest_in_steps(run),
                       1e-7);
        double reported = 0.;
        for_each_crack(run.observed,
                       [&](const Discretization::Cell &,
                           const unsigned int,
                           const double,
                           const CrackOpening &crack) {
                         keep_largest(reported, crack.now());
                       });
        reported = Utilities::MPI::max(
          reported, simulation.model.solid.discretization.grid.communicator());
        // with lee-fenves the opening by damage follows the modulus
        if (curve != "lee-fenves" &&
            reports_cracks(*simulation.model.solid.materials[1]))
          verdicts.near(name + "opening reported",
                        1e3 * reported,
                        1e3 * wanted,
                        2. * tolerance,
                        "mm");
      }

      static std::string
      rounded(const double value)
      {
        std::ostringstream text;
        text << std::setprecision(4) << value;
        return text.str();
      }

      /** Mean u_z at this height, of a square of equal cells. */
      static double
      displacement_at(const Simulation &simulation, const double z)
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const double side = 0.5;
        double       sum = 0., weights = 0.;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &x = discretization.node_positions[node];
            if (std::abs(x[2] - z) > 1e-6)
              continue;
            double weight = 1.;
            for (const double place : {x[0], x[1]})
              if (place < 1e-6 || place > side - 1e-6)
                weight *= 0.5;
            weights += weight;
            sum += weight *
                   simulation.static_state.initial.displacement.local_element(
                     3 * node + 2);
          }
        const MPI_Comm communicator = discretization.grid.communicator();
        return Utilities::MPI::sum(sum, communicator) /
               Utilities::MPI::sum(weights, communicator);
      }

      /** w where t is this share of ft. */
      double
      opening_at(const double share, const double modulus) const
      {
        const double width = layer[1] - layer[0];
        if (curve == "linear")
          return 2. * fracture_energy / strength * (1. - share);
        const double opening = -std::log(share) * fracture_energy / strength;
        if (curve == "exponential")
          return opening;
        return opening + width * share * strength / modulus *
                           (std::pow(share, -ratio) - 1.);
      }

      /** Energy that the crack has dissipated at this opening, per area. */
      double
      energy_at(const double share, const double modulus) const
      {
        if (curve == "linear")
          return fracture_energy * (1. - share);
        double             opened = 0., last = 0.;
        const unsigned int n = 100000;
        // area below the traction over the opening, less the unloading
        for (unsigned int i = 1; i <= n; ++i)
          {
            const double from = 1. + (share - 1.) * (i - 1.) / n,
                         to   = 1. + (share - 1.) * double(i) / n;
            const double w    = opening_at(to, modulus);
            opened += 0.5 * (from + to) * strength * (w - last);
            last = w;
          }
        const double plastic = curve == "exponential" ?
                                 0. :
                                 -std::log(share) * fracture_energy / strength;
        return opened - 0.5 * share * strength * (last - plastic);
      }

      /** sigma / ft. */
      double
      remaining_share(const double modulus, const double free_strain) const
      {
        const auto missing = [&](const double share) {
          return opening_at(share, modulus) +
                 length * share * strength / modulus - length * free_strain;
        };
        if (missing(1.) >= 0.)
          return length * free_strain * modulus / (length * strength);
        if (curve == "linear" && missing(0.) <= 0.)
          return 0.;
        boost::uintmax_t steps = 200;
        const auto       found = boost::math::tools::toms748_solve(
          missing,
          1e-12,
          1.,
          boost::math::tools::eps_tolerance<double>(40),
          steps);
        return 0.5 * (found.first + found.second);
      }

      std::string         curve    = "linear";
      double              strength = 1.2e6, fracture_energy = 144., ratio = 1.2;
      std::vector<double> layer{1., 1.25}, factors{1., 0.67, 0.4};
      double              length = 2., cooling = 9., tolerance = 0.005;
    };

    // Reference: closed form
    const Registry<Check>::Add<FixedBar>
      registered("fixed bar",
                 "A bar between two walls that cools until a layer cracks.");
  } // namespace
} // namespace Voussoir
