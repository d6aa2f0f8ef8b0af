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


    /**
     * Distortion of the quadrilaterals around a vertex: the sum over their
     * corners of |J^-1|^8, where J has the two edges over the cell's size in
     * the grid. The sum grows steeply as a cell becomes small, flat, slanted or
     * inverted.
     */
    class Distortion
    {
    public:
      Distortion(const std::vector<Vertex> &vertices,
                 const std::vector<Quad>   &quads)
        : vertices(vertices)
        , quads(quads)
        , quads_at(vertices.size())
      {
        for (unsigned int q = 0; q < quads.size(); ++q)
          for (const unsigned int v : quads[q].vertices)
            quads_at[v].push_back(q);
      }

      /** The distortion with vertex @p v at @p place. */
      double
      operator()(const unsigned int v, const Vertex &place) const
      {
        double sum = 0;
        for (const unsigned int q : quads_at[v])
          {
            const auto x = corners(quads[q], v, place);
            for (unsigned int i = 0; i < 4; ++i)
              {
                const Tensor<1, 2> a = x[(i + 1) % 4] - x[i],
                                   b = x[(i + 3) % 4] - x[i];
                const double det     = a[0] * b[1] - a[1] * b[0];
                // the size stays positive where a corner is inverted, so that
                // smoothing can restore the corner
                const double size =
                  0.5 * (det + std::sqrt(det * det + flat * flat));
                const double inverse =
                  (a.norm_square() + b.norm_square()) / (size * size);
                sum += inverse * inverse * inverse * inverse;
              }
          }
        return sum;
      }

      /** Newton's step of vertex @p v along one direction, by differences over
       *  a probe; @p shifted moves the vertex, @p size is that of its cells. */
      template <typename Shift>
      double
      newton_step(const unsigned int v,
                  const double       size,
                  const Shift       &shifted) const
      {
        const double probe     = relative_probe * size;
        const double before    = (*this)(v, shifted(-probe)),
                     at        = (*this)(v, vertices[v]),
                     after     = (*this)(v, shifted(probe));
        const double slope     = (after - before) / (2. * probe),
                     curvature = (after - 2. * at + before) / (probe * probe);
        const double limit     = largest_step * size;
        return std::max(-limit,
                        std::min(limit,
                                 -relaxation * slope /
                                   std::max(curvature,
                                            std::abs(slope) / size)));
      }

      /** Least width and height of the cells around a vertex. */
      std::pair<double, double>
      cell_size(const unsigned int v) const
      {
        double width  = std::numeric_limits<double>::max(),
               height = std::numeric_limits<double>::max();
        for (const unsigned int q : quads_at[v])
          {
            width  = std::min(width, quads[q].width);
            height = std::min(height, quads[q].height);
          }
        return {width, height};
      }

    private:
      // The edges over the size of the quadrilateral.
      std::array<Tensor<1, 2>, 4>
      corners(const Quad        &quad,
              const unsigned int moved,
              const Vertex      &place) const
      {
        std::array<Tensor<1, 2>, 4> x;
        for (unsigned int i = 0; i < 4; ++i)
          {
            const Vertex &vertex =
              quad.vertices[i] == moved ? place : vertices[quad.vertices[i]];
            x[i] =
              Tensor<1, 2>({vertex.s / quad.width, vertex.z / quad.height});
          }
        return x;
      }

      const std::vector<Vertex>             &vertices;
      const std::vector<Quad>               &quads;
      std::vector<std::vector<unsigned int>> quads_at; // by vertex
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
    std::vector<Vertex> before = moved;
    const Distortion    distortion(before, quads);
    for (unsigned int i = 0; i < n_steps; ++i)
      {
        for (unsigned int v = 0; v < before.size(); ++v)
          {
            const Vertex vertex             = before[v];
            const auto [width, cell_height] = distortion.cell_size(v);
            const auto along                = [&](const double ds) {
              const double s = vertex.s + ds;
              return Vertex{s,
                            on_contour[v] ? sections.contour(s) :
                                           on_ledge[v] ? lines[s < 0. ? 0 : 1].level(s) :
                                                         vertex.z,
                            vertex.column};
            };
            const auto up = [&](const double dz) {
              return Vertex{vertex.s, vertex.z + dz, vertex.column};
            };

            if (may_move_along(v, joint_stays))
              moved[v] = along(distortion.newton_step(v, width, along));
            if (may_move_up(v, vertex.z))
              moved[v].z += distortion.newton_step(v, cell_height, up);
          }
        before = moved;
      }
  }
} // namespace Voussoir
