#include <voussoir/base/parameter_section.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/random_classes.h>
#include <voussoir/driver/summary_numbers.h>
#include <voussoir/materials/material.h>

#include <nlohmann/json.hpp>

#include <set>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::set<std::string>
      moduli{"Young's modulus", "E1", "E2", "E3", "G12", "G13", "G23"},
      strengths{"Cohesion",
                "Strength",
                "Tensile strength",
                "Compressive strength",
                "Yield strength in compression",
                "Tension cut-off"};


    /** Entries that name materials, in a list. */
    constexpr std::array<const char *, 3> lists_of_materials{
      {"Materials/Names", "Modes/Fixed materials", "Modes/Massless materials"}};


    /** Entries above zero by which a material has a random field. */
    std::vector<std::string>
    variations_given(const ParameterFile &file, const std::string &section)
    {
      std::vector<std::string> result;
      for (const char *const name : {"Modulus variation", "Strength variation"})
        if (const std::string entry = section + "/Random field/" + name;
            !file.given(entry).empty())
          result.push_back(entry);
      return result;
    }


    std::string
    scaled(const std::string &number, const double factor)
    {
      return number_text(parse_number(number).value() * factor);
    }


    /** Changes of entries for one class of a material. */
    std::vector<std::string>
    entries_of_class(const std::string                        &section,
                     const std::map<std::string, std::string> &values,
                     const RandomFieldParameters              &field,
                     const unsigned int                        part)
    {
      std::vector<std::string> result{
        section + "/Random field/Part=" + std::to_string(part)};
      for (const auto &[entry, value] : values)
        for (const auto &[names, variation] :
             {std::pair(&moduli, field.modulus_variation),
              std::pair(&strengths, field.strength_variation)})
          if (names->count(entry) > 0 && variation > 0.)
            result.push_back(
              section + "/" + entry + "=" +
              scaled(value,
                     factor_of_class(part - 1, field.n_classes, variation)));
      return result;
    }
  } // namespace


  ParameterFile
  with_random_classes(const ParameterFile &file)
  {
    ParameterFile                                   result = file;
    std::map<std::string, std::vector<std::string>> classes;
    for (const std::string &name : split_list(file.given("Materials/Names")))
      {
        const std::string section = "Materials/" + name,
                          type =
                            file.given(section + "/Class", "linear elastic");
        const auto &known = Registry<Material>::entries();
        // an unknown class is refused later
        if (variations_given(file, section).empty() || known.count(type) == 0)
          continue;
        const auto       material = known.at(type).create();
        ParameterHandler prm;
        in_section(prm, section, [&] { material->declare_parameters(prm); });
        file.parse_declared(prm);
        const RandomFieldParameters &field = material->random_field;
        if (!field.wanted())
          continue;
        std::ostringstream text;
        prm.print_parameters(text, ParameterHandler::JSON);
        const auto entries = nlohmann::json::parse(text.str());
        std::map<std::string, std::string> values;
        for (const auto &[entry, item] :
             entries.at("Materials").at(name).items())
          {
            if (!item.contains("value") || !item.at("value").is_string())
              continue;
            const std::string value = item.at("value");
            if (field.strength_variation > 0. && value == "table")
              throw UserError("\"Strength variation\" in section \"" + section +
                              "/Random field\" does not vary a table; choose "
                              "another \"" +
                              entry + "\".");
            if (parse_number(value))
              values[entry] = value;
          }
        std::vector<std::string> copies, changes;
        for (unsigned int part = 1; part <= field.n_classes; ++part)
          {
            classes[name].push_back(name + " " + std::to_string(part));
            copies.push_back("Materials/" + classes[name].back());
            for (const std::string &change :
                 entries_of_class(copies.back(), values, field, part))
              changes.push_back(change);
          }
        result = result.with_copies(section, copies).with(changes);
      }
    if (classes.empty())
      return file;

    std::vector<std::string> changes;
    for (const std::string list : lists_of_materials)
      {
        std::vector<std::string> names;
        for (const std::string &name : split_list(file.given(list)))
          if (const auto parted = classes.find(name); parted != classes.end())
            names.insert(names.end(),
                         parted->second.begin(),
                         parted->second.end());
          else
            names.push_back(name);
        if (!names.empty())
          changes.push_back(list + "=" + join(names, ", "));
      }
    return result.with(changes);
  }


  ParameterFile
  without_random_fields(const ParameterFile &file)
  {
    std::vector<std::string> changes;
    for (const std::string &name : split_list(file.given("Materials/Names")))
      for (const std::string &entry :
           variations_given(file, "Materials/" + name))
        changes.push_back(entry + "=0");
    return file.with(changes);
  }


  RandomClasses::RandomClasses(const CoarseMesh &mesh)
    : mesh(mesh)
  {}


  bool
  RandomClasses::holds(const RandomFieldParameters &parameters,
                       const unsigned int           cell)
  {
    if (parameters.part == 0)
      return true;
    const auto key   = std::pair(parameters.seed, parameters.lengths);
    auto       found = fields.find(key);
    if (found == fields.end())
      found =
        fields
          .emplace(key,
                   Values{RandomField(parameters.lengths, parameters.seed), {}})
          .first;
    auto &[field, of_cell] = found->second;
    auto value             = of_cell.find(cell);
    if (value == of_cell.end())
      {
        Point<3> centre;
        for (const unsigned int corner : mesh.cells[cell])
          centre += 0.125 * mesh.vertices[corner];
        value = of_cell.emplace(cell, field(centre)).first;
      }
    return random_class(value->second, parameters.n_classes) + 1 ==
           parameters.part;
  }
} // namespace Voussoir
