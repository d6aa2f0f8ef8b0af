#ifndef voussoir_analysis_trilinear_cells_h
#define voussoir_analysis_trilinear_cells_h

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping.h>

#include <array>
#include <vector>

namespace Voussoir
{
  /** Volumes and gradients at the 2x2x2 Gauss points of a trilinear cell. */
  class TrilinearCell
  {
  public:
    TrilinearCell()
    {
      const dealii::FE_Q<3>   fe(1);
      const dealii::QGauss<3> quadrature(2);
      for (unsigned int q = 0; q < 8; ++q)
        {
          weight[q] = quadrature.weight(q);
          for (unsigned int i = 0; i < 8; ++i)
            unit_gradient[q][i] = fe.shape_grad(i, quadrature.point(q));
        }
    }

    /** Calls visit(volume, gradients of the eight functions) at each point. */
    template <typename Visit>
    void
    for_each_point(const std::array<dealii::Point<3>, 8> &corners,
                   const Visit                           &visit) const
    {
      for (unsigned int q = 0; q < 8; ++q)
        {
          dealii::Tensor<2, 3> jacobian;
          for (unsigned int i = 0; i < 8; ++i)
            jacobian += outer_product(dealii::Tensor<1, 3>(corners[i]),
                                      unit_gradient[q][i]);
          const dealii::Tensor<2, 3>          inverse = invert(jacobian);
          std::array<dealii::Tensor<1, 3>, 8> gradient;
          for (unsigned int i = 0; i < 8; ++i)
            gradient[i] = unit_gradient[q][i] * inverse;
          visit(weight[q] * determinant(jacobian), gradient);
        }
    }

  private:
    std::array<double, 8>                              weight;
    std::array<std::array<dealii::Tensor<1, 3>, 8>, 8> unit_gradient;
  };


  /**
   * Calls visit(cell, corner positions, corner nodes) for the trilinear cells
   * between the nodes of each owned cell.
   *
   * @param scalar        element of one component
   * @param nodes_of_cell the global nodes of a cell, in the element's order
   */
  template <typename DoFHandler, typename NodesOfCell, typename Visit>
  void
  for_each_trilinear_cell(const DoFHandler         &dof_handler,
                          const dealii::FE_Q<3>    &scalar,
                          const dealii::Mapping<3> &mapping,
                          const NodesOfCell        &nodes_of_cell,
                          const Visit              &visit)
  {
    const auto         numbering = scalar.get_poly_space_numbering_inverse();
    const auto        &points    = scalar.get_unit_support_points();
    const unsigned int degree = scalar.degree, n = degree + 1;
    std::array<dealii::Point<3>, 8>                corners;
    std::array<dealii::types::global_dof_index, 8> corner_nodes;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const auto nodes = nodes_of_cell(cell);
          for (unsigned int k = 0; k < degree; ++k)
            for (unsigned int j = 0; j < degree; ++j)
              for (unsigned int i = 0; i < degree; ++i)
                {
                  for (unsigned int v = 0; v < 8; ++v)
                    {
                      const unsigned int node =
                        numbering[(i + (v & 1)) + n * (j + ((v >> 1) & 1)) +
                                  n * n * (k + (v >> 2))];
                      corners[v] =
                        degree == 1 ?
                          cell->vertex(v) :
                          mapping.transform_unit_to_real_cell(cell,
                                                              points[node]);
                      corner_nodes[v] = nodes[node];
                    }
                  visit(cell, corners, corner_nodes);
                }
        }
  }
} // namespace Voussoir

#endif
