#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/tensor.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  std::vector<SortedFace>
  sorted_faces(const CoarseMesh &mesh)
  {
    const auto for_each_face = [&](const auto &visit) {
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        for (unsigned int face = 0; face < 6; ++face)
          visit(CoarseMesh::Face{cell, face},
                face_vertices(mesh, {cell, face}));
    };
    // first by the lowest vertex, by counting, then the few faces of each
    std::vector<std::size_t> end(mesh.vertices.size() + 1, 0);
    for_each_face([&](const auto &, const auto &v) {
      ++end[*std::min_element(v.begin(), v.end()) + 1];
    });
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<SortedFace> faces(6 * mesh.cells.size());
    for_each_face([&](const auto &face, auto v) {
      std::sort(v.begin(), v.end());
      faces[end[v[0]]++] = {v, face};
    });
    auto first = faces.begin();
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex)
      {
        const auto last = faces.begin() + end[vertex];
        std::sort(first, last, [](const SortedFace &a, const SortedFace &b) {
          return std::tie(a.vertices, a.face.cell) <
                 std::tie(b.vertices, b.face.cell);
        });
        first = last;
      }
    return faces;
  }


  std::array<double, 8>
  corner_shapes(const CoarseMesh &mesh, const unsigned int cell)
  {
    const auto           &vertices = mesh.cells[cell];
    std::array<double, 8> shapes;
    for (unsigned int v = 0; v < 8; ++v)
      {
        // The edge along direction d joins the vertices that differ in bit d.
        std::array<Tensor<1, 3>, 3> edges;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int bit = 1U << d;
            edges[d]               = mesh.vertices[vertices[v | bit]] -
                       mesh.vertices[vertices[v & ~bit]];
            edges[d] /= edges[d].norm();
          }
        shapes[v] = edges[0] * cross_product_3d(edges[1], edges[2]);
      }
    return shapes;
  }


  Point<3>
  cell_centre(const CoarseMesh &mesh, const unsigned int cell)
  {
    Point<3> centre;
    for (const unsigned int v : mesh.cells[cell])
      centre += mesh.vertices[v] / 8.;
    return centre;
  }


  double
  cell_volume(const CoarseMesh &mesh, const unsigned int cell)
  {
    const auto &vertices = mesh.cells[cell];
    return GridTools::cell_measure<3>(
      mesh.vertices,
      ArrayView<const unsigned int>(vertices.data(), vertices.size()));
  }


  double
  face_area(const CoarseMesh &mesh, const CoarseMesh::Face &face)
  {
    // of QGauss<1>(4), whose making takes longer than the sum
    constexpr std::array<double, 4> points{{0.06943184420297371,
                                            0.33000947820757187,
                                            0.6699905217924281,
                                            0.9305681557970262}},
      weights{{0.17392742256872684,
               0.3260725774312731,
               0.3260725774312731,
               0.17392742256872684}};

    const auto v = face_vertices(mesh, face);
    // The bilinear face is x0 + a s + b t + c s t.
    const Tensor<1, 3> a = mesh.vertices[v[1]] - mesh.vertices[v[0]];
    const Tensor<1, 3> b = mesh.vertices[v[2]] - mesh.vertices[v[0]];
    const Tensor<1, 3> c = mesh.vertices[v[3]] - mesh.vertices[v[2]] - a;

    double area = 0;
    for (unsigned int i = 0; i < points.size(); ++i)
      for (unsigned int j = 0; j < points.size(); ++j)
        area += weights[i] * weights[j] *
                cross_product_3d(a + points[i] * c, b + points[j] * c).norm();
    return area;
  }


  std::array<Point<3>, 8>
  cell_vertices(const CoarseMesh &mesh, const unsigned int cell)
  {
    std::array<Point<3>, 8> vertices;
    for (unsigned int v = 0; v < 8; ++v)
      vertices[v] = mesh.vertices[mesh.cells[cell][v]];
    return vertices;
  }


  std::string
  describe_point(const Point<3> &point)
  {
    std::ostringstream text;
    text << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
    return text.str();
  }
} // namespace Voussoir
