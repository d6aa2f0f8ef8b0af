#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/added_mass.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string section = "section \"Reservoir/added mass\"";


    // One node of a wet face.
    struct Facet
    {
      types::global_dof_index node;
      double                  weight; // of the share of a hanging node
      double                  x, z;
      Tensor<1, 3>            normal;
      double                  area;
      double                  x_begin, x_end; // of its face
    };


    std::vector<Facet>
    facets_of(const Discretization           &discretization,
              const std::vector<std::string> &sets)
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
                      double begin = 1e300, end = -1e300;
                      for (unsigned int v = 0; v < 4; ++v)
                        {
                          begin =
                            std::min(begin, cell->face(face)->vertex(v)[0]);
                          end = std::max(end, cell->face(face)->vertex(v)[0]);
                        }
                      for (const FaceNode &node : face_nodes.of(cell, face))
                        for (const auto &share :
                             discretization.carriers(nodes[node.number]))
                          facets.push_back({share.node,
                                            share.weight,
                                            node.position[0],
                                            node.position[2],
                                            node.normal,
                                            node.area,
                                            begin,
                                            end});
                    });
      return facets;
    }


    // Where the water ends below, in upright sections across the valley.
    class Bed
    {
    public:
      Bed(const std::vector<Facet> &facets, const MPI_Comm communicator)
      {
        std::vector<std::pair<double, double>> mine;
        for (const Facet &facet : facets)
          mine.emplace_back(facet.x, facet.z);
        points = join_over_ranks(mine, communicator);
        std::sort(points.begin(), points.end());
        points.erase(std::unique(points.begin(), points.end()), points.end());
      }

      double
      lowest(const double begin, const double end) const
      {
        const double rim    = 1e-6 * (end - begin);
        double       result = 1e300;
        for (auto point = std::lower_bound(points.begin(),
                                           points.end(),
                                           std::make_pair(begin - rim, -1e300));
             point != points.end() && point->first <= end + rim;
             ++point)
          result = std::min(result, point->second);
        return result;
      }

    private:
      std::vector<std::pair<double, double>> points;
    };


    NodalTerms::Matrix
    direction_of(const Tensor<1, 3> &n, const std::string &direction)
    {
      NodalTerms::Matrix result;
      if (direction == "river")
        result[1][1] = n[1] * n[1];
      else
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int e = d; e < 3; ++e)
            if (direction == "normal" || d == e)
              result[d][e] = n[d] * n[e];
      return result;
    }
  } // namespace


  void
  AddedMassParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Face sets", face_sets, "Faces with water on them.");
    prm.add_parameter("Level", level, "Height of the water's surface, z [m].");
    prm.add_parameter(
      "Reduction",
      reduction,
      "Factor on the added mass; some practice takes half of it "
      "for arch dams.",
      Patterns::Double(0., 1.));
    prm.add_parameter(
      "Direction",
      direction,
      "Normal: the water resists motion along the face's normal, which couples "
      "x, y and z on slanted faces. Uncoupled: the diagonal of that only. "
      "River: motion in y only.",
      Patterns::Selection("normal|uncoupled|river"));
  }


  double
  add_westergaard_mass(const Discretization      &discretization,
                       const AddedMassParameters &parameters,
                       const double               density,
                       NodalTerms                &terms)
  {
    const std::vector<Facet> facets =
      facets_of(discretization, split_list(parameters.face_sets));
    const MPI_Comm communicator = discretization.grid.communicator();
    const Bed      bed(facets, communicator);

    std::vector<std::pair<types::global_dof_index, NodalTerms::Matrix>> records;
    double total = 0.;
    for (const Facet &facet : facets)
      if (facet.z < parameters.level)
        {
          const double H =
            parameters.level - bed.lowest(facet.x_begin, facet.x_end);
          const double h    = parameters.level - facet.z;
          const double mass = facet.weight * parameters.reduction * 7. / 8. *
                              density * std::sqrt(H * h) * facet.area;
          records.emplace_back(facet.node,
                               mass * direction_of(facet.normal,
                                                   parameters.direction));
          total += mass;
        }
    total = Utilities::MPI::sum(total, communicator);
    if (total == 0.)
      throw UserError("\"Level\" in " + section +
                      " lies below the faces with water on them; give the "
                      "height z of the water's surface.");
    for (const auto &[node, mass] : discretization.send_to_owners(records))
      terms.added_mass[terms.add_node(node)] += mass;
    return total;
  }
} // namespace Voussoir
