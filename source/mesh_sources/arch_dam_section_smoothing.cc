#include <voussoir/mesh_sources/arch_dam_section.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Lengths over the size of a cell, and share of Newton's step with which
    // neighbours can move at the same time.
    constexpr double relative_probe = 0.01, largest_step = 0.05;
    constexpr double relaxation = 0.6;

    // Corners whose det J is below this are treated as flat.
    constexpr double flat = 0.1;


    using Vertex = ArchDamCrossSection::Vertex;
    using Quad   = ArchDamCrossSection::Quad;


    // The part of a corner between the edges @p a and @p b, over the size of
    // the cell, in the distortion.
    double
    distortion_of_corner(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      const double det = a[0] * b[1] - a[1] * b[0];
      // the size stays positive where a corner is inverted, so that smoothing
      // can restore the corner
      const double size = 0.5 * (det + std::sqrt(det * det + flat * flat));
      const double inverse =
        (a.norm_square() + b.norm_square()) / (size * size);
      return inverse * inverse * inverse * inverse;
    }


    /**
     * Distortion of the quadrilaterals around a vertex: the sum over their
     * corners of |J^-1|^8, where J has the two edges over the cell's size in
     * the grid. The sum grows steeply as a cell becomes small, flat, slanted or
     * inverted.
     */
    class Distortion
    {
    public:
      /** @p around are the numbers of the quadrilaterals at vertex @p v. */
      Distortion(const std::vector<Vertex>       &vertices,
                 const std::vector<Quad>         &quads,
                 const std::vector<unsigned int> &around,
                 const unsigned int               v)
        : vertex(vertices[v])
      {
        for (const unsigned int q : around)
          {
            Corners corners{{{quads[q].width, quads[q].height}}, {}, 0, 0.};
            for (unsigned int i = 0; i < 4; ++i)
              {
                corners.x[i] =
                  corners.over_size(vertices[quads[q].vertices[i]]);
                if (quads[q].vertices[i] == v)
                  corners.moved = i;
              }
            corners.opposite = corners.part_of((corners.moved + 2) % 4);
            all.push_back(corners);
            width  = std::min(width, quads[q].width);
            height = std::min(height, quads[q].height);
          }
        here = (*this)(vertex);
      }

      /** The distortion with the vertex at @p place. */
      double
      operator()(const Vertex &place)
      {
        double sum = 0.;
        for (Corners &corners : all)
          {
            corners.x[corners.moved] = corners.over_size(place);
            for (unsigned int i = 0; i < 4; ++i)
              sum += i == (corners.moved + 2) % 4 ? corners.opposite :
                                                    corners.part_of(i);
          }
        return sum;
      }

      /** Newton's step of the vertex along one direction, by differences over
       *  a probe; @p shifted moves the vertex, @p size is that of its cells. */
      template <typename Shift>
      double
      newton_step(const double size, const Shift &shifted)
      {
        const double probe     = relative_probe * size;
        const double before    = (*this)(shifted(-probe)),
                     after     = (*this)(shifted(probe));
        const double slope     = (after - before) / (2. * probe),
                     curvature = (after - 2. * here + before) / (probe * probe);
        const double limit     = largest_step * size;
        return std::max(-limit,
                        std::min(limit,
                                 -relaxation * slope /
                                   std::max(curvature,
                                            std::abs(slope) / size)));
      }

      // least of the cells around
      double width  = std::numeric_limits<double>::max(),
             height = std::numeric_limits<double>::max();

    private:
      struct Corners
      {
        Tensor<1, 2>
        over_size(const Vertex &v) const
        {
          return Tensor<1, 2>({v.s / size[0], v.z / size[1]});
        }

        double
        part_of(const unsigned int i) const
        {
          return distortion_of_corner(x[(i + 1) % 4] - x[i],
                                      x[(i + 3) % 4] - x[i]);
        }

        std::array<double, 2>       size; // width and height
        std::array<Tensor<1, 2>, 4> x;
        unsigned int                moved;
        double                      opposite; // part that does not change
      };

      const Vertex         vertex;
      std::vector<Corners> all;
      double               here;
    };
  } // namespace


  bool
  ArchDamCrossSection::may_move_along(
    const unsigned int       v,
    const std::vector<bool> &joint_stays) const
  {
    if (on_contour[v] && (on_surface[v] || on_ledge[v]))
      return false;
    const int column = vertices[v].column;
    if (column < 0)
      return true;
    for (const Ledge &ledge : ledges)
      if (column == ledge.side_column)
        return false;
    if (column == first_dam_column || column == last_dam_column)
      return false;
    if (joint_stays[v] && column > first_dam_column && column < last_dam_column)
      return (column - first_dam_column) % columns_per_block != 0;
    return column > 0 && column < last_column;
  }


  bool
  ArchDamCrossSection::may_move_up(const unsigned int v, const double z) const
  {
    return !on_contour[v] && !on_surface[v] && !on_ledge[v] && z < height &&
           z > rows.front();
  }


  // All vertices move at the same time, so that a symmetric mesh stays
  // symmetric.
  void
  ArchDamCrossSection::smooth(const std::array<LedgeLine, 2> &lines,
                              const std::vector<bool>        &joint_stays,
                              const unsigned int              n_steps,
                              std::vector<Vertex>            &moved) const
  {
    std::vector<Vertex>                    before = moved;
    std::vector<std::vector<unsigned int>> quads_at(before.size());
    for (unsigned int q = 0; q < quads.size(); ++q)
      for (const unsigned int v : quads[q].vertices)
        quads_at[v].push_back(q);
    for (unsigned int i = 0; i < n_steps; ++i)
      {
        for (unsigned int v = 0; v < before.size(); ++v)
          {
            const Vertex vertex     = before[v];
            const bool   goes_along = may_move_along(v, joint_stays),
                       goes_up      = may_move_up(v, vertex.z);
            if (!goes_along && !goes_up)
              continue;
            Distortion distortion(before, quads, quads_at[v], v);
            const auto along = [&](const double ds) {
              const double s = vertex.s + ds;
              return Vertex{s,
                            on_contour[v] ? sections.contour(s, vertex.z) :
                            on_ledge[v]   ? lines[s < 0. ? 0 : 1].level(s) :
                                            vertex.z,
                            vertex.column};
            };
            const auto up = [&](const double dz) {
              return Vertex{vertex.s, vertex.z + dz, vertex.column};
            };

            if (goes_along)
              moved[v] = along(distortion.newton_step(distortion.width, along));
            if (goes_up)
              moved[v].z += distortion.newton_step(distortion.height, up);
          }
        before = moved;
      }
  }
} // namespace Voussoir
