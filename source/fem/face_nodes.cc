#include <voussoir/fem/face_nodes.h>

#include <deal.II/base/quadrature_lib.h>

namespace Voussoir
{
  using namespace dealii;

  FaceNodes::FaceNodes(const Mapping<3>       &mapping,
                       const FiniteElement<3> &scalar)
    : values(mapping,
             scalar,
             QGaussLobatto<2>(scalar.degree + 1),
             update_values | update_quadrature_points | update_normal_vectors |
               update_JxW_values)
  {}


  std::vector<FaceNode>
  FaceNodes::of(const Grid::Cell &cell, const unsigned int face)
  {
    values.reinit(cell, face);
    std::vector<FaceNode> nodes;
    for (const unsigned int j : values.dof_indices())
      for (const unsigned int q : values.quadrature_point_indices())
        if (values.shape_value(j, q) > 0.5) // the point that is this node
          nodes.push_back({j,
                           values.quadrature_point(q),
                           values.normal_vector(q),
                           values.JxW(q)});
    return nodes;
  }
} // namespace Voussoir
