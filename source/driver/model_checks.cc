#include <voussoir/base/box_of_ranks.h>
#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/model_checks.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_parts.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  void
  check_parts(const Case              &parameters,
              const CoarseMesh        &solid,
              const InterfaceSurfaces &surfaces,
              Log                     &log)
  {
    const BoundaryParameters &boundaries = parameters.boundaries;
    std::vector<std::string>  fixed_sets;
    for (const Support &support : boundaries.supports_with_absorbing(false))
      fixed_sets.push_back(support.set);
    const auto parts = find_parts(solid, fixed_sets, surfaces.names());
    if (parts.size() == 1)
      return;
    std::vector<std::string> fixed, detached;
    for (const MeshPart &part : parts)
      (part.is_fixed ? fixed : detached).push_back(part.place);
    if (!fixed.empty() && !detached.empty() &&
        parameters.projections.objects.empty())
      throw UserError(
        "The part of the mesh around " + detached[0] +
        " m has no support: it shares no node with the rest, "
        "no interface joins it and no entry of section \"Boundaries\" "
        "names its faces; merge the nodes between the parts, "
        "or fix it.");
    fixed.insert(fixed.end(), detached.begin(), detached.end());
    fixed.resize(std::min<std::size_t>(fixed.size(), 10));
    log.warn("The mesh falls into ",
             parts.size(),
             " parts that share neither nodes nor interfaces, around ",
             join(fixed, ", "),
             " m; waves and forces do not pass between them.");
  }


  void
  report_sets_on_interfaces(const Case              &parameters,
                            const CoarseMesh        &solid,
                            const InterfaceSurfaces &surfaces,
                            Log                     &log)
  {
    std::set<std::pair<unsigned int, unsigned int>> sides;
    for (const std::string &surface : surfaces.names())
      for (const std::string &side : {surface, surface + other_side})
        for (const CoarseMesh::Face &face : solid.face_sets.at(side))
          sides.emplace(face.cell, face.face);

    std::vector<std::string> entries{"Boundaries/Fixed",
                                     "Boundaries/Roller",
                                     "Boundaries/Antisymmetric",
                                     "Boundaries/Absorbing"};
    for (const auto &load : parameters.loads.objects)
      entries.push_back("Loads/" + load.first + "/Face sets");
    for (const std::string &entry : entries)
      for (const std::string &set : split_list(parameters.file.given(entry)))
        if (const auto faces = solid.face_sets.find(set);
            faces != solid.face_sets.end() &&
            std::any_of(faces->second.begin(),
                        faces->second.end(),
                        [&](const CoarseMesh::Face &face) {
                          return sides.count({face.cell, face.face}) > 0;
                        }))
          log.warn("\"",
                   entry,
                   "\" names the face set \"",
                   set,
                   "\", which lies on an interface: the entry acts there on "
                   "one side only.");
  }


  void
  check_levels(const Case &parameters, const Reservoir *reservoir, Log &log)
  {
    BoxOfRanks box; // of the compressible water
    if (reservoir != nullptr)
      {
        for (const Point<3> &position : reservoir->space.node_positions)
          box.add(position);
        box.join(log.communicator());
      }
    const AddedMassParameters &mass          = parameters.reservoir.added_mass;
    const std::string          default_faces = AddedMassParameters().face_sets;
    std::map<std::string, double> waters, silts; // by section
    for (const auto &load : parameters.loads.objects)
      {
        const std::string section = "Loads/" + load.first;
        const std::string type    = parameters.file.given(section + "/Class");
        if (type != "water" && type != "silt")
          continue;
        const double level = Utilities::string_to_double(
          parameters.file.given(section + "/Level"));
        (type == "water" ? waters : silts)[section] = level;
        const auto faces                            = split_list(
          parameters.file.given(section + "/Face sets", default_faces));
        // a generated mesh moves the surface by up to a row of cells
        if (type == "water" && reservoir != nullptr &&
            faces == split_list(default_faces) &&
            std::abs(level - box.upper[2]) >
              0.1 * (box.upper[2] - box.lower[2]))
          log.warn("\"Level\" in section \"",
                   section,
                   "\" is ",
                   level,
                   " m, but the water of \"Reservoir\" reaches up to ",
                   box.upper[2],
                   " m");
        if (type == "water" &&
            parameters.reservoir.model == ReservoirModel::added_mass &&
            faces == split_list(mass.face_sets) && level != mass.level)
          log.warn("the water on the same faces stands at ",
                   level,
                   " m by \"Level\" in section \"",
                   section,
                   "\", but at ",
                   mass.level,
                   " m by \"Level\" in section \"Reservoir/added mass\"");
      }
    for (const auto &[silt, top] : silts)
      if (!waters.empty() &&
          std::all_of(waters.begin(), waters.end(), [&](const auto &water) {
            return water.second < top;
          }))
        log.warn("\"Level\" in section \"",
                 silt,
                 "\" is ",
                 top,
                 " m, above all water, but the \"Buoyant unit weight\" is "
                 "that of silt under water");
  }
} // namespace Voussoir
