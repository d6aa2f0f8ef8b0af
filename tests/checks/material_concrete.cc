#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Strain along x, pulled or pressed, without stress across. */
    NormalControls
    along_x(const double strain)
    {
      return {{{true, strain}, {}, {}}};
    }


    /** "a: b: c, ..." as numbers. */
    std::vector<std::vector<double>>
    rows(const std::string &text)
    {
      std::vector<std::vector<double>> result;
      for (const std::string &item : split_list(text))
        result.push_back(Utilities::string_to_double(split_list(item, ':')));
      return result;
    }


    /** Softening of a point on a path of uniaxial strain. */
    struct Softening
    {
      double peak   = 0.; // [Pa]
      double energy = 0.; // beyond the peak, per area [N/m]
      double balance;     // energy stored and lost over the work
    };

    /**
     * @param sign   1: tension, -1: compression
     * @param start  strain that is certainly before the peak
     * @param strain at the end of the path
     * @param rest   share of the peak to which the stress falls
     */
    Softening
    soften(const Material &material,
           const double    size,
           const double    sign,
           const double    start,
           const double    strain,
           const double    rest)
    {
      const double modulus = material.elastic_constants().young_modulus;
      PointTest    test(material, size, 1e-3);
      Softening    result;
      double       stress = 0., displacement = 0.;
      const auto   sample = [&] {
        const double now  = sign * test.stress[0][0];
        const double away = size * (sign * test.strain[0][0] - now / modulus);
        if (now >= result.peak)
          result.energy = 0.;
        else if (!(stress <= 1.001 * rest * result.peak))
          result.energy += 0.5 * (now + stress) * (away - displacement);
        keep_largest(result.peak, now);
        stress       = now;
        displacement = away;
      };
      advance(test, along_x(sign * start), 100, sample);
      advance(test, along_x(sign * strain), 20000, sample);
      result.balance = (test.stored + test.dissipated) / test.work;
      return result;
    }


    /**
     * Strength, and the energy that a crack and crushing take beyond the peak:
     * the area under the stress over the inelastic displacement of the cell.
     * This energy must not depend on the size of the cell.
     */
    class ConcreteEnergies : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", tensile_strength, "[Pa]");
        prm.add_parameter("Fracture energy", fracture_energy, "[N/m]");
        prm.add_parameter("Compressive strength", compressive_strength, "[Pa]");
        prm.add_parameter("Crushing energy", crushing_energy, "[N/m]");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        for (const double size : {0.25, 1., 4.})
          {
            std::ostringstream in_cell;
            in_cell << " in a cell of " << size << " m";
            const double limit =
              tensile_strength / material.elastic_constants().young_modulus;
            const double opening =
              8. * fracture_energy / (tensile_strength * size);
            report("pulled" + in_cell.str(),
                   soften(material, size, 1., limit, limit + opening, 0.),
                   tensile_strength,
                   fracture_energy,
                   verdicts);
            // the curve of GB 50010 ends at 5 % of the strength
            const double crushing =
              6. * crushing_energy / (compressive_strength * size);
            report("pressed" + in_cell.str(),
                   soften(material, size, -1., 1e-3, 3e-3 + crushing, 0.05),
                   compressive_strength,
                   crushing_energy,
                   verdicts);
          }
      }

    private:
      static void
      report(const std::string &name,
             const Softening   &softening,
             const double       strength,
             const double       energy,
             Verdicts          &verdicts)
      {
        verdicts.near("strength " + name,
                      1e-6 * softening.peak,
                      1e-6 * strength,
                      2e-4,
                      "MPa");
        verdicts.near("energy beyond the peak " + name,
                      1e-3 * softening.energy,
                      1e-3 * energy,
                      1e-3,
                      "kN/m");
        verdicts.near("energy stored and lost over the work " + name,
                      softening.balance,
                      1.,
                      1e-3);
      }

      double tensile_strength = 2e6, fracture_energy = 400.;
      double compressive_strength = 25e6, crushing_energy = 60e3;
    };

    // Reference: closed form
    const Registry<Check>::Add<ConcreteEnergies>
      energies("concrete energies", "Energy of cracks and crushing.");


    /** Stresses of a compression table between its points. */
    class CompressionTable : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points",
                          points,
                          "\"inelastic strain: stress [Pa], ...\"");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        const double modulus = material.elastic_constants().young_modulus;
        for (const double size : {0.25, 1., 4.})
          {
            PointTest test(material, size, 1e-3);
            for (const auto &point : rows(points))
              {
                advance(test, along_x(-point[0] - point[1] / modulus), 2000);
                std::ostringstream name;
                name << "stress at an inelastic strain of " << 1e3 * point[0]
                     << " mm/m in a cell of " << size << " m";
                verdicts.near(name.str(),
                              -1e-6 * test.stress[0][0],
                              1e-6 * point[1],
                              1e-5,
                              "MPa");
              }
          }
      }

    private:
      std::string points;
    };

    // Reference: closed form
    const Registry<Check>::Add<CompressionTable>
      table("compression table", "An own law in compression.");


    /**
     * The strain that remains without stress: a share of the inelastic strain,
     * which is the strain less sigma/E.
     */
    class IrreversibleStrain : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Share in tension", in_tension, "");
        prm.add_parameter("Share in compression", in_compression, "");
        prm.add_parameter("Fracture energy", fracture_energy, "[N/m]");
        prm.add_parameter("Tensile strength", tensile_strength, "[Pa]");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        unload(material, in_tension, {1.5e-4, 3e-4, 6e-4}, verdicts);
        unload(material, in_compression, {-1e-3, -2e-3, -6e-3}, verdicts);
        const double limit =
          tensile_strength / material.elastic_constants().young_modulus;
        for (const double size : {0.25, 1.})
          {
            std::ostringstream name;
            name << "energy of a crack in a cell of " << size << " m";
            const double opening =
              8. * fracture_energy / (tensile_strength * size);
            verdicts.near(
              name.str(),
              soften(material, size, 1., limit, limit + opening, 0.).energy,
              fracture_energy,
              1e-3,
              "N/m");
          }
      }

    private:
      static void
      unload(const Material            &material,
             const double               share,
             const std::vector<double> &strains,
             Verdicts                  &verdicts)
      {
        const double modulus = material.elastic_constants().young_modulus;
        PointTest    test(material, 1., 1e-3);
        for (const double strain : strains)
          {
            std::ostringstream name;
            name << " from a strain of " << 1e3 * strain << " mm/m";
            advance(test, along_x(strain), 4000);
            const double stress = test.stress[0][0],
                         stays  = share * (strain - stress / modulus);
            // where a straight line from here would end
            advance(test, along_x(0.8 * strain), 10);
            verdicts.near("strain that stays" + name.str(),
                          1e3 * strain *
                            (1. - 0.2 * stress / (stress - test.stress[0][0])),
                          1e3 * stays,
                          1e-5,
                          "mm/m");
            advance(test, along_x(stays), 10);
            verdicts.below("stress there over the one before" + name.str(),
                           test.stress[0][0] / stress,
                           1e-5);
            advance(test, along_x(strain), 10);
            verdicts.near("stress again" + name.str(),
                          1e-6 * test.stress[0][0],
                          1e-6 * stress,
                          1e-6,
                          "MPa");
          }
      }

      double in_tension = 0., in_compression = 0.;
      double fracture_energy = 250., tensile_strength = 2.5e6;
    };

    // Reference: closed form
    const Registry<Check>::Add<IrreversibleStrain>
      irreversible("irreversible strain", "Residual strain on unloading.");
  } // namespace
} // namespace Voussoir
