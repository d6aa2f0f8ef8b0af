#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <sstream>
#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  std::array<unsigned int, 4>
  face_vertices(const CoarseMesh &mesh, const CoarseMesh::Face &face)
  {
    std::array<unsigned int, 4> vertices;
    for (unsigned int i = 0; i < 4; ++i)
      vertices[i] =
        mesh.cells[face.cell]
                  [GeometryInfo<3>::face_to_cell_vertices(face.face, i)];
    return vertices;
  }


  std::vector<SortedFace>
  sorted_faces(const CoarseMesh &mesh)
  {
    std::vector<SortedFace> faces;
    faces.reserve(6 * mesh.cells.size());
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      for (unsigned int face = 0; face < 6; ++face)
        {
          faces.push_back({face_vertices(mesh, {cell, face}), {cell, face}});
          std::sort(faces.back().vertices.begin(), faces.back().vertices.end());
        }
    std::sort(faces.begin(),
              faces.end(),
              [](const SortedFace &a, const SortedFace &b) {
                return std::tie(a.vertices, a.face.cell) <
                       std::tie(b.vertices, b.face.cell);
              });
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
    const QGauss<2> quadrature(4);

    const auto v = face_vertices(mesh, face);
    // The bilinear face is x0 + a s + b t + c s t.
    const Tensor<1, 3> a = mesh.vertices[v[1]] - mesh.vertices[v[0]];
    const Tensor<1, 3> b = mesh.vertices[v[2]] - mesh.vertices[v[0]];
    const Tensor<1, 3> c = mesh.vertices[v[3]] - mesh.vertices[v[2]] - a;

    double area = 0;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        const Point<2> p = quadrature.point(q);
        area += quadrature.weight(q) *
                cross_product_3d(a + p[1] * c, b + p[0] * c).norm();
      }
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
