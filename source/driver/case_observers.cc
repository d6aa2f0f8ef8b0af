// The section "Output" of a case and its observers.

#include <voussoir/base/parameter_section.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case.h>
#include <voussoir/output/material_memory.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Whether the file has a value for any entry of a handler. */
    bool
    gives_any(const ParameterFile &file, const ParameterHandler &prm)
    {
      std::ostringstream text;
      prm.print_parameters(text, ParameterHandler::JSON);
      const std::string nothing(1, '\0');
      const std::function<bool(const nlohmann::json &, const std::string &)>
        any = [&](const nlohmann::json &node, const std::string &path) {
          if (node.contains("value") && node["value"].is_string())
            return file.given(path, nothing) != nothing;
          for (const auto &[name, child] : node.items())
            if (child.is_object() &&
                any(child, path.empty() ? name : path + "/" + name))
              return true;
          return false;
        };
      return any(nlohmann::json::parse(text.str()), "");
    }
  } // namespace


  void
  OutputParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Folder",
      folder,
      "Folder of the results; empty for output/ and the name of "
      "the parameter file. A number is added if the folder "
      "exists.");
    prm.add_parameter(
      "Observers",
      observers,
      "Observers, which write results, in this order; each has a section of "
      "its name here.",
      Patterns::MultipleSelection(join(Registry<Observer>::names(), "|")));
    prm.add_parameter(
      "Observers for the verdict",
      for_verdict,
      "Adds observers that \"Observers\" does not name: over-stress where a "
      "linear elastic material has a tensile strength and through cracks "
      "where a material cracks, both if the mesh has an upstream and a "
      "downstream face; interfaces where the case has interfaces.");
    prm.add_parameter(
      "Energy interval",
      energy_interval,
      "Time between two lines of the energy balance [s]; 0 for every 50 "
      "steps. At least this often the run is checked for growth and NaN, and "
      "the losses by damping are summed up.",
      Patterns::Double(0.));
    prm.add_parameter(
      "Energy limit",
      energy_limit,
      "Energy-balance error, relative to the energy input, at which "
      "the run stops; the run warns from 0.01 on.",
      Patterns::Double(0., 1.));
    prm.add_parameter(
      "Checkpoint interval",
      checkpoint_interval,
      "Wall time between two checkpoints [min], from which --restart "
      "continues; 0 for none by wall time. SIGUSR1 requests a further "
      "checkpoint; SIGTERM, other signals to stop and a file named stop in "
      "the output folder request a checkpoint and the end of the run.",
      Patterns::Double(0.));
    prm.add_parameter(
      "Checkpoint time",
      checkpoint_time,
      "Simulated time between two checkpoints [s]; 0 for none by simulated "
      "time.",
      Patterns::Double(0.));
  }


  void
  Case::declare_unused_observers(const std::vector<std::string> &used)
  {
    for (const std::string &name : Registry<Observer>::names())
      {
        if (std::find(used.begin(), used.end(), name) != used.end())
          continue;
        const std::string place = "Output/" + name;
        ParameterHandler  own;
        in_section(own, place, [&] {
          Registry<Observer>::entries()[name].create()->declare_parameters(own);
        });
        // the parameters as run have no entries that the file does not give
        if (!gives_any(file, own))
          continue;
        in_section(prm, name, [&] {
          observers.declare_one(prm,
                                name,
                                place,
                                name,
                                "\"Observers\" in section \"Output\"",
                                false);
        });
        notes.push_back("section \"" + place +
                        "\" is not used, as \"Observers\" in section "
                        "\"Output\" does not name it");
      }
  }


  void
  Case::add_observers()
  {
    const auto is_off = [this](const std::string &entry) {
      const std::string setting = file.given(entry);
      return setting == "false" || setting == "no";
    };
    if (is_off("Output/Observers for the verdict"))
      return;
    std::string              strengths;
    bool                     cracks = false;
    std::vector<std::string> observers =
      split_list(file.given("Output/Observers", output.observers));
    for (const std::string &name : split_list(file.given("Materials/Names")))
      {
        const std::string place = "Materials/" + name,
                          type = file.given(place + "/Class", "linear elastic"),
                          strength = file.given(place + "/Tensile strength");
        if (Registry<Material>::entries().count(type) == 0)
          continue; // refused later
        if (type == "linear elastic" &&
            parse_number(strength).value_or(0.) > 0.)
          strengths += (strengths.empty() ? "" : "; ") + name + ": " + strength;
        cracks = cracks ||
                 reports_cracks(*Registry<Material>::entries()[type].create());
      }
    std::vector<std::string> changes;
    const auto               wants = [&](const std::string &name) {
      return std::find(observers.begin(), observers.end(), name) !=
             observers.end();
    };
    const auto add = [&](const std::string &name) {
      if (wants(name))
        return;
      added_observers.push_back(name);
      observers.push_back(name);
    };
    const std::string section = "Output/over-stress/";
    if (!strengths.empty() || !file.given(section + "Tensile strength").empty())
      add("over-stress");
    if (wants("over-stress") && !strengths.empty() &&
        file.given(section + "Tensile strength").empty() &&
        file.given(section + "Strengths of materials").empty())
      changes.push_back(section + "Strengths of materials=" + strengths);
    if (cracks)
      add("through cracks");
    for (const std::string &name : split_list(file.given("Interfaces/Names")))
      if (!is_off("Interfaces/" + name + "/Active"))
        add("interfaces");
    if (!added_observers.empty())
      changes.push_back("Output/Observers=" + join(observers, ", "));
    file = file.with(changes);
  }
} // namespace Voussoir
