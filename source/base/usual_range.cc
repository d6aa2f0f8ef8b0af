#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>

#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A value outside the range by more than this factor is refused.
    constexpr double absurd = 1e30;


    struct Range
    {
      double from, to;
      bool   or_zero = false; // where it means "none"

      bool
      contains(const double value) const
      {
        return (from <= value && value <= to) || (or_zero && value == 0.);
      }

      /** In words, as "0 or 5 to 65". */
      std::string
      words() const
      {
        std::ostringstream text;
        text << (or_zero ? "0 or " : "") << from << " to " << to;
        return text.str();
      }

      /** The sentence at the end of a description. */
      std::string
      sentence() const
      {
        return " Usually " + words() + '.';
      }
    };


    // Ranges in the units of the entries. They include soil, concrete, rock and
    // steel, so that a value outside is a mistake rather than a rare material.
    const std::map<Usual, Range> &
    ranges()
    {
      static const std::map<Usual, Range> all{
        {Usual::modulus, {1e7, 1e12}},
        {Usual::density, {500., 10000.}},
        {Usual::expansion, {1e-6, 1e-4, true}},
        {Usual::tensile_strength, {1e4, 1e8}},
        {Usual::tensile_strength_or_none, {1e4, 1e8, true}},
        {Usual::compressive_strength, {1e5, 1e9}},
        {Usual::fracture_energy, {1., 1e5}},
        {Usual::crushing_energy, {100., 1e6}},
        {Usual::cohesion, {100., 1e9}},
        {Usual::cut_off, {100., 1e9}},
        {Usual::friction_angle, {5., 65., true}},
        {Usual::dilation_angle, {1., 65., true}},
        {Usual::wave_angle, {1., 89., true}},
        {Usual::water_density, {900., 1300.}},
        {Usual::water_gravity, {9.7, 9.9}},
        {Usual::sound_speed, {100., 2000.}},
        {Usual::silt_weight, {1e3, 2e4}},
        {Usual::silt_friction_angle, {5., 50., true}},
        {Usual::overload, {0.01, 20.}},
        {Usual::friction_coefficient, {0.05, 3., true}},
        {Usual::interface_cohesion, {100., 1e9, true}},
        {Usual::interface_tension, {1e3, 1e8, true}},
        {Usual::shear_fracture_energy, {1., 1e6}},
        {Usual::gap, {1e-6, 0.1, true}},
        {Usual::key_depth, {1e-4, 2., true}},
        {Usual::steel_modulus, {1e10, 1e12}},
        {Usual::steel_strength, {1e7, 1e10}},
        {Usual::bar_length, {1e-3, 100.}},
        {Usual::elevation, {-500., 9000.}},
        {Usual::acceleration, {-20., 20.}},
        {Usual::displacement, {-10., 10.}},
        {Usual::force, {-1e12, 1e12}},
        {Usual::pressure, {-1e9, 1e9}},
        {Usual::relaxation_time, {1e-6, 10., true}},
        {Usual::compression_coefficient, {100., 1e4}},
        {Usual::demand_capacity_ratio, {1., 20.}},
        {Usual::accumulated_time, {0., 60.}}};
      return all;
    }


    // ParameterHandler stores only the description with an entry, so the range
    // is read from the last sentence of the description. Null: there is none.
    const Range *
    range_of(const std::string &description)
    {
      static const auto by_sentence = [] {
        std::map<std::string, Range> result;
        for (const auto &quantity : ranges())
          result.emplace(quantity.second.sentence(), quantity.second);
        return result;
      }();
      const auto end = description.rfind(" Usually ");
      if (end == std::string::npos)
        return nullptr;
      const auto range = by_sentence.find(description.substr(end));
      return range == by_sentence.end() ? nullptr : &range->second;
    }


    // " Pa" for a description with "[Pa]", empty for one with "[-]".
    std::string
    unit_of(const std::string &description)
    {
      const auto end   = description.rfind(']'),
                 begin = description.rfind('[', end);
      if (end == std::string::npos || begin == std::string::npos)
        return "";
      const std::string unit = description.substr(begin + 1, end - begin - 1);
      return unit == "-" ? "" : " " + unit;
    }
  } // namespace


  std::string
  usually(const Usual quantity)
  {
    return ranges().at(quantity).sentence();
  }


  std::vector<std::string>
  unusual_values(const ParameterHandler &prm)
  {
    std::vector<std::string> result;
    const auto               check = [&](const std::string &entry,
                           const std::string &section,
                           const std::string &description,
                           const std::string &text) {
      const Range *range = range_of(description);
      if (range == nullptr)
        return;
      const double value = Utilities::string_to_double(text);
      if (range->contains(value))
        return;
      const std::string  unit = unit_of(description);
      std::ostringstream sentence;
      sentence << "\"" << entry << "\" in section \"" << section << "\" is "
               << value << unit << ", outside the usual range "
               << range->words() << unit;
      if (std::abs(value) >
            absurd * std::max(std::abs(range->from), range->to) ||
          (value > 0. && value < range->from / absurd))
        throw UserError(sentence.str() +
                        ", and nothing can be computed with it; correct it.");
      result.push_back(sentence.str() + "; check the unit");
    };

    const std::function<void(const nlohmann::json &, const std::string &)>
      collect = [&](const nlohmann::json &node, const std::string &section) {
        for (const auto &[name, child] : node.items())
          if (child.contains("value") && child["value"].is_string())
            for (const std::string &value :
                 Utilities::split_string_list(child["value"]))
              check(name, section, child["documentation"], value);
          else if (child.is_object())
            collect(child, section.empty() ? name : section + "/" + name);
      };
    std::ostringstream text;
    prm.print_parameters(text, ParameterHandler::JSON);
    collect(nlohmann::json::parse(text.str()), "");
    return result;
  }
} // namespace Voussoir
