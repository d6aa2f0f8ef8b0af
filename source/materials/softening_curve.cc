#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/softening_curve.h>

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
    , stretch(1. / (1. - relief))
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (nodes[i].stress >= nodes[peak].stress)
        peak = i;
    // straight line of the same energy between the same stresses
    const double first = nodes[peak].stress, last = nodes.back().stress;
    straight =
      first > last ? 2. * energy(nodes) / (first * first - last * last) : 1e30;
    // the strain must grow along the curve, with some steepness left
    widest          = 0.5 * snap_back * young_modulus * straight;
    widest_of_curve = widest;
    for (unsigned int i = peak + 1; i < nodes.size(); ++i)
      widest_of_curve =
        std::min(widest_of_curve,
                 0.5 * snap_back * young_modulus *
                   (nodes[i].displacement - nodes[i - 1].displacement) /
                   (nodes[i - 1].stress - nodes[i].stress));
    // a curve without displacements has no size
    if (energy(nodes) == 0.)
      widest = widest_of_curve = 1e30;
    inverse_limit       = 1. / nodes[0].stress;
    half_inverse_widest = 0.5 / widest;
  }


  SofteningCurve
  SofteningCurve::of_static_state(const double static_modulus,
                                  const double strength_increase) const
  {
    std::vector<Node> static_nodes = nodes;
    for (Node &node : static_nodes)
      node.stress /= strength_increase;
    SofteningCurve result(static_nodes,
                          static_modulus,
                          irreversible_share,
                          1. - 1. / stretch);
    result.is_followed_exactly = true;
    return result;
  }


  void
  SofteningCurve::hand_over(const double damage,
                            const double elastic_strain,
                            const double band,
                            CurveMemory &memory) const
  {
    const OfBand curve   = of_band(band);
    const double modulus = (1. - damage) * young_modulus;
    unsigned int node    = 1;
    while (node < nodes.size() &&
           curve.on_piece(node, curve.strain(node)).damage(young_modulus) <
             damage)
      ++node;
    const double before = curve.strain(node - 1);
    const Point  start  = curve.on_piece(node, before);
    if (node < nodes.size())
      {
        // sigma = (1 - d) E e, both linear on the piece
        const double after = curve.strain(node);
        const Point  end   = curve.on_piece(node, after);
        const double way   = (start.stress - modulus * start.elastic) /
                           (modulus * (end.elastic - start.elastic) -
                            (end.stress - start.stress));
        memory.position = before + way * (after - before);
      }
    else
      {
        // where the stress stays, the elastic strain grows in proportion
        const double elastic =
          start.stress > 0. ? start.stress / modulus : elastic_strain;
        memory.position = before + std::max(0., elastic - start.elastic) /
                                     (1. - irreversible_share);
      }
    memory.largest = memory.position;
    memory.last    = elastic_strain;
    memory.damage  = damage;
  }


  double
  SofteningCurve::straightness(const double band) const
  {
    return band <= widest_of_curve ?
             0. :
             std::min(1.,
                      (band - widest_of_curve) / (widest - widest_of_curve));
  }


  double
  SofteningCurve::OfBand::strain(const unsigned int node) const
  {
    const auto  &nodes = curve.nodes;
    const auto  &peak  = nodes[curve.peak];
    const Node  &at    = nodes[node];
    const double line =
      node < curve.peak ? 0. : curve.straight * (peak.stress - at.stress);
    return factor * at.stress / curve.young_modulus +
           curve.stretch *
             (at.strain + ((1. - share) * at.displacement + share * line) /
                            (factor * band));
  }


  SofteningCurve::Point
  SofteningCurve::OfBand::elastic(const double stress,
                                  const double strain) const
  {
    const double inelastic =
      (strain - stress / curve.young_modulus) / curve.stretch;
    // flow is relieved laterally in the same way as the opening
    const double irreversible =
      curve.irreversible_share * curve.stretch * inelastic;
    return {stress, inelastic, irreversible, strain - irreversible};
  }


  SofteningCurve::Point
  SofteningCurve::OfBand::on_piece(const unsigned int node,
                                   const double       at_strain) const
  {
    const auto &nodes = curve.nodes;
    if (node == 0)
      return elastic(curve.young_modulus * at_strain, at_strain);
    if (node == nodes.size())
      return elastic(factor * nodes.back().stress, at_strain);
    const double before = strain(node - 1), after = strain(node);
    const double way = (at_strain - before) / (after - before);
    return elastic(factor * ((1. - way) * nodes[node - 1].stress +
                             way * nodes[node].stress),
                   at_strain);
  }


  SofteningCurve::Point
  SofteningCurve::OfBand::at_node(const unsigned int node,
                                  const double       strain) const
  {
    return elastic(factor * curve.nodes[node].stress, strain);
  }


  unsigned int
  SofteningCurve::OfBand::piece_at(const double at_strain) const
  {
    // the strain grows along the curve
    unsigned int below = 0, above = curve.nodes.size();
    while (below < above)
      {
        const unsigned int middle = (below + above) / 2;
        if (at_strain >= strain(middle))
          below = middle + 1;
        else
          above = middle;
      }
    return below;
  }


  SofteningCurve::Point
  SofteningCurve::at(const double strain, const double band) const
  {
    const OfBand curve = of_band(band);
    return curve.on_piece(curve.piece_at(strain), strain);
  }


  DamageProgress<double>
  SofteningCurve::go_on(const double equivalent_stress,
                        CurveMemory &memory,
                        const double band,
                        const double followed,
                        const double held) const
  {
    const OfBand curve    = of_band(band);
    const bool   is_new   = memory.largest == 0.;
    const double limit    = curve.strain(0);
    const double largest  = is_new ? limit : memory.largest;
    double       position = is_new ? limit : memory.position;
    unsigned int node     = std::max(1U, curve.piece_at(position));
    const Point  old      = curve.on_piece(node, position);
    const double trial = equivalent_stress / young_modulus + old.irreversible;
    DamageProgress<double> progress;
    progress.intact = 1. - memory.damage;
    if (trial <= largest)
      {
        if (!is_new)
          memory.last = std::max(0., equivalent_stress / young_modulus);
        return progress;
      }
    memory.largest = largest + followed * (trial - largest);

    // from e_a, s_a; in the first step as if from the limit, or from where the
    // point was held
    const double strain      = memory.largest - old.irreversible;
    const double last        = is_new ? held * limit : memory.last;
    const double last_stress = progress.intact * young_modulus * last;

    // The energy of the curve and that of the step are linear along each piece,
    // as is their difference: continue until this difference vanishes.
    Point  now  = old;
    double used = 0.;
    for (;; ++node)
      {
        const bool is_last = node == nodes.size();
        double     end = is_last ? position + 10. + strain : curve.strain(node);
        const bool arrives =
          is_followed_exactly && (is_last || end >= memory.largest);
        if (arrives)
          end = memory.largest;
        // the piece ends in its node, whose strain is known
        const Point  far     = arrives || is_last ? curve.on_piece(node, end) :
                                                    curve.at_node(node, end);
        const double ds      = far.stress - now.stress,
                     de      = far.elastic - now.elastic,
                     dp      = far.irreversible - now.irreversible,
                     flowed  = now.irreversible - old.irreversible;
        const double missing = 0.5 * last_stress * strain - used -
                               0.5 * now.stress * (last - flowed);
        const double rate =
          0.5 * (now.stress * (de + dp) - ds * (now.elastic - last + flowed));
        if (!is_followed_exactly && (rate > missing || is_last))
          {
            // no energy is left where there is no stress
            const double way =
              rate > 0. ? std::max(0., std::min(1., missing / rate)) : 0.;
            position += way * (end - position);
            now = curve.on_piece(node, position);
            break;
          }
        used += 0.5 * (now.stress * de - ds * now.elastic) +
                0.5 * (now.stress + far.stress) * dp;
        position = end;
        now      = far;
        if (arrives)
          break;
      }
    memory.position    = position;
    const double flow  = now.irreversible - old.irreversible;
    const double after = strain - flow;
    memory.last        = after;
    progress.effective = after / strain;
    progress.intact    = now.stress / (young_modulus * after);
    const double lost =
      is_followed_exactly ?
        used :
        0.5 * (last_stress * strain - now.stress * last + now.stress * flow);
    progress.dissipation = lost / (0.5 * young_modulus * after * after);
    memory.damage        = 1. - progress.intact;
    return progress;
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
  SofteningCurve::remark(const double       element_length,
                         const std::string &what,
                         const std::string &strength) const
  {
    std::ostringstream text;
    text << std::setprecision(3) << "cells of up to " << element_length
         << " m are longer than ";
    if (element_length > widest)
      text << widest << " m, beyond which " << what
           << " would snap back; to keep its energy their " << strength
           << " is lowered by up to "
           << 100. * (1. - strength_factor(element_length)) << " %";
    else if (element_length > widest_of_curve)
      text << widest_of_curve << " m, beyond which " << what
           << " would snap back at first; in them the stress falls in a "
              "straighter line, with the same strength and energy";
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
        const auto colon  = item.find(':');
        const auto first  = parse_number(item.substr(0, colon));
        const auto second = parse_number(
          colon == std::string::npos ? "" : item.substr(colon + 1));
        if (!first || !second)
          throw UserError(place + ": \"" + item +
                          "\" is no pair of numbers; write pairs as in \"0: "
                          "2.9e6, 66e-6: 1.9e6\".");
        result.emplace_back(*first, *second);
        if (result.size() == 1 ?
              result[0].first != 0. :
              result.back().first <= result[result.size() - 2].first)
          throw UserError(place +
                          ": the first numbers of the pairs must begin at 0 "
                          "and grow; correct \"" +
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
                      "Uniaxial tensile strength ft [Pa]." +
                        usually(Usual::tensile_strength),
                      dealii::Patterns::Double(1.));
    prm.add_parameter("Fracture energy",
                      fracture_energy,
                      "Energy Gf that a crack takes per area [N/m]." +
                        usually(Usual::fracture_energy),
                      dealii::Patterns::Double(1e-3));
  }
} // namespace Voussoir
