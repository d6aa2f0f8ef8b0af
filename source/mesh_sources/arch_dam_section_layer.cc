#include <voussoir/mesh_sources/arch_dam_section.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Initial thickness of a layer, before smoothing, over the distance to the
    // vertices beyond.
    constexpr double first_thickness = 0.4;
  } // namespace


  // Without these layers three, five or six quadrilaterals meet on the contour
  // wherever it steps to another row, and stresses concentrate at the edge of
  // dam and rock. So the quadrilaterals of either side are detached from the
  // contour and get copies of its vertices, and a layer of new quadrilaterals
  // fills the gap (Mitchell and Tautges 1995, "pillowing").
  void
  ArchDamCrossSection::line_contour()
  {
    std::map<std::pair<unsigned int, unsigned int>, std::vector<Side>> edges;
    for (unsigned int q = 0; q < quads.size(); ++q)
      for (unsigned int e = 0; e < 4; ++e)
        edges[std::minmax(quads[q].vertices[e], quads[q].vertices[(e + 1) % 4])]
          .push_back({q, e});

    std::array<std::vector<Side>, 2> sides; // in the rock and in the canyon
    for (const auto &[edge, both] : edges)
      if (both.size() == 2 &&
          quads[both[0].quad].inside != quads[both[1].quad].inside)
        for (const Side &side : both)
          sides[quads[side.quad].inside].push_back(side);
    for (const bool inside : {false, true})
      add_layer(sides[inside], inside);
  }


  void
  ArchDamCrossSection::add_layer(const std::vector<Side> &sides,
                                 const bool               inside)
  {
    // The copies of the contour's vertices, beyond the layer.
    std::map<unsigned int, unsigned int> copies;
    for (const Side &side : sides)
      for (const unsigned int i : {0, 1})
        copies[quads[side.quad].vertices[(side.edge + i) % 4]] = 0;
    std::map<unsigned int, unsigned int> beyond;
    for (const Quad &quad : quads)
      if (quad.inside == inside)
        for (unsigned int i = 0; i < 4; ++i)
          for (const unsigned int j : {(i + 1) % 4, (i + 3) % 4})
            if (const unsigned int v = quad.vertices[i], u = quad.vertices[j];
                copies.count(v) > 0 && copies.count(u) == 0 &&
                layer_leads(v, u, inside))
              beyond[v] = u;
    for (auto &[v, copy] : copies)
      copy = copy_vertex(v, beyond.at(v), inside);

    std::vector<Quad> layer;
    for (const Side &side : sides)
      {
        // in the place of the detached vertex
        Quad quad = quads[side.quad];
        for (const unsigned int i : {0, 1})
          quad.vertices[(side.edge + 3 - i) % 4] =
            copies.at(quad.vertices[(side.edge + i) % 4]);
        layer.push_back(quad);
      }
    for (Quad &quad : quads)
      if (quad.inside == inside)
        for (unsigned int &v : quad.vertices)
          if (const auto copy = copies.find(v); copy != copies.end())
            v = copy->second;
    quads.insert(quads.end(), layer.begin(), layer.end());
  }


  // The layer grows along the crest and the ground from their common point,
  // along a ledge from its foot, along a column from its point on the contour.
  bool
  ArchDamCrossSection::layer_leads(const unsigned int v,
                                   const unsigned int u,
                                   const bool         inside) const
  {
    if (vertices[v].z >= height)
      return vertices[u].z >= height;
    if (!inside && on_ledge[v])
      return on_ledge[u];
    return vertices[v].column < 0 || vertices[u].column == vertices[v].column;
  }


  unsigned int
  ArchDamCrossSection::copy_vertex(const unsigned int v,
                                   const unsigned int beyond,
                                   const bool         inside)
  {
    const bool leaves_column =
      vertices[v].z >= height || (!inside && on_ledge[v]);
    Vertex copy{vertices[v].s +
                  first_thickness * (vertices[beyond].s - vertices[v].s),
                vertices[v].z +
                  first_thickness * (vertices[beyond].z - vertices[v].z),
                leaves_column ? -1 : vertices[v].column};
    on_contour.push_back(false);
    on_ledge.push_back(!inside && on_ledge[v]);
    on_surface.push_back(inside && on_surface[v]);
    if (on_surface.back())
      copy.z = surface_level;
    vertices.push_back(copy);
    return vertices.size() - 1;
  }
} // namespace Voussoir
