#ifndef voussoir_grid_coarse_faces_h
#define voussoir_grid_coarse_faces_h

#include <voussoir/grid/grid.h>

#include <unordered_map>

namespace Voussoir
{
  /** Index in the coarse mesh of the coarse cell that a cell lies in. */
  unsigned int
  coarse_cell(const Grid::Cell &cell);

  /** The path of a refined cell below its coarse cell, one child number per
   *  level, finest first. */
  std::vector<unsigned int>
  children_upwards(const Grid::Cell &cell);


  /** Faces of a coarse mesh, each with numbers, and the faces of active cells
   *  that lie in them. */
  class CoarseFaces
  {
  public:
    void
    add(const CoarseMesh::Face &face, const unsigned int number);

    bool
    empty() const
    {
      return of_cell.empty();
    }

    /** Visits all faces, and their numbers, of the cells that are not
     *  artificial, in the order of the cells and their faces. */
    void
    for_each(const dealii::Triangulation<3> &triangulation,
             const std::function<void(const Grid::ActiveCell &,
                                      const unsigned int face,
                                      const unsigned int number)> &visit) const;

  private:
    struct Numbered
    {
      unsigned int face, number;
    };

    std::unordered_map<unsigned int, std::vector<Numbered>> of_cell;
  };
} // namespace Voussoir

#endif
