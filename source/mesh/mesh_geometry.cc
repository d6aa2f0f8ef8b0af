#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
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


  double
  cell_volume(const CoarseMesh &mesh, const unsigned int cell)
  {
    const double gauss  = 0.5 / std::sqrt(3.);
    double       volume = 0;
    for (unsigned int q = 0; q < 8; ++q)
      {
        const Point<3> corner = GeometryInfo<3>::unit_cell_vertex(q);
        Point<3>       point;
        for (unsigned int d = 0; d < 3; ++d)
          point[d] = 0.5 + (2 * corner[d] - 1) * gauss;

        Tensor<2, 3> jacobian;
        for (unsigned int v = 0; v < 8; ++v)
          jacobian += outer_product(
            mesh.vertices[mesh.cells[cell][v]],
            GeometryInfo<3>::d_linear_shape_function_gradient(point, v));
        volume += determinant(jacobian) / 8.;
      }
    return volume;
  }


  double
  face_area(const CoarseMesh &mesh, const CoarseMesh::Face &face)
  {
    const double gauss = 0.5 / std::sqrt(3.);
    const auto   v     = face_vertices(mesh, face);
    const auto   x     = [&](const unsigned int i) -> const Point<3>       &{
      return mesh.vertices[v[i]];
    };
    double area = 0;
    for (const double s : {0.5 - gauss, 0.5 + gauss})
      for (const double t : {0.5 - gauss, 0.5 + gauss})
        {
          const Tensor<1, 3> along_s =
            (1 - t) * (x(1) - x(0)) + t * (x(3) - x(2));
          const Tensor<1, 3> along_t =
            (1 - s) * (x(2) - x(0)) + s * (x(3) - x(1));
          area += 0.25 * cross_product_3d(along_s, along_t).norm();
        }
    return area;
  }
} // namespace Voussoir
