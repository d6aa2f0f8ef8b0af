#include <voussoir/analysis/measured_shapes.h>
#include <voussoir/analysis/modal_model.h>
#include <voussoir/base/error.h>
#include <voussoir/base/text.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  void
  ModeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Number",
                      number,
                      "Number of the lowest natural modes to compute; 0: none. "
                      "Absorbing faces are fixed in the modes, and the moduli "
                      "are the given ones.",
                      Patterns::Integer(0, 1000));
    prm.add_parameter("Fixed materials",
                      fixed_materials,
                      "Materials that do not move in the modes, separated by "
                      "commas: rigid rock.");
    prm.add_parameter("Massless materials",
                      massless_materials,
                      "Materials that are elastic but without mass in the "
                      "modes, separated by commas.");
    add_option(
      prm,
      "Interfaces",
      interfaces,
      "Where the two sides of interfaces are tied in the modes: where they "
      "are closed in the static state, sliding or not, or everywhere. "
      "Elsewhere the sides move independently, without the bars across them.");
    add_option(
      prm,
      "Water",
      water,
      "None: an empty reservoir. By reservoir: the added mass of section "
      "\"Reservoir\" or, if its model is compressible, its cells of water as "
      "incompressible water. Incompressible: these cells, under any model. "
      "Compressible: these cells as compressible water; the reservoir then "
      "ends at a rigid wall, and has modes of its own.");
    prm.add_parameter("Measured points",
                      points,
                      "Places of \"Measured shapes\", named points \"name: x y "
                      "z\" [m] within the dam or rock, separated by \";\".");
    prm.add_parameter(
      "Measured shapes",
      shapes,
      "Measured mode shapes, separated by \";\", each with amplitudes in x, y or "
      "z at some of the points in any common unit, as in \"symmetric: crest y "
      "1, quarter y 0.6\". The summary has, for each, the mode of the largest "
      "modal assurance criterion and its frequency.");
    prm.add_parameter(
      "Relative tolerance",
      tolerance,
      "Residual |K phi - omega^2 M phi| over |K phi|; the error of the "
      "frequencies is much smaller.",
      Patterns::Double(1e-12, 1e-2));
  }


  bool
  ModeParameters::want_cells_of_water(
    const ReservoirParameters &reservoir) const
  {
    return number > 0 && (water == WaterInModes::incompressible ||
                          water == WaterInModes::compressible ||
                          (water == WaterInModes::by_reservoir &&
                           reservoir.model == ReservoirModel::compressible));
  }


  void
  ModeParameters::check(const std::vector<std::string> &materials,
                        const BoundaryParameters       &boundaries) const
  {
    if (number == 0)
      return;
    measured_shapes(*this);
    const auto check_names = [&](const std::string &entry,
                                 const std::string &names) {
      for (const std::string &name : split_list(names))
        if (std::find(materials.begin(), materials.end(), name) ==
            materials.end())
          throw UserError("\"" + entry + "\" in section \"Modes\" names \"" +
                          name +
                          "\", which is not among the \"Names\" of section "
                          "\"Materials\"" +
                          known_names(name, materials) + ".");
    };
    check_names("Fixed materials", fixed_materials);
    check_names("Massless materials", massless_materials);
    if (split_list(fixed_materials).empty() && boundaries.empty())
      throw UserError(
        "Section \"Modes\" asks for modes of a model "
        "without supports; name faces in section \"Boundaries\", or "
        "\"Fixed materials\" in section \"Modes\".");
  }
} // namespace Voussoir
