#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/grid/face_distance.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The nearest point lies in a corner, on a side or inside, which shows in
    // the barycentric coordinates (Ericson, Real-Time Collision Detection,
    // 2005, section 5.1.5).
    double
    distance_to_triangle(const Point<3> &p,
                         const Point<3> &a,
                         const Point<3> &b,
                         const Point<3> &c)
    {
      const Tensor<1, 3> ab = b - a, ac = c - a, bc = c - b;
      const Tensor<1, 3> ap = p - a, bp = p - b, cp = p - c;
      const double       d1 = ab * ap, d2 = ac * ap, d3 = ab * bp, d4 = ac * bp,
                   d5 = ab * cp, d6 = ac * cp;
      if (d1 <= 0. && d2 <= 0.)
        return ap.norm();
      if (d3 >= 0. && d4 <= d3)
        return bp.norm();
      if (d6 >= 0. && d5 <= d6)
        return cp.norm();
      const double u = d3 * d6 - d5 * d4, v = d5 * d2 - d1 * d6,
                   w = d1 * d4 - d3 * d2;
      if (w <= 0. && d1 >= 0. && d3 <= 0.)
        return (ap - d1 / (d1 - d3) * ab).norm();
      if (v <= 0. && d2 >= 0. && d6 <= 0.)
        return (ap - d2 / (d2 - d6) * ac).norm();
      if (u <= 0. && d4 >= d3 && d5 >= d6)
        return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * bc).norm();
      return (ap - v / (u + v + w) * ab - w / (u + v + w) * ac).norm();
    }
  } // namespace


  std::vector<FaceCorners>
  gather_faces(const Grid                     &grid,
               const std::vector<std::string> &sets,
               const std::string              &place)
  {
    if (sets.empty())
      throw UserError(place + " is empty; name the face sets.");
    std::vector<FaceCorners> faces;
    for (const std::string &set : sets)
      {
        grid.check_face_set(set, place);
        grid.for_each_face(set, [&](const auto &cell, const unsigned int f) {
          const auto face = cell->face(f);
          faces.push_back({{face->vertex(0),
                            face->vertex(1),
                            face->vertex(2),
                            face->vertex(3)}});
        });
      }
    return join_over_ranks(faces, grid.communicator());
  }


  FaceDistance::FaceDistance(const Grid                     &grid,
                             const std::vector<std::string> &sets,
                             const std::string              &place)
  {
    for (const auto &[a, b, c, d] : gather_faces(grid, sets, place))
      faces.push_back({{a, b, d, c, (a + b + d + c) / 4.}});
    if (faces.empty())
      throw UserError(place + " names face sets without faces.");
    std::vector<std::pair<BoundingBox<3>, unsigned int>> numbered_boxes;
    for (unsigned int f = 0; f < faces.size(); ++f)
      numbered_boxes.emplace_back(BoundingBox<3>(faces[f]), f);
    boxes = pack_rtree(numbered_boxes);
  }


  double
  FaceDistance::operator()(const Point<3> &point) const
  {
    // The boxes come in the order of their distance.
    double nearest = std::numeric_limits<double>::infinity();
    for (auto entry =
           boxes.qbegin(boost::geometry::index::nearest(point, boxes.size()));
         entry != boxes.qend() &&
         boost::geometry::distance(point, entry->first) < nearest;
         ++entry)
      {
        const auto &face = faces[entry->second];
        for (unsigned int side = 0; side < 4; ++side)
          nearest = std::min(nearest,
                             distance_to_triangle(point,
                                                  face[side],
                                                  face[(side + 1) % 4],
                                                  face[4]));
      }
    return nearest;
  }


  EdgeDistance::EdgeDistance(const Grid                     &grid,
                             const std::vector<FaceCorners> &surface,
                             const std::vector<std::string> &sets,
                             const std::string              &place)
    : to_faces(grid, sets, place)
    , touching(std::numeric_limits<double>::infinity())
  {
    for (const FaceCorners &corners : surface)
      touching = std::min(touching, 1e-6 * corners[0].distance(corners[3]));
    for (const auto &[a, b, c, d] : surface)
      {
        const std::array<Point<3>, 4> around{{a, b, d, c}};
        std::array<bool, 4>           meets;
        for (unsigned int i = 0; i < 4; ++i)
          meets[i] = to_faces(around[i]) < touching;
        for (unsigned int i = 0; i < 4; ++i)
          if (meets[i] && meets[(i + 1) % 4])
            edges.push_back({{around[i], around[(i + 1) % 4]}});
      }
  }


  double
  EdgeDistance::operator()(const Point<3> &point) const
  {
    const double to_nearest_face = to_faces(point);
    if (edges.empty() || to_nearest_face < touching)
      return to_nearest_face;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto &[begin, end] : edges)
      {
        const Tensor<1, 3> along = end - begin;
        const double       place =
          std::clamp((point - begin) * along / along.norm_square(), 0., 1.);
        nearest = std::min(nearest, point.distance(begin + place * along));
      }
    return nearest;
  }
} // namespace Voussoir
