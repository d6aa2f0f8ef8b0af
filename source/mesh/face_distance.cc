#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/mesh/face_distance.h>

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
    add_box(0, faces.size());
  }


  unsigned int
  FaceDistance::add_box(const unsigned int begin, const unsigned int end)
  {
    const unsigned int number = boxes.size();
    Box                box{faces[begin][0], faces[begin][0], begin, end};
    for (unsigned int f = begin; f < end; ++f)
      for (const Point<3> &corner : faces[f])
        for (unsigned int d = 0; d < 3; ++d)
          {
            box.lower[d] = std::min(box.lower[d], corner[d]);
            box.upper[d] = std::max(box.upper[d], corner[d]);
          }
    boxes.push_back(box);
    if (end - begin > 4)
      {
        unsigned int longest = 0;
        for (unsigned int d = 1; d < 3; ++d)
          if (box.upper[d] - box.lower[d] >
              box.upper[longest] - box.lower[longest])
            longest = d;
        const unsigned int middle = begin + (end - begin) / 2;
        std::nth_element(faces.begin() + begin,
                         faces.begin() + middle,
                         faces.begin() + end,
                         [longest](const auto &a, const auto &b) {
                           return a[4][longest] < b[4][longest];
                         });
        add_box(begin, middle);
        const unsigned int second = add_box(middle, end);
        boxes[number].second_half = second;
      }
    return number;
  }


  double
  FaceDistance::operator()(const Point<3> &point) const
  {
    double nearest = std::numeric_limits<double>::infinity();
    search(0, point, nearest);
    return nearest;
  }


  void
  FaceDistance::search(const unsigned int box,
                       const Point<3>    &point,
                       double            &nearest) const
  {
    const auto distance = [&](const unsigned int b) {
      Tensor<1, 3> outside;
      for (unsigned int d = 0; d < 3; ++d)
        outside[d] = std::max(
          {boxes[b].lower[d] - point[d], 0., point[d] - boxes[b].upper[d]});
      return outside.norm();
    };
    const unsigned int second = boxes[box].second_half;
    if (second > 0)
      {
        // the nearer half first, which may save the other one
        std::array<std::pair<double, unsigned int>, 2> halves{
          {{distance(box + 1), box + 1}, {distance(second), second}}};
        if (halves[1] < halves[0])
          std::swap(halves[0], halves[1]);
        for (const auto &[away, half] : halves)
          if (away < nearest)
            search(half, point, nearest);
      }
    else
      for (unsigned int f = boxes[box].begin; f < boxes[box].end; ++f)
        for (unsigned int side = 0; side < 4; ++side)
          nearest = std::min(nearest,
                             distance_to_triangle(point,
                                                  faces[f][side],
                                                  faces[f][(side + 1) % 4],
                                                  faces[f][4]));
  }
} // namespace Voussoir
