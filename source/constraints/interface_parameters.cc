#include <voussoir/base/active.h>
#include <voussoir/base/gravity.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/interface_parameters.h>
#include <voussoir/mesh/interfaces.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Whether @p name is @p pattern, in which "*" stands for anything. */
    bool
    matches(const std::string_view name, const std::string_view pattern)
    {
      if (pattern.empty())
        return name.empty();
      if (pattern[0] != '*')
        return !name.empty() && name[0] == pattern[0] &&
               matches(name.substr(1), pattern.substr(1));
      for (std::size_t skipped = 0; skipped <= name.size(); ++skipped)
        if (matches(name.substr(skipped), pattern.substr(1)))
          return true;
      return false;
    }


    std::string
    section(const InterfaceParameters &interface)
    {
      return "Interfaces/" + interface.name;
    }
  } // namespace


  void
  UpliftParameters::declare(ParameterHandler &prm)
  {
    prm.enter_subsection("Uplift");
    prm.add_parameter("Upstream faces",
                      upstream_faces,
                      "Face sets from which water enters the interface; empty "
                      "for no pressure inside.");
    prm.add_parameter("Downstream faces",
                      downstream_faces,
                      "Face sets at which water leaves the interface.");
    prm.add_parameter("Upstream level",
                      upstream_level,
                      "Elevation of the water at the upstream faces [m]." +
                        usually(Usual::elevation));
    prm.add_parameter("Downstream level",
                      downstream_level,
                      "Elevation of the water at the downstream faces [m].");
    prm.add_parameter(
      "Drain position",
      drain_position,
      "Position of a line of drains, as a share of the distance from the "
      "upstream to the downstream faces.",
      Patterns::Double(0., 1.));
    prm.add_parameter(
      "Drain factor",
      drain_factor,
      "Excess of the pressure at the drains over the downstream pressure, as a "
      "share of the excess at the upstream faces; pressure is linear between "
      "faces and drains. 1 at position 0 for no drains.",
      Patterns::Double(0., 1.));
    prm.add_parameter("Density",
                      density,
                      "Density of the water [kg/m3]." +
                        usually(Usual::water_density),
                      Patterns::Double(0.));
    prm.add_parameter("Comes with",
                      comes_with,
                      "A load: the pressure inside begins with the static "
                      "stage that names this load. Empty: with the stage of "
                      "the first load of class \"water\"; without such a "
                      "stage, from the start.");
    prm.leave_subsection();
  }


  bool
  UpliftParameters::given() const
  {
    return !split_list(upstream_faces).empty();
  }


  double
  UpliftParameters::pressure(const double elevation, const double share) const
  {
    const auto head = [&](const double level) {
      return density * standard_gravity * std::max(0., level - elevation);
    };
    const double upstream   = head(upstream_level),
                 downstream = head(downstream_level);
    const double at_drain = downstream + drain_factor * (upstream - downstream);
    if (share < drain_position)
      return upstream + (at_drain - upstream) * share / drain_position;
    if (share >= 1.)
      return downstream;
    return at_drain + (downstream - at_drain) * (share - drain_position) /
                        (1. - drain_position);
  }


  void
  InterfaceParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Face sets",
                      face_sets,
                      "Sets of inner faces along which the mesh is split, each "
                      "a surface with its own results; \"*\" stands for any "
                      "part of a name, as in \"joint *\".");
    prm.add_parameter("Between",
                      between,
                      "Two cell sets, instead of \"Face sets\": the faces "
                      "between them are the surface, under the name of the "
                      "interface.");
    prm.add_parameter("Initial gap",
                      initial_gap,
                      "Opening at the start, or after grouting; an interface "
                      "with a gap has no bond [m]." +
                        usually(Usual::gap),
                      Patterns::Double(0.));
    prm.add_parameter(
      "Grouted after",
      grouted_after,
      "A load: until the end of the static stage that names it, the interface "
      "transmits no force, and its sides move independently. Opening and slip "
      "count from the end of that stage. Empty: joined from the start.");
    prm.add_parameter(
      "Tied after grouting",
      tied,
      "Once grouted, or from the start, the two sides of the interface are one "
      "body that neither opens nor slips, under any law and with any bars: for "
      "linear analyses of a dam whose blocks stand free under their weight.");
    prm.add_parameter(
      "Key depth",
      key_depth,
      "Depth of shear keys, which prevent slip while the opening is smaller; "
      "0 for none [m]." +
        usually(Usual::key_depth),
      Patterns::Double(0.));
    prm.add_parameter(
      "Steel ratio",
      steel_ratio,
      "Cross-section of the bars across the interface over its area; 0 for "
      "none.",
      Patterns::Double(0., 1.));
    prm.add_parameter("Steel modulus",
                      steel_modulus,
                      "Young's modulus of the bars [Pa]." +
                        usually(Usual::steel_modulus),
                      Patterns::Double(0.));
    prm.add_parameter("Free length",
                      free_length,
                      "Length over which the bars stretch [m]." +
                        usually(Usual::bar_length),
                      Patterns::Double(1e-6));
    prm.add_parameter("Yield stress",
                      yield_stress,
                      "Stress at which the bars yield, in tension and "
                      "compression [Pa]." +
                        usually(Usual::steel_strength),
                      Patterns::Double(0.));
    uplift.declare(prm);
    law->declare_parameters(prm);
  }


  void
  InterfaceParameters::check() const
  {
    const std::string place = section(*this);
    if (split_list(face_sets).empty() == split_list(between).empty())
      throw UserError("Section \"" + place +
                      "\" needs either \"Face sets\" or \"Between\"; give one "
                      "of the two.");
    if (!between.empty() && split_list(between).size() != 2)
      throw UserError("\"Between\" in section \"" + place +
                      "\" needs two cell sets, separated by a comma.");
    if (tied && initial_gap > 0.)
      throw UserError("Section \"" + place +
                      "\" has both an \"Initial gap\" and \"Tied after "
                      "grouting\"; leave one of them out.");
    if (initial_gap > 0. && law->strength({initial_gap, 0.}).tension > 0.)
      throw UserError("\"Initial gap\" in section \"" + place +
                      "\" leaves no bond, but that of \"Law\" there would "
                      "hold across it; set \"Law = friction\" with what the "
                      "bond leaves, or \"Initial gap = 0\".");
    if (uplift.given() == split_list(uplift.downstream_faces).empty())
      throw UserError("Section \"" + place +
                      "/Uplift\" needs both \"Upstream faces\" and "
                      "\"Downstream faces\", or none of them.");
    if (uplift.drain_position == 0. && uplift.drain_factor < 1.)
      throw UserError("\"Drain factor\" in section \"" + place +
                      "/Uplift\" is below 1, but \"Drain position\" there is "
                      "0, the upstream faces; give the position of the drains, "
                      "or leave out the factor.");
    law->check(place);
  }


  void
  InterfacesParameters::declare(ParameterHandler    &prm,
                                const ParameterFile &file)
  {
    const auto names  = Registry<InterfaceLaw>::names();
    const auto chosen = split_list(file.given("Interfaces/Names"));
    prm.enter_subsection("Interfaces");
    prm.declare_entry("Names",
                      "",
                      Patterns::Anything(),
                      "Names of the interfaces, separated by commas; each has "
                      "a section of that name here.");
    for (const std::string &name : chosen)
      {
        const std::string place = "Interfaces/" + name;
        prm.enter_subsection(name);
        prm.declare_entry("Law",
                          "friction",
                          Patterns::Selection(join(names, "|")),
                          "Law of the strength; some entries depend on it.");
        InterfaceParameters interface;
        interface.name = name;
        interface.law =
          Registry<InterfaceLaw>::create(file.given(place + "/Law", "friction"),
                                         "\"Law\" in section \"" + place +
                                           "\"");
        (declared_active(prm, file, place) ? list : inactive)
          .push_back(std::move(interface));
        prm.leave_subsection();
      }
    // the entries refer to elements of this vector, whose addresses are final
    // only now
    for (auto *interfaces : {&list, &inactive})
      for (InterfaceParameters &interface : *interfaces)
        {
          prm.enter_subsection(interface.name);
          interface.declare(prm);
          prm.leave_subsection();
        }
    prm.leave_subsection();
  }


  void
  InterfacesParameters::check() const
  {
    for (auto one = list.begin(); one != list.end(); ++one)
      {
        for (auto other = list.begin(); other != one; ++other)
          if (one->name == other->name)
            throw UserError("\"Names\" in section \"Interfaces\" lists \"" +
                            one->name + "\" twice; keep one of the two.");
        one->check();
      }
  }


  InterfaceSurfaces
  InterfacesParameters::split(CoarseMesh &mesh) const
  {
    InterfaceSurfaces result;
    for (const InterfaceParameters &interface : list)
      {
        const std::string place = "section \"" + section(interface) + "\"";
        std::vector<std::string> &surfaces = result.of_interface.emplace_back();
        if (const auto sets = split_list(interface.between); !sets.empty())
          {
            if (mesh.face_sets.count(interface.name) > 0)
              throw UserError("The mesh has a face set \"" + interface.name +
                              "\" already; give the interface another name, or "
                              "\"Face sets\" instead of \"Between\" in " +
                              place + ".");
            mesh.face_sets[interface.name] =
              faces_between(mesh, sets[0], sets[1], "\"Between\" in " + place);
            surfaces.push_back(interface.name);
          }
        for (const std::string &pattern : split_list(interface.face_sets))
          {
            std::vector<std::string> known;
            bool                     found = false;
            for (const auto &set : mesh.face_sets)
              {
                known.push_back(set.first);
                if (matches(set.first, pattern))
                  {
                    found = true;
                    surfaces.push_back(set.first);
                  }
              }
            if (!found)
              throw UserError("\"Face sets\" in " + place + " names \"" +
                              pattern + "\", which the mesh does not have" +
                              known_names(pattern, known) + ".");
          }
      }
    const auto all = result.names();
    for (auto name = all.begin(); name != all.end(); ++name)
      if (std::find(all.begin(), name, *name) != name)
        throw UserError("The face set \"" + *name +
                        "\" is in two interfaces of section \"Interfaces\"; "
                        "name it in one only.");
    if (!all.empty())
      split_interfaces(mesh, all, "Section \"Interfaces\"");
    return result;
  }


  std::vector<std::string>
  InterfaceSurfaces::names() const
  {
    std::vector<std::string> all;
    for (const auto &surfaces : of_interface)
      all.insert(all.end(), surfaces.begin(), surfaces.end());
    return all;
  }
} // namespace Voussoir
