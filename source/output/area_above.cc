#include <voussoir/output/area_above.h>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Share of a triangle in which the linear function with these values at
     *  its corners is positive. */
    double
    positive_share(std::array<double, 3> values)
    {
      std::sort(values.begin(), values.end());
      const auto [low, middle, high] = values;
      if (!(high > 0.))
        return 0.;
      if (low >= 0.)
        return 1.;
      if (middle <= 0.)
        return high * high / ((high - low) * (high - middle));
      return 1. - low * low / ((middle - low) * (high - low));
    }
  } // namespace


  AreaAbove::AreaAbove(const FaceMesh &mesh, const std::vector<double> &levels)
    : quadrilaterals(mesh.quadrilaterals())
    , levels(levels)
  {
    for (const auto &quadrilateral : quadrilaterals)
      {
        std::array<Point<3>, 4> corners;
        Point<3>                middle;
        for (unsigned int v = 0; v < 4; ++v)
          {
            corners[v] = mesh.position(quadrilateral.nodes[v]);
            middle += 0.25 * corners[v];
          }
        areas.emplace_back();
        for (unsigned int e = 0; e < 4; ++e)
          areas.back()[e] =
            0.5 * cross_product_3d(corners[edges[e][0]] - middle,
                                   corners[edges[e][1]] - middle)
                    .norm();
        whole_areas.push_back(
          std::accumulate(areas.back().begin(), areas.back().end(), 0.));
      }
  }


  void
  AreaAbove::add(const std::vector<double> &value_of_node, double *sums) const
  {
    for (unsigned int q = 0; q < quadrilaterals.size(); ++q)
      {
        const auto &[set, nodes] = quadrilaterals[q];
        std::array<double, 4> values;
        for (unsigned int v = 0; v < 4; ++v)
          values[v] = value_of_node[nodes[v]];
        const double high = std::max(std::max(values[0], values[1]),
                                     std::max(values[2], values[3]));
        if (!(high > levels[0]))
          continue;
        const double low = std::min(std::min(values[0], values[1]),
                                    std::min(values[2], values[3])),
                     middle =
                       0.25 * (values[0] + values[1] + values[2] + values[3]);
        for (unsigned int l = 0; l < levels.size() && high > levels[l]; ++l)
          sums[set * levels.size() + l] +=
            low > levels[l] ? whole_areas[q] :
                              part_above(q, values, middle, levels[l]);
      }
  }


  std::vector<double>
  AreaAbove::total(const unsigned int n_sets) const
  {
    std::vector<double> sums(n_sets);
    for (unsigned int q = 0; q < quadrilaterals.size(); ++q)
      sums[quadrilaterals[q].set] += whole_areas[q];
    return sums;
  }


  double
  AreaAbove::part_above(const unsigned int           quadrilateral,
                        const std::array<double, 4> &values,
                        const double                 middle,
                        const double                 level) const
  {
    double area = 0.;
    for (unsigned int e = 0; e < 4; ++e)
      area +=
        areas[quadrilateral][e] * positive_share({{values[edges[e][0]] - level,
                                                   values[edges[e][1]] - level,
                                                   middle - level}});
    return area;
  }
} // namespace Voussoir
