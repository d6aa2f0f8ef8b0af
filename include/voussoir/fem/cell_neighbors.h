#ifndef voussoir_fem_cell_neighbors_h
#define voussoir_fem_cell_neighbors_h

#include <voussoir/fem/discretization.h>

namespace Voussoir
{
  /** Calls visit(neighbour, face) for each cell that shares a face, or a part
   * of it, with a cell: @p face is the common part. */
  template <typename Visitor>
  void
  for_each_neighbor(const Discretization::Cell &cell, const Visitor &visit)
  {
    for (const unsigned int f : cell->face_indices())
      {
        if (cell->at_boundary(f))
          continue;
        const auto neighbor = cell->neighbor(f);
        if (!neighbor->has_children())
          {
            visit(neighbor, cell->face(f));
            continue;
          }
        const unsigned int opposite = cell->neighbor_of_neighbor(f);
        for (unsigned int c = 0; c < cell->face(f)->n_children(); ++c)
          {
            const auto child = cell->neighbor_child_on_subface(f, c);
            visit(child, child->face(opposite));
          }
      }
  }
} // namespace Voussoir

#endif
