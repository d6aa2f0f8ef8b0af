#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/softening_curve.h>

#include <deal.II/base/utilities.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  SofteningCurve::SofteningCurve(const std::vector<Node> &nodes,
                                 const double             young_modulus,
                                 const double             irreversible_share,
                                 const double             relief)
    : nodes(nodes)
    , young_modulus(young_modulus)
    , irreversible_share(irreversible_share)
    , stretch((1. - irreversible_share) / (1. - relief) + irreversible_share)
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (nodes[i].stress >= nodes[peak].stress)
        peak = i;
    // of the same energy between the same stresses
    const double first = nodes[peak].stress, last = nodes.back().stress;
    straight =
      first > last ? 2. * energy(nodes) / (first * first - last * last) : 1e30;
    // the strain must grow along the curve, with some steepness left
    widest          = 0.9 * young_modulus * straight;
    widest_of_curve = widest;
    for (unsigned int i = peak + 1; i < nodes.size(); ++i)
      widest_of_curve =
        std::min(widest_of_curve,
                 0.9 * young_modulus *
                   (nodes[i].displacement - nodes[i - 1].displacement) /
                   (nodes[i - 1].stress - nodes[i].stress));
    // a curve without displacements has no size
    if (energy(nodes) == 0.)
      widest = widest_of_curve = 1e30;
    inverse_limit       = 1. / nodes[0].stress;
    half_inverse_widest = 0.5 / widest;
  }


  double
  SofteningCurve::straightness(const double band) const
  {
    return band <= widest_of_curve ?
             0. :
             std::min(1.,
                      (band - widest_of_curve) / (widest - widest_of_curve));
  }


  SofteningCurve::Point
  SofteningCurve::at(const double strain, const double band) const
  {
    const double factor = strength_factor(band), share = straightness(band);
    const auto   strain_of = [&](const unsigned int i) {
      const Node  &node = nodes[i];
      const double line =
        i < peak ? 0. : straight * (nodes[peak].stress - node.stress);
      return factor * node.stress / young_modulus +
             stretch * (node.strain +
                        ((1. - share) * node.displacement + share * line) /
                          (factor * band));
    };
    double stress = young_modulus * strain;
    double before = strain_of(0);
    if (strain > before)
      {
        stress = factor * nodes.back().stress;
        for (unsigned int i = 1; i < nodes.size(); ++i)
          {
            const double after = strain_of(i);
            if (strain < after)
              {
                const double way = (strain - before) / (after - before);
                stress           = factor * ((1. - way) * nodes[i - 1].stress +
                                   way * nodes[i].stress);
                break;
              }
            before = after;
          }
      }
    const double inelastic    = (strain - stress / young_modulus) / stretch;
    const double irreversible = irreversible_share * inelastic;
    return {stress, inelastic, irreversible, strain - irreversible};
  }


  DamageProgress<double>
  SofteningCurve::go_on(const double equivalent_stress,
                        double      &largest,
                        const double band,
                        const double followed) const
  {
    const double before = std::max(largest, elastic_limit(band));
    const Point  old    = at(before, band);
    const double trial  = equivalent_stress / young_modulus + old.irreversible;
    if (trial <= before)
      return {1., largest == 0. ? 1. : 1. - old.damage(young_modulus), 0.};
    largest         = before + followed * (trial - before);
    const Point now = at(largest, band);

    // along straight pieces of the curve the work less what is stored is
    // (sigma_old e - sigma e_old)/2 + (sigma_old + sigma)/2 dp
    const double lost =
      0.5 * (old.stress * now.elastic - now.stress * old.elastic) +
      0.5 * (old.stress + now.stress) * (now.irreversible - old.irreversible);
    return {now.elastic / (largest - old.irreversible),
            1. - now.damage(young_modulus),
            lost / (0.5 * young_modulus * now.elastic * now.elastic)};
  }


  double
  SofteningCurve::energy(const std::vector<Node> &nodes)
  {
    double area = 0.;
    for (unsigned int i = 1; i < nodes.size(); ++i)
      area += 0.5 * (nodes[i].stress + nodes[i - 1].stress) *
              (nodes[i].displacement - nodes[i - 1].displacement);
    return area;
  }


  std::vector<SofteningCurve::Node>
  SofteningCurve::scaled_to(std::vector<Node> nodes, const double wanted)
  {
    const double factor = wanted / energy(nodes);
    for (Node &node : nodes)
      node.displacement *= factor;
    return nodes;
  }


  std::vector<SofteningCurve::Node>
  SofteningCurve::exponential(const double strength, const double energy)
  {
    std::vector<Node>  nodes;
    const unsigned int n = 24;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double share = std::pow(0.01, double(i) / (n - 1));
        nodes.push_back({strength * share, 0., -std::log(share)});
      }
    nodes.push_back({0., 0., nodes.back().displacement + 2.});
    return scaled_to(nodes, energy);
  }


  std::string
  SofteningCurve::remark(const double element_length) const
  {
    std::ostringstream text;
    text << std::setprecision(3) << "cells of up to " << element_length
         << " m are longer than ";
    if (element_length > widest)
      text << widest
           << " m, beyond which a crack would snap back; to keep the fracture "
              "energy their tensile strength is lowered by up to "
           << 100. * (1. - strength_factor(element_length)) << " %.";
    else if (element_length > widest_of_curve)
      text << widest_of_curve
           << " m, beyond which a crack would snap back at first; in them the "
              "stress falls in a straighter line, with the same strength and "
              "fracture energy.";
    else
      return {};
    return text.str();
  }


  std::vector<std::pair<double, double>>
  SofteningCurve::parse(const std::string &table, const std::string &place)
  {
    std::vector<std::pair<double, double>> result;
    for (const std::string &item : split_list(table))
      {
        const auto colon = item.find(':');
        try
          {
            if (colon == std::string::npos)
              throw std::invalid_argument(item);
            result.emplace_back(
              dealii::Utilities::string_to_double(item.substr(0, colon)),
              dealii::Utilities::string_to_double(item.substr(colon + 1)));
          }
        catch (const std::exception &)
          {
            throw UserError(place + ": \"" + item +
                            "\" is no pair of numbers; write pairs as in \"0: "
                            "2.9e6, 66e-6: 1.9e6\".");
          }
        if (result.size() == 1 ?
              result[0].first != 0. :
              result.back().first <= result[result.size() - 2].first)
          throw UserError(place +
                          ": the first numbers of the pairs must begin at 0 "
                          "and grow; look at \"" +
                          item + "\".");
        if (result.back().second < 0. ||
            (result.size() == 1 && result[0].second == 0.))
          throw UserError(place + ": the stress in \"" + item +
                          "\" must not be negative, and the first one not "
                          "0.");
      }
    if (result.size() < 2)
      throw UserError(place + ": give two pairs or more.");
    return result;
  }


  void
  TensileCrack::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Tensile strength",
                      tensile_strength,
                      "Uniaxial tensile strength ft [Pa].",
                      dealii::Patterns::Double(1.));
    prm.add_parameter("Fracture energy",
                      fracture_energy,
                      "Energy Gf that a crack takes per area [N/m].",
                      dealii::Patterns::Double(1e-3));
  }
} // namespace Voussoir
