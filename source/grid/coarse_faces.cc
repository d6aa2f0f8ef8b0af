#include <voussoir/grid/coarse_faces.h>

#include <deal.II/distributed/fully_distributed_tria.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  unsigned int
  coarse_cell(const Grid::Cell &cell)
  {
    // p4est numbers the coarse cells in a way of its own, and a fully
    // distributed mesh holds some of them only
    if (dynamic_cast<const parallel::fullydistributed::Triangulation<3> *>(
          &cell->get_triangulation()) != nullptr)
      return cell->id().get_coarse_cell_id();
    Grid::Cell coarse = cell;
    while (coarse->level() > 0)
      coarse = coarse->parent();
    return coarse->index();
  }


  std::vector<unsigned int>
  children_upwards(const Grid::Cell &cell)
  {
    std::vector<unsigned int> path;
    for (Grid::Cell child = cell; child->level() > 0; child = child->parent())
      {
        const auto parent = child->parent();
        for (unsigned int i = 0; i < 8; ++i)
          if (parent->child(i) == child)
            path.push_back(i);
      }
    return path;
  }


  namespace
  {
    // Face 2d+s of a child lies on that face of its parent if the child sits on
    // that side, that is, if bit d of its number is s.
    bool
    lies_on_coarse_face(const std::vector<unsigned int> &path,
                        const unsigned int               face)
    {
      return std::all_of(path.begin(), path.end(), [&](const auto child) {
        return ((child >> (face / 2)) & 1) == face % 2;
      });
    }
  } // namespace


  void
  CoarseFaces::add(const CoarseMesh::Face &face, const unsigned int number)
  {
    auto &list = of_cell[face.cell];
    if (std::none_of(list.begin(), list.end(), [&](const Numbered &known) {
          return known.face == face.face && known.number == number;
        }))
      list.push_back({face.face, number});
  }


  void
  CoarseFaces::for_each(
    const Triangulation<3>                        &triangulation,
    const std::function<void(const Grid::ActiveCell &,
                             const unsigned int,
                             const unsigned int)> &visit) const
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const auto numbered = of_cell.find(coarse_cell(cell));
          if (numbered == of_cell.end())
            continue;
          const auto path = children_upwards(cell);
          for (const unsigned int face : cell->face_indices())
            if (lies_on_coarse_face(path, face))
              for (const Numbered &item : numbered->second)
                if (item.face == face)
                  visit(cell, face, item.number);
        }
  }
} // namespace Voussoir
