#include <voussoir/fem/trilinear_cells.h>

namespace Voussoir
{
  using namespace dealii;

  template <template <typename> class Shape>
  void
  TrilinearCells<Shape>::reinit(const unsigned int batch)
  {
    nodes.reinit(batch);
    std::array<Lanes, 24> corners;
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int d = 0; d < 3; ++d)
        corners[8 * d + v] = matrix_free.corners[batch][v][d];
    Shape<Lanes>::reinit(corners);
  }


  template class TrilinearCells<OnePointShape>;
  template class TrilinearCells<EightPointShape>;
} // namespace Voussoir
