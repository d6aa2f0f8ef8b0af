#include <voussoir/analysis/static_state.h>
#include <voussoir/base/error.h>
#include <voussoir/base/text.h>

#include <algorithm>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  void
  StaticParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Stages",
      stages,
      "Loads that act before the earthquake: stages separated by semicolons, "
      "in their order, with the names of loads separated by commas, as in "
      "\"weight; water, silt; temperature\". They remain constant from t = 0 "
      "on. A stage may have a name, that of the load combination after it, as "
      "in \"weight; usual: water, silt; winter: temperature\", under which its "
      "results are kept. Empty: no static stage.");
    add_option(
      prm,
      "Supports",
      supports,
      "Supports of the absorbing faces in the static stages: fixed, fixed "
      "along their normal (roller), or on the springs of the boundary. Their "
      "reactions are kept as forces when the faces begin to absorb.");
    prm.add_parameter(
      "Load increments",
      increments,
      "Least number of increments in which the loads of a stage grow where "
      "materials crack or yield in it, as cracks and plastic flow depend on "
      "the path; increments are halved where the return mapping of the "
      "materials requires it. Stages without cracks and yielding take one.",
      Patterns::Integer(1, 1000));
    prm.add_parameter("Relative tolerance",
                      tolerance,
                      "Residual of the static equations over the load.",
                      Patterns::Double(1e-14, 1e-2));
    prm.add_parameter("Rest tolerance",
                      rest,
                      "With interfaces: motion in a natural period over the "
                      "largest displacement at which dynamic relaxation has "
                      "converged.",
                      Patterns::Double(1e-12, 1e-2));
    prm.add_parameter(
      "Points",
      points,
      "Named points \"name: x y z\" [m], separated by \";\", whose "
      "displacement and stresses after each stage are in static_stages.csv. "
      "The item \"usual\": where the mesh has an \"upstream face\", the "
      "upstream edge of the crest at the crown and at its quarters, and the "
      "base of the crown. Empty: these and the points of the histories.");
    prm.add_parameter(
      "Face sets",
      faces,
      "Faces on which the extremes of principal, arch and cantilever stress "
      "after each stage are in static_stages.csv; see the observer \"face "
      "stresses\". Empty: \"upstream face\" and \"downstream face\", where the "
      "mesh has them.");
    prm.add_parameter("Keep in",
                      kept,
                      "Folder, beside that of the results, in which the static "
                      "state is kept for later runs with the same mesh, "
                      "materials, interfaces, boundaries and static loads. "
                      "Empty: no state is kept or taken.");
  }


  std::string
  StaticParameters::Stage::title() const
  {
    return name.empty() ? join(loads, ", ") : name;
  }


  std::vector<StaticParameters::Stage>
  StaticParameters::stage_list() const
  {
    std::vector<Stage> list;
    for (const std::string &item : split_list(stages, ';'))
      {
        Stage      stage;
        const auto colon = item.find(':');
        if (colon != std::string::npos)
          stage.name = Utilities::trim(item.substr(0, colon));
        for (const std::string &name : split_list(
               colon == std::string::npos ? item : item.substr(colon + 1)))
          if (std::find(left_out.begin(), left_out.end(), name) ==
              left_out.end())
            stage.loads.push_back(name);
        if (!stage.loads.empty())
          list.push_back(stage);
      }
    return list;
  }


  std::vector<std::vector<std::string>>
  StaticParameters::stage_names() const
  {
    std::vector<std::vector<std::string>> names;
    for (const Stage &stage : stage_list())
      names.push_back(stage.loads);
    return names;
  }


  void
  StaticParameters::check(const NamedLoads           &loads,
                          const InterfacesParameters &interfaces) const
  {
    std::vector<std::string> known;
    for (const auto &load : loads)
      known.push_back(load.first);
    for (const std::string &stage : Utilities::split_string_list(stages, ';'))
      if (split_list(stage.substr(stage.find(':') + 1)).empty())
        throw UserError("\"Stages = " + stages +
                        "\" in section \"Static state\" has a stage without a "
                        "load; name its loads, or remove its semicolon.");
    std::set<std::string> staged, titles;
    for (const auto &stage : stage_names())
      for (const std::string &name : stage)
        {
          if (std::find(known.begin(), known.end(), name) == known.end())
            throw UserError("\"Stages\" in section \"Static state\" names \"" +
                            name +
                            "\", which is not among the \"Names\" of "
                            "section \"Loads\"" +
                            known_names(name, known) + ".");
          if (!staged.insert(name).second)
            throw UserError("\"Stages\" in section \"Static state\" names \"" +
                            name + "\" twice; keep one of them.");
        }
    for (const Stage &stage : stage_list())
      if (!titles.insert(stage.title()).second)
        throw UserError("Two \"Stages\" in section \"Static state\" have the "
                        "name \"" +
                        stage.title() + "\"; rename one of them.");
    for (const auto &[name, load] : loads)
      if (load->steady() && staged.count(name) == 0)
        throw UserError("The load \"" + name +
                        "\" acts before the earthquake, but \"Stages\" in "
                        "section \"Static state\" does not name it; add it "
                        "there.");
    for (const auto &[name, load] : loads)
      if (load->over_time() && staged.count(name) > 0)
        throw UserError("The load \"" + name +
                        "\" has a \"Time function\", but \"Stages\" in "
                        "section \"Static state\" names it, where nothing "
                        "changes with time; leave one of them out.");
    const auto check_staged = [&](const std::string &name,
                                  const std::string &entry) {
      if (staged.count(name) == 0)
        throw UserError(
          entry + " names \"" + name +
          "\", which is not in the \"Stages\" of section \"Static state\"" +
          known_names(name, {staged.begin(), staged.end()}) + ".");
    };
    for (const InterfaceParameters &interface : interfaces.list)
      {
        const std::string &after = interface.grouted_after;
        const std::string  place = "section \"Interfaces/" + interface.name;
        if (!interface.uplift.comes_with.empty())
          check_staged(interface.uplift.comes_with,
                       "\"Comes with\" in " + place + "/Uplift\"");
        if (after.empty())
          continue;
        check_staged(after, "\"Grouted after\" in " + place + "\"");
        const auto last = stage_names().back();
        if (interface.uplift.given() &&
            std::find(last.begin(), last.end(), after) != last.end())
          throw UserError("The interface of " + place +
                          "\" is grouted after the last of the static stages, "
                          "so that its \"Uplift\" would come with the "
                          "earthquake; let a stage follow.");
      }
  }
} // namespace Voussoir
