#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/water_level.h>

namespace Voussoir
{
  using namespace dealii;

  void
  check_level(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const std::string              &place,
              const double                    level,
              const std::string              &entry,
              Log                            &log)
  {
    FaceNodes face_nodes(discretization.mapping,
                         discretization.fe.base_element(0));
    double    bottom = std::numeric_limits<double>::max(), top = -bottom;
    double    level_area = 0., upright_area = 0.; // in the horizontal direction
    for_each_face(discretization,
                  sets,
                  place,
                  [&](const auto &cell, const unsigned int face) {
                    for (const FaceNode &node : face_nodes.of(cell, face))
                      {
                        bottom = std::min(bottom, node.position[2]);
                        top    = std::max(top, node.position[2]);
                        level_area += std::abs(node.normal[2]) * node.area;
                        upright_area +=
                          std::hypot(node.normal[0], node.normal[1]) *
                          node.area;
                      }
                  });
    const MPI_Comm communicator = discretization.grid.communicator();
    bottom                      = Utilities::MPI::min(bottom, communicator);
    top                         = Utilities::MPI::max(top, communicator);
    const bool bed = Utilities::MPI::sum(level_area, communicator) >
                     Utilities::MPI::sum(upright_area, communicator);

    std::ostringstream text;
    text << entry << " is " << level << " m, but the faces \""
         << join(sets, "\", \"") << "\" ";
    if (level <= bottom)
      {
        text << "begin at z = " << bottom
             << " m, so that they stay dry; give an elevation z in the "
                "coordinates of the mesh, or leave out this section.";
        throw UserError(text.str());
      }
    if (!bed && level > top + 1e-6 * (top - bottom))
      {
        text << "end at z = " << top << " m, " << level - top
             << " m below; it should be an elevation z in the coordinates of "
                "the mesh";
        log.warn(text.str());
      }
  }
} // namespace Voussoir
