#ifndef voussoir_fem_face_nodes_h
#define voussoir_fem_face_nodes_h

#include <voussoir/grid/grid.h>

#include <deal.II/fe/fe_values.h>

namespace Voussoir
{
  /** A node on a face with its share of the face. */
  struct FaceNode
  {
    unsigned int         number; // in the cell
    dealii::Point<3>     position;
    dealii::Tensor<1, 3> normal; // outwards
    double               area;   // [m2]
  };

  /** The nodes of faces, by quadrature at the Gauss-Lobatto nodes. */
  class FaceNodes
  {
  public:
    FaceNodes(const dealii::Mapping<3>       &mapping,
              const dealii::FiniteElement<3> &scalar);

    /** In the order of the cell's nodes. */
    std::vector<FaceNode>
    of(const Grid::Cell &cell, const unsigned int face);

  private:
    dealii::FEFaceValues<3> values;
  };
} // namespace Voussoir

#endif
