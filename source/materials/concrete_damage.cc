// Concrete that cracks in tension and is crushed in compression.

#include <voussoir/base/error.h>
#include <voussoir/base/option.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/lubliner_surface.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/split_damage.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    enum class TensionLaw
    {
      exponential,
      linear,
      gb_50010,
      table
    };

    OptionNames<TensionLaw>
    option_names(const TensionLaw)
    {
      return {{TensionLaw::exponential, "exponential"},
              {TensionLaw::linear, "linear"},
              {TensionLaw::gb_50010, "GB 50010"},
              {TensionLaw::table, "table"}};
    }


    enum class CompressionLaw
    {
      gb_50010,
      table
    };

    OptionNames<CompressionLaw>
    option_names(const CompressionLaw)
    {
      return {{CompressionLaw::gb_50010, "GB 50010"},
              {CompressionLaw::table, "table"}};
    }


    /**
     * A SplitDamage (after Faria, Oliver, Cervera 1998, with a split that has a
     * potential) of the effective stress s = C : (e - e_p). Each damage is
     * driven by the largest equivalent strain so far: in tension that of the
     * largest principal stress, in compression that of LublinerSurface
     * at s-. A share of the inelastic strain may be irreversible,
     * which makes e_p.
     */
    struct ConcreteDamage : SplitDamage, LublinerSurface
    {
      // e_p after the internal variables of a SplitDamage
      static constexpr unsigned int n_history = n_split_numbers + 6;

      double compressive_strength  = 25e6;
      double crushing_energy       = 30e3;
      double strength_increase     = 1.;
      double relaxation_time       = 0.;
      double irreversible_tension  = 0.;
      double irreversible_crushing = 0.;

      TensionLaw     tension_law     = TensionLaw::exponential;
      CompressionLaw compression_law = CompressionLaw::gb_50010;
      std::string    tension_table, compression_table;

      void
      declare_parameters(ParameterHandler &prm)
      {
        SplitDamage::declare_parameters(prm);
        prm.add_parameter("Compressive strength",
                          compressive_strength,
                          "Uniaxial compressive strength fc [Pa]." +
                            usually(Usual::compressive_strength),
                          Patterns::Double(1.));
        prm.add_parameter(
          "Crushing energy",
          crushing_energy,
          "Fracture energy in crushing, per area beyond the peak [N/m]." +
            usually(Usual::crushing_energy),
          Patterns::Double(1e-3));
        LublinerSurface::declare_parameters(prm);
        prm.add_parameter(
          "Strength increase",
          strength_increase,
          "Factor on strengths and fracture energies in an earthquake; codes "
          "give 1.2 to 1.3.",
          Patterns::Double(1., 5.));
        prm.add_parameter(
          "Relaxation time",
          relaxation_time,
          "Delay of damage, which raises the strength under fast loading [s]; "
          "0: rate-independent." +
            usually(Usual::relaxation_time),
          Patterns::Double(0.));
        add_option(prm,
                   "Tension law",
                   tension_law,
                   "Stress over the opening of a crack: exponential, linear, "
                   "the curve of the Chinese code GB 50010 scaled to the "
                   "fracture energy, or a table, which has its own strength "
                   "and energy.");
        prm.add_parameter("Tension table",
                          tension_table,
                          "Openings [m] and stresses [Pa], as in \"0: 2.9e6, "
                          "66e-6: 1.9e6, 480e-6: 0\".");
        add_option(prm,
                   "Compression law",
                   compression_law,
                   "The curve of GB 50010, linear up to 0.4 fc, its part "
                   "beyond the peak scaled to the crushing energy, or a "
                   "table.");
        prm.add_parameter("Compression table",
                          compression_table,
                          "Inelastic strains and stresses [Pa], as in \"0: "
                          "13e6, 1e-3: 24e6, 1e-2: 5e6\"; the same for all "
                          "sizes of cells.");
        prm.add_parameter(
          "Irreversible share in tension",
          irreversible_tension,
          "Share of the inelastic strain that stays when a crack is unloaded.",
          Patterns::Double(0., 0.95));
        prm.add_parameter("Irreversible share in compression",
                          irreversible_crushing,
                          "Share of the inelastic strain that stays on "
                          "unloading from crushing.",
                          Patterns::Double(0., 0.95));
      }

      void
      check(const std::string &place)
      {
        LublinerSurface::check();
        tension     = SofteningCurve(increased(tension_nodes(place)),
                                 young_modulus,
                                 irreversible_tension,
                                 lateral_relief(*this));
        compression = SofteningCurve(increased(compression_nodes(place)),
                                     young_modulus,
                                     irreversible_crushing);
      }

      void
      set_static(const double factor)
      {
        SplitDamage::set_static(factor, strength_increase);
        relaxation_time = 0.;
      }

      std::vector<SofteningCurve::Node>
      increased(std::vector<SofteningCurve::Node> nodes) const
      {
        for (auto &node : nodes)
          node.stress *= strength_increase;
        return nodes;
      }

      std::vector<SofteningCurve::Node>
      tension_nodes(const std::string &place) const
      {
        std::vector<SofteningCurve::Node> nodes;
        const double                      ft = tensile_strength;
        if (tension_law == TensionLaw::table)
          {
            for (const auto &[opening, stress] :
                 SofteningCurve::parse(tension_table,
                                       place + ", \"Tension table\""))
              nodes.push_back({stress, 0., opening});
            return nodes;
          }
        if (tension_law == TensionLaw::linear)
          nodes = {{ft, 0., 0.}, {0., 0., 1.}};
        else if (tension_law == TensionLaw::exponential)
          return SofteningCurve::exponential(ft, fracture_energy);
        else
          {
            // GB 50010-2010, C.2.3, stresses in MPa, to 40 times the strain of
            // the peak
            const double mpa = 1e-6 * ft, peak = 65e-6 * std::pow(mpa, 0.54),
                         a = 0.312 * mpa * mpa;
            for (double x = 1.; x < 40.; x *= 1.15)
              {
                const double stress = ft * x / (a * std::pow(x - 1., 1.7) + x);
                nodes.push_back(
                  {stress,
                   0.,
                   (x - 1.) * peak + (ft - stress) / young_modulus});
              }
            nodes.push_back({0., 0., 1.25 * nodes.back().displacement});
          }
        return SofteningCurve::scaled_to(nodes, fracture_energy);
      }

      std::vector<SofteningCurve::Node>
      compression_nodes(const std::string &place) const
      {
        std::vector<SofteningCurve::Node> nodes;
        if (compression_law == CompressionLaw::table)
          {
            for (const auto &[strain, stress] :
                 SofteningCurve::parse(compression_table,
                                       place + ", \"Compression table\""))
              nodes.push_back({stress, strain, 0.});
            return nodes;
          }
        // GB 50010-2010, C.2.4, stresses in MPa
        const double fc = compressive_strength, mpa = 1e-6 * fc,
                     peak = (700. + 172. * std::sqrt(mpa)) * 1e-6,
                     a    = std::max(0.1, 0.157 * std::pow(mpa, 0.785) - 0.905);
        const double elastic = young_modulus * peak;
        if (elastic < 1.1 * fc)
          throw UserError(
            place +
            ": \"Compressive strength\" is too high for its Young's modulus: "
            "by GB 50010 the strain at the peak would be elastic. Give a "
            "\"Compression table\".");
        const double n      = elastic / (elastic - fc);
        const auto   rising = [&](const double x) {
          return fc * n * x / (n - 1. + std::pow(x, n));
        };
        // the curve is taken as linear up to 0.4 fc
        double x = 0.4 * fc / elastic;
        while (rising(x) < 0.4 * fc)
          x *= 1.001;
        const double first     = x * peak - rising(x) / young_modulus;
        const auto   inelastic = [&](const double ratio, const double stress) {
          return ratio * peak - stress / young_modulus - first;
        };
        const unsigned int pieces = 12;
        for (unsigned int i = 0; i <= pieces; ++i)
          {
            const double ratio  = x + (1. - x) * i / pieces;
            const double stress = rising(ratio);
            nodes.push_back({stress, inelastic(ratio, stress), 0.});
          }
        const double                      at_peak = nodes.back().strain;
        std::vector<SofteningCurve::Node> falling{nodes.back()};
        for (double ratio = 1.1; ratio < 12.; ratio *= 1.15)
          {
            const double stress =
              fc * ratio / (a * (ratio - 1.) * (ratio - 1.) + ratio);
            falling.push_back(
              {stress,
               at_peak,
               std::max(inelastic(ratio, stress) - at_peak, 1e-6)});
          }
        falling.push_back(
          {0.05 * fc, at_peak, 1.5 * falling.back().displacement});
        falling = SofteningCurve::scaled_to(falling, crushing_energy);
        nodes.insert(nodes.end(), falling.begin() + 1, falling.end());
        return nodes;
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress,
                  const Number                   &element_length) const
      {
        const auto [smallest, largest] = principal_bounds(stress);
        return std::max(tension.yield_ratio(largest, element_length),
                        compression.yield_ratio(Number(-smallest *
                                                       (1. / (1. - alpha))),
                                                element_length));
      }

      /** Equivalent uniaxial compression of the principal stresses s-, largest
       *  first. */
      template <typename Number>
      Number
      equivalent_compression(const std::array<Number, 3> &pressed) const
      {
        Number first = 0., squares = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Number difference = pressed[i] - pressed[(i + 1) % 3];
            first += pressed[i];
            squares += difference * difference; // 6 J2
          }
        // gamma = 3: Kc = 2/3
        return LublinerSurface::equivalent_compression(first,
                                                       Number(std::sqrt(Number(
                                                         0.5 * squares))),
                                                       Number(3. * pressed[0]));
      }

      /** Share of the delayed growth of damage that takes place in this step.
       */
      template <typename Number>
      double
      followed(const PointSituation<Number> &situation) const
      {
        return relaxation_time == 0. ?
                 1. :
                 situation.time_step / (relaxation_time + situation.time_step);
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number>   &situation) const
      {
        Number                        *flowed  = history + n_split_numbers;
        const SymmetricTensor3<Number> plastic = tensor_of(flowed);
        const SymmetricTensor3<Number> elastic = strain - plastic;
        const auto           split = split_tension(stress(elastic), *this);
        const OfBoth<Number> equivalent{
          {split.principal.values[0],
           equivalent_compression(split.compression)}};
        const OfBoth<double> irreversible{
          {irreversible_tension, irreversible_crushing}};
        const OfBoth<DamageProgress<Number>> damage{
          {grow_crack(equivalent[0],
                      history,
                      situation,
                      followed(situation),
                      irreversible[0] > 0.),
           grow(1,
                equivalent[1],
                history + n_of_curve,
                situation,
                followed(situation),
                irreversible[1] > 0.)}};
        OfBoth<SymmetricTensor3<Number>> effective =
          parts(split, history, situation.crack_normal);
        for (const unsigned int sign : {0, 1})
          effective[sign] = damage[sign].effective * effective[sign];
        PointResponse<Number> result =
          response(effective,
                   damage,
                   this->strain(effective[0] + effective[1]));
        if (irreversible_tension > 0. || irreversible_crushing > 0.)
          flow(strain, plastic, damage, flowed, result);
        return result;
      }

      /** Adds the plastic strain of the step. */
      template <typename Number>
      static void
      flow(const SymmetricTensor3<Number>       &strain,
           const SymmetricTensor3<Number>       &plastic_before,
           const OfBoth<DamageProgress<Number>> &damage,
           Number                               *plastic,
           PointResponse<Number>                &response)
      {
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          if (lane_of(damage[0].effective, lane) *
                lane_of(damage[1].effective, lane) !=
              1.)
            for (unsigned int i = 0; i < 6; ++i)
              {
                const double flowed =
                  lane_of(strain.access_raw_entry(i), lane) -
                  lane_of(response.elastic_strain.access_raw_entry(i), lane);
                lane_of(response.plastic_increment.access_raw_entry(i), lane) =
                  flowed - lane_of(plastic_before.access_raw_entry(i), lane);
                lane_of(plastic[i], lane) = flowed;
              }
      }

      static std::vector<std::string>
      output_names()
      {
        return {OutputName::tension_damage,
                OutputName::compression_damage,
                OutputName::largest_opening};
      }

      std::vector<double>
      outputs(const double *history, const double element_length) const
      {
        return {damage_of(history, 0),
                damage_of(history, 1),
                1e3 * largest_opening(history, element_length)};
      }
    };

    const Registry<Material>::Add<MaterialOf<ConcreteDamage>>
      registered_concrete_damage(
        "concrete damage",
        "Concrete with damage in tension and compression of the effective "
        "stress; closing cracks regain their stiffness.");
  } // namespace
} // namespace Voussoir
