#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/reproducible_sum.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/added_mass.h>
#include <voussoir/loads/water_level.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string section = "section \"Reservoir/added mass\"";


    // Directions along the river, upwards, and across the valley.
    struct Axes
    {
      Tensor<1, 3> river, up, across;
    };


    // Where the resultant of the water pressure is zero, as in a tank, the
    // river is taken along y.
    Axes
    find_axes(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const double                    level)
    {
      FaceNodes           face_nodes(discretization.mapping,
                           discretization.fe.base_element(0));
      Tensor<1, 3>        thrust;
      double              area = 0.;
      std::vector<double> parts[4]; // of thrust and area
      for_each_face(discretization,
                    sets,
                    "\"Face sets\" in " + section,
                    [&](const auto &cell, const unsigned int face) {
                      for (const FaceNode &node : face_nodes.of(cell, face))
                        if (node.position[2] < level)
                          {
                            thrust -= node.area * node.normal;
                            area += node.area;
                            for (unsigned int d = 0; d < 3; ++d)
                              parts[d].push_back(-node.area * node.normal[d]);
                            parts[3].push_back(node.area);
                          }
                    });
      const MPI_Comm communicator = discretization.grid.communicator();
      if (discretization.reproducible)
        {
          for (unsigned int d = 0; d < 3; ++d)
            thrust[d] = reproducible_sum(parts[d], communicator);
          area = reproducible_sum(parts[3], communicator);
        }
      else
        {
          thrust = Utilities::MPI::sum(thrust, communicator);
          area   = Utilities::MPI::sum(area, communicator);
        }
      thrust[2] = 0.;
      const Tensor<1, 3> up({0., 0., 1.});
      const Tensor<1, 3> river = thrust.norm() > 1e-6 * area ?
                                   thrust / thrust.norm() :
                                   Tensor<1, 3>({0., 1., 0.});
      return {river, up, cross_product_3d(river, up)};
    }


    // One node of a wet face.
    struct Facet
    {
      types::global_dof_index node;
      double                  weight; // share in a hanging node, else one
      double                  place;  // across the valley
      double                  z;
      Tensor<1, 3>            normal;
      double                  area;
      double                  begin, end; // of its face, across the valley
    };


    std::vector<Facet>
    facets_of(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const Tensor<1, 3>             &across)
    {
      FaceNodes          face_nodes(discretization.mapping,
                           discretization.fe.base_element(0));
      std::vector<Facet> facets;
      for_each_face(discretization,
                    sets,
                    "\"Face sets\" in " + section,
                    [&](const auto &cell, const unsigned int face) {
                      const auto nodes = discretization.cell_nodes(
                        discretization.dof_cell(cell));
                      // an upright face along the river has no width across the
                      // valley
                      const double rim   = 1e-6 * cell->face(face)->diameter();
                      double       begin = 1e300, end = -1e300;
                      for (unsigned int v = 0; v < 4; ++v)
                        {
                          const double place =
                            across * cell->face(face)->vertex(v);
                          begin = std::min(begin, place - rim);
                          end   = std::max(end, place + rim);
                        }
                      for (const FaceNode &node : face_nodes.of(cell, face))
                        for (const auto &share :
                             discretization.carriers(nodes[node.number]))
                          facets.push_back({share.node,
                                            share.weight,
                                            across * node.position,
                                            node.position[2],
                                            node.normal,
                                            node.area,
                                            begin,
                                            end});
                    });
      return facets;
    }


    // Bottom of the water in upright sections across the valley.
    class Bed
    {
    public:
      Bed(const std::vector<Facet> &facets, const MPI_Comm communicator)
      {
        std::vector<std::pair<double, double>> mine;
        for (const Facet &facet : facets)
          mine.emplace_back(facet.place, facet.z);
        points = join_over_ranks(mine, communicator);
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
      }

      double
      lowest(const double begin, const double end) const
      {
        double result = 1e300;
        for (auto point = std::lower_bound(points.begin(),
                                           points.end(),
                                           std::make_pair(begin, -1e300));
             point != points.end() && point->first <= end;
             ++point)
          result = std::min(result, point->second);
        return result;
      }

    private:
      std::vector<std::pair<double, double>> points;
    };


    NodalTerms::Matrix
    direction_of(const Tensor<1, 3>      &n,
                 const AddedMassDirection direction,
                 const Axes              &axes)
    {
      const auto along = [&](const Tensor<1, 3> &axis) {
        return (n * axis) * (n * axis) * symmetrize(outer_product(axis, axis));
      };
      return direction == AddedMassDirection::river ?
               along(axes.river) :
             direction == AddedMassDirection::uncoupled ?
               along(axes.river) + along(axes.up) + along(axes.across) :
               symmetrize(outer_product(n, n));
    }
  } // namespace


  void
  AddedMassParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Face sets", face_sets, "Faces with water on them.");
    prm.add_parameter("Level",
                      level,
                      "Elevation of the water's surface, z [m]." +
                        usually(Usual::elevation));
    prm.add_parameter(
      "Reduction",
      reduction,
      "Factor on the added mass; some practice takes half of it "
      "for arch dams.",
      Patterns::Double(0., 1.));
    add_option(
      prm,
      "Direction",
      direction,
      "Normal: the water resists motion along the face's normal, which couples "
      "x, y and z on slanted faces. Uncoupled: motion along the river, across "
      "and upwards, each by itself. River: motion along the river only, the "
      "direction of the resultant of the water pressure.");
  }


  AddedMass
  westergaard_mass(const Discretization      &discretization,
                   const AddedMassParameters &parameters,
                   const double               density,
                   Log                       &log)
  {
    const auto sets = split_list(parameters.face_sets);
    check_level(discretization,
                sets,
                "\"Face sets\" in " + section,
                parameters.level,
                "\"Level\" in " + section,
                log);
    const Axes axes = find_axes(discretization, sets, parameters.level);
    const std::vector<Facet> facets =
      facets_of(discretization, sets, axes.across);
    const MPI_Comm communicator = discretization.grid.communicator();
    const Bed      bed(facets, communicator);

    std::vector<std::pair<types::global_dof_index, NodalTerms::Matrix>> records;
    AddedMass result{0., axes.river, {}};
    for (const Facet &facet : facets)
      if (facet.z < parameters.level)
        {
          const double H =
            parameters.level - bed.lowest(facet.begin, facet.end);
          const double h    = parameters.level - facet.z;
          const double mass = facet.weight * parameters.reduction * 7. / 8. *
                              density * std::sqrt(H * h) * facet.area;
          const NodalTerms::Matrix added =
            mass * direction_of(facet.normal, parameters.direction, axes);
          records.emplace_back(facet.node, added);
          result.mass += axes.river * (added * axes.river);
        }
    result.mass = Utilities::MPI::sum(result.mass, communicator);
    for (const auto &[node, mass] : discretization.send_to_owners(records))
      result.terms.push_back({node, {}, {}, mass});
    return result;
  }
} // namespace Voussoir
