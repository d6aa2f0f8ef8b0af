#ifndef voussoir_mesh_mesh_quality_h
#define voussoir_mesh_mesh_quality_h

#include <deal.II/base/point.h>

#include <array>
#include <string>

namespace Voussoir
{
  /** Quality of hexahedra: the worst values of the cells added. */
  struct MeshQuality
  {
    /** Least triple product of unit vectors along the edges of a corner: 1 at
     *  right angles, 0 if flat. */
    double scaled_jacobian = 1.;

    /** Largest length of an edge over that of the shortest of its cell. */
    double aspect_ratio = 1.;

    /** Smallest angle between two edges of a face [degrees]. */
    double smallest_angle = 90.;

    /** Adds a cell by its vertices, in deal.II's order. */
    void
    take(const std::array<dealii::Point<3>, 8> &vertices);

    /** The quality in words, for the log. */
    std::string
    describe() const;
  };
} // namespace Voussoir

#endif
