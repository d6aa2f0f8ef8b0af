#include <voussoir/fem/trilinear_cells.h>

namespace Voussoir
{
  using namespace dealii;

  template <template <typename> class Shape>
  void
  TrilinearCells<Shape>::reinit(const unsigned int batch)
  {
    nodes.reinit(batch);
    typename Shape<Lanes>::Values corners;
    nodes.read_corners(corners);
    Shape<Lanes>::reinit(corners);
  }


  template class TrilinearCells<OnePointShape>;
  template class TrilinearCells<EightPointShape>;
} // namespace Voussoir
