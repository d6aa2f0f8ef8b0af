#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/output/section_line.h>

#include <deal.II/base/quadrature_lib.h>

#include <optional>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The bilinear surface between four corners in lexicographic order. */
    struct Surface
    {
      explicit Surface(const FaceCorners &c)
        : origin(c[0])
        , s(c[1] - c[0])
        , t(c[2] - c[0])
        , st(c[3] - c[1] - (c[2] - c[0]))
      {}

      Point<3>
      at(const double a, const double b) const
      {
        return origin + a * s + b * t + a * b * st;
      }

      Tensor<1, 3>
      along_s(const double b) const
      {
        return s + b * st;
      }

      Tensor<1, 3>
      along_t(const double a) const
      {
        return t + a * st;
      }

      Tensor<1, 3>
      unit_normal(const double a, const double b) const
      {
        const Tensor<1, 3> n = cross_product_3d(along_s(b), along_t(a));
        return n / n.norm();
      }

      const Point<3>     origin;
      const Tensor<1, 3> s, t, st;
    };

    struct Hit
    {
      double a, b, distance;
    };

    /** Point where the line p + distance * direction pierces the surface; the
     *  distance is infinite if there is none. */
    Hit
    pierce(const Surface      &surface,
           const Point<3>     &p,
           const Tensor<1, 3> &direction)
    {
      Hit hit{0.5, 0.5, 0.};
      for (unsigned int iteration = 0; iteration < 20; ++iteration)
        {
          Tensor<2, 3>       jacobian; // by columns
          const Tensor<1, 3> s = surface.along_s(hit.b),
                             t = surface.along_t(hit.a);
          for (unsigned int d = 0; d < 3; ++d)
            {
              jacobian[d][0] = s[d];
              jacobian[d][1] = t[d];
              jacobian[d][2] = -direction[d];
            }
          if (std::abs(determinant(jacobian)) < 1e-4 * s.norm() * t.norm())
            break; // nearly parallel
          const Tensor<1, 3> step =
            invert(jacobian) *
            (p + hit.distance * direction - surface.at(hit.a, hit.b));
          hit.a += step[0];
          hit.b += step[1];
          hit.distance += step[2];
          if (std::abs(step[0]) + std::abs(step[1]) < 1e-12)
            {
              const double slack = 1e-6;
              if (std::min(hit.a, hit.b) > -slack &&
                  std::max(hit.a, hit.b) < 1. + slack)
                return hit;
              break;
            }
        }
      return {0.5, 0.5, std::numeric_limits<double>::infinity()};
    }


    /** The point of the surface nearest to @p p (optionally without its y), by
     *  Newton's method for least squares, kept inside. */
    Hit
    nearest(const Surface &surface, const Point<3> &p, const bool without_y)
    {
      Hit          hit{0.5, 0.5, 0.};
      Tensor<1, 3> difference;
      for (unsigned int iteration = 0; iteration < 30; ++iteration)
        {
          Tensor<1, 3> s = surface.along_s(hit.b), t = surface.along_t(hit.a);
          difference = p - surface.at(hit.a, hit.b);
          if (without_y)
            s[1] = t[1] = difference[1] = 0.;
          const double ss = s * s, st = s * t, tt = t * t;
          const double det = ss * tt - st * st;
          if (det < 1e-12 * ss * tt)
            break;
          const double da =
            (tt * (s * difference) - st * (t * difference)) / det;
          double a = std::clamp(hit.a + da, 0., 1.);
          // the best b for this a, and then the best a for this b
          const double b =
            std::clamp(hit.b + (t * difference - st * (a - hit.a)) / tt,
                       0.,
                       1.);
          a = std::clamp(hit.a + (s * difference - st * (b - hit.b)) / ss,
                         0.,
                         1.);
          const double change = std::abs(a - hit.a) + std::abs(b - hit.b);
          hit.a               = a;
          hit.b               = b;
          if (change < 1e-13)
            break;
        }
      difference = p - surface.at(hit.a, hit.b);
      if (without_y)
        difference[1] = 0.;
      hit.distance = difference.norm();
      return hit;
    }


    /** Distances along the line, from all ranks, at which it passes from cell
     *  to cell, and the owned cells near the line. */
    std::vector<double>
    find_breaks(const Discretization              &discretization,
                const Point<3>                    &begin,
                const Tensor<1, 3>                &direction,
                const double                       length,
                std::vector<Discretization::Cell> &cells)
    {
      const Point<3>       end = begin + length * direction;
      const BoundingBox<3> around(
        std::vector<Point<3>>{begin, end, begin, end});
      std::vector<double> own{0., length};
      for (const auto &cell :
           discretization.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto box  = cell->bounding_box();
            bool       near = true;
            for (unsigned int d = 0; d < 3; ++d)
              near =
                near &&
                box.lower_bound(d) <
                  std::max(begin[d], end[d]) + 1e-6 * length &&
                box.upper_bound(d) > std::min(begin[d], end[d]) - 1e-6 * length;
            if (!near)
              continue;
            cells.push_back(cell);
            for (const unsigned int f : cell->face_indices())
              {
                const auto    face = cell->face(f);
                const Surface surface(FaceCorners{{face->vertex(0),
                                                   face->vertex(1),
                                                   face->vertex(2),
                                                   face->vertex(3)}});
                const Hit     hit = pierce(surface, begin, direction);
                if (hit.distance > 1e-6 * length &&
                    hit.distance < (1. - 1e-6) * length)
                  own.push_back(hit.distance);
              }
          }
      auto breaks = join_over_ranks(own, discretization.grid.communicator());
      std::sort(breaks.begin(), breaks.end());
      breaks.erase(std::unique(breaks.begin(),
                               breaks.end(),
                               [&](const double a, const double b) {
                                 return b - a < 1e-6 * length;
                               }),
                   breaks.end());
      return breaks;
    }

    using Refuse = SectionLine::Refuse;


    /** The point of the upstream face nearest to the wanted one, and the size
     *  of the cell face there [m]. */
    std::pair<Point<3>, double>
    find_upstream_point(const std::vector<FaceCorners> &faces,
                        const SectionRequest           &request,
                        const Refuse                   &refuse)
    {
      Point<3> result;
      double   distance = std::numeric_limits<double>::infinity(), size = 0.;
      for (const FaceCorners &corners : faces)
        {
          const Hit hit =
            nearest(Surface(corners), request.position, request.along_river);
          if (hit.distance < distance)
            {
              distance = hit.distance;
              result   = Surface(corners).at(hit.a, hit.b);
              size     = corners[0].distance(corners[3]);
            }
        }
      if (distance > size)
        refuse("lies beside the upstream face; correct its coordinates.");
      return {result, size};
    }


    /** Horizontal unit normal at a point of the face; where cell faces meet in
     *  the point, of the mean of their normals. */
    Tensor<1, 3>
    horizontal_normal(const std::vector<FaceCorners> &faces,
                      const Point<3>                 &point,
                      const double                    size,
                      const Refuse                   &refuse)
    {
      Tensor<1, 3> sum;
      for (const FaceCorners &corners : faces)
        {
          const Surface surface(corners);
          const Hit     hit = nearest(surface, point, false);
          if (hit.distance < 1e-6 * size)
            {
              const Tensor<1, 3> n = surface.unit_normal(hit.a, hit.b);
              sum += (n * sum < 0. ? -1. : 1.) * n;
            }
        }
      sum[2] = 0.;
      if (sum.norm() < 1e-3)
        refuse("lies where the upstream face is level; move it.");
      return sum / sum.norm();
    }


    /** Distance along @p normal to the first point of the downstream face [m];
     *  negative against the normal. */
    double
    distance_of_downstream_face(const std::vector<FaceCorners> &faces,
                                const Point<3>                 &point,
                                const Tensor<1, 3>             &normal,
                                const double                    size,
                                const Refuse                   &refuse)
    {
      double ahead = std::numeric_limits<double>::infinity(), behind = ahead;
      for (const FaceCorners &corners : faces)
        {
          const double along = pierce(Surface(corners), point, normal).distance;
          if (!std::isfinite(along))
            continue;
          if (along > 1e-6 * size)
            ahead = std::min(ahead, along);
          else if (along < -1e-6 * size)
            behind = std::min(behind, -along);
        }
      if (std::min(ahead, behind) == std::numeric_limits<double>::infinity())
        refuse("has no downstream face behind it on a horizontal line; move it "
               "away from the rim of the dam.");
      return ahead < behind ? ahead : -behind;
    }


    /** Coordinates of a point in the reference cell, if it lies in the cell. */
    std::optional<Point<3>>
    position_in(const Discretization::Cell &cell,
                const Point<3>             &x,
                const Mapping<3>           &mapping)
    {
      if (!cell->bounding_box().point_inside(x, 1e-6))
        return {};
      try
        {
          const Point<3> unit = mapping.transform_real_to_unit_cell(cell, x);
          if (GeometryInfo<3>::is_inside_unit_cell(unit, 1e-6))
            return unit;
        }
      catch (const Mapping<3>::ExcTransformationFailed &)
        {}
      return {};
    }
  } // namespace


  std::vector<SectionRequest>
  parse_sections(const std::string &text, const std::string &place)
  {
    std::vector<SectionRequest> requests;
    for (const std::string &item : split_list(text, ';'))
      {
        const auto         colon = item.find(':');
        std::istringstream in(
          colon == std::string::npos ? "" : item.substr(colon + 1));
        std::vector<double> numbers;
        double              number;
        while (in >> number)
          numbers.push_back(number);
        if (!in.eof() || (numbers.size() != 2 && numbers.size() != 3))
          throw UserError(place + ": \"" + item +
                          "\" is no section; write \"name: x z\" or \"name: x "
                          "y z\" [m], several separated by \";\".");
        SectionRequest request;
        request.name        = Utilities::trim(item.substr(0, colon));
        request.along_river = numbers.size() == 2;
        request.position    = request.along_river ?
                                Point<3>(numbers[0], 0., numbers[1]) :
                                Point<3>(numbers[0], numbers[1], numbers[2]);
        for (const SectionRequest &other : requests)
          if (other.name == request.name)
            throw UserError(place + " names \"" + request.name +
                            "\" twice; give each section its own name.");
        requests.push_back(request);
      }
    if (requests.empty())
      throw UserError(place + " is empty; write \"name: x z\" [m] for each "
                              "section.");
    return requests;
  }


  SectionLine::SectionLine(const Discretization &discretization,
                           const SectionRequest &request,
                           const std::array<std::vector<FaceCorners>, 2> &faces,
                           const std::string                             &place)
    : name(request.name)
  {
    const Refuse refuse = [&](const std::string &reason) {
      std::ostringstream position;
      position << request.position;
      throw UserError(place + ": the section \"" + name + "\" at (" +
                      position.str() + ") m " + reason);
    };

    double size; // of the faces there
    std::tie(upstream, size) = find_upstream_point(faces[0], request, refuse);
    normal = horizontal_normal(faces[0], upstream, size, refuse);
    const double downstream =
      distance_of_downstream_face(faces[1], upstream, normal, size, refuse);
    // the normal points away from the downstream face
    if (downstream > 0.)
      normal *= -1.;
    thickness = std::abs(downstream);
    arch      = Tensor<1, 3>({-normal[1], normal[0], 0.});
    place_points(discretization, refuse);
  }


  void
  SectionLine::place_points(const Discretization &discretization,
                            const Refuse         &refuse)
  {
    std::vector<Discretization::Cell> cells;
    const std::vector<double>         breaks =
      find_breaks(discretization, upstream, -normal, thickness, cells);
    const QGauss<1>           gauss(discretization.degree + 2);
    std::vector<unsigned int> n_cells; // that contain the point
    std::vector<unsigned int> number;  // of the integration point
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      for (unsigned int q = 0; q < gauss.size(); ++q)
        {
          const double   width = breaks[i + 1] - breaks[i];
          const double   depth = breaks[i] + width * gauss.point(q)[0];
          const Point<3> x     = upstream - depth * normal;
          n_cells.push_back(0);
          for (const auto &cell : cells)
            if (const auto unit = position_in(cell, x, discretization.mapping))
              {
                points.push_back({{cell, *unit},
                                  0.5 * thickness - depth,
                                  width * gauss.weight(q)});
                number.push_back(n_cells.size() - 1);
                ++n_cells.back();
              }
        }
    n_cells = sum_over_ranks(n_cells, discretization.grid.communicator());
    if (std::find(n_cells.begin(), n_cells.end(), 0) != n_cells.end())
      refuse("leaves the mesh between the upstream and the downstream face; "
             "move it.");
    for (unsigned int p = 0; p < points.size(); ++p)
      points[p].weight /= n_cells[number[p]];
  }
} // namespace Voussoir
