#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/mesh_sources/arch_dam_shape.h>

#include <deal.II/base/numbers.h>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A circle is continued by its tangent from this part of its radius on.
    constexpr double circle_limit = 0.97;

    // Length over the dam's height in which the arch turns, inside the rock.
    constexpr double relative_turning_length = 0.75;

    // Tolerance of intersections with lines and the contour, over the dam's
    // height.
    constexpr double tolerance = 1e-12;

    // Distance from a place near the contour in which it is looked for first,
    // over the dam's height.
    constexpr double near_contour = 0.01;


    std::map<std::string, ArchDamShape>
    presets()
    {
      ArchDamShape shapai;
      shapai.height             = 132.;
      shapai.arch               = ArchCurve::circle;
      shapai.crest_radius       = 155.4;
      shapai.base_radius        = 155.4;
      shapai.radius_exponent    = 1.;
      shapai.crest_width        = {112.2, 112.2};
      shapai.base_width         = {37.6, 37.6};
      shapai.canyon_exponent    = 0.8;
      shapai.face               = {0., 0., 0.};
      shapai.thickness          = {9.5, 18.5, 0., 0.};
      shapai.abutment_thickness = 1.;
      return {{"Baihetan-like", ArchDamShape()}, {"Shapai-like", shapai}};
    }
  } // namespace


  std::vector<std::string>
  ArchDamShape::preset_names()
  {
    std::vector<std::string> names;
    for (const auto &preset : presets())
      names.push_back(preset.first);
    return names;
  }


  ArchDamShape
  ArchDamShape::preset(const std::string &name)
  {
    return presets().at(name);
  }


  void
  ArchDamShape::declare(ParameterHandler &prm)
  {
    const Patterns::Double positive(1e-3);
    prm.add_parameter("Height", height, "H, base to crest [m].", positive);
    add_option(prm, "Arch", arch, "Centre line of the horizontal arches.");
    prm.add_parameter("Crest radius",
                      crest_radius,
                      "Radius of curvature at the crown, at the crest [m].",
                      positive);
    prm.add_parameter("Base radius",
                      base_radius,
                      "The same at the base [m].",
                      positive);
    prm.add_parameter("Radius exponent",
                      radius_exponent,
                      "q in R(z) = R_base + (R_crest - R_base) (z/H)^q [-].",
                      Patterns::Double(0.1, 10.));
    prm.add_parameter("Crest half width",
                      crest_width,
                      "Half width of the canyon at the crest: x of the dam's "
                      "centre line at the right and the left abutment, both "
                      "taken positive [m].",
                      Patterns::List(positive, 2, 2));
    prm.add_parameter("Base half width",
                      base_width,
                      "The same at the base [m].",
                      Patterns::List(positive, 2, 2));
    prm.add_parameter("Canyon exponent",
                      canyon_exponent,
                      "p in x(z) = x_base + (x_crest - x_base) (z/H)^p [-]; "
                      "1: straight flanks, below 1: U shape.",
                      Patterns::Double(0.1, 1.));
    prm.add_parameter("Crown face",
                      face,
                      "a1, a2, a3 of the crown's upstream face y = a1 e + a2 "
                      "e^2 + a3 e^3, e = (H-z)/H, upstream positive [m].",
                      Patterns::List(Patterns::Double(), 3, 3));
    prm.add_parameter("Crown thickness",
                      thickness,
                      "t0, t1, t2, t3 of the crown's thickness t0 + t1 e + t2 "
                      "e^2 + t3 e^3 [m].",
                      Patterns::List(Patterns::Double(), 4, 4));
    prm.add_parameter("Abutment thickness",
                      abutment_thickness,
                      "Thickness at the abutments over that at the crown; it "
                      "grows with the square of the arc length [-].",
                      Patterns::Double(0.5, 3.));
    prm.add_parameter(
      "Arches",
      arches,
      "Instead of the entries above, except \"Arch\": a table of arches as "
      "drawings give them, from below, separated by semicolons, each with nine "
      "numbers [m]: elevation above the base; y of the upstream face and "
      "thickness, at the crown; thickness at the right and at the left "
      "abutment; radius of the centre line (at the crown, of a parabola) on "
      "the right and on the left; x of its ends on the right and on the left, "
      "both taken positive. In between parabolas are blended.");
  }


  ArchDamShape
  ArchDamShape::checked(const std::string &section) const
  {
    ArchDamShape result = *this;
    if (arches.empty())
      check_numbers(section);
    else
      {
        result.table       = parse_arches(section);
        result.height      = result.table.back().elevation;
        const auto &widths = result.table.back().half_width;
        result.crest_width = {widths[0], widths[1]};
      }
    return result;
  }


  std::vector<ArchDamShape::Arch>
  ArchDamShape::parse_arches(const std::string &section) const
  {
    std::vector<Arch> result;
    const auto refuse = [&](const std::string &row, const std::string &what) {
      throw UserError("\"Arches\" in section \"" + section + "\": \"" + row +
                      "\" " + what);
    };
    for (const std::string &row : split_list(arches, ';'))
      {
        const auto n = parse_numbers(row);
        if (!n || n->size() != 9)
          refuse(row,
                 "needs nine numbers, the elevation, y of the upstream face, "
                 "thickness at the crown and at both abutments, both radii and "
                 "both half widths [m].");
        const Arch arch{(*n)[0],
                        (*n)[1],
                        (*n)[2],
                        {{(*n)[3], (*n)[4]}},
                        {{(*n)[5], (*n)[6]}},
                        {{(*n)[7], (*n)[8]}}};
        if (result.empty() ? arch.elevation != 0. :
                             arch.elevation <= result.back().elevation)
          refuse(row,
                 "lies at the wrong place; list the arches from below, the "
                 "first at elevation 0.");
        if (*std::min_element(n->begin() + 2, n->end()) <= 0.)
          refuse(row,
                 "has a thickness, a radius or a half width that is not "
                 "positive.");
        for (const unsigned int bank : {0, 1})
          {
            if (!result.empty() &&
                arch.half_width[bank] < result.back().half_width[bank])
              refuse(row,
                     "is narrower than the arch below it; the canyon must not "
                     "overhang.");
            if (this->arch == ArchCurve::circle &&
                arch.half_width[bank] > 0.9 * arch.radius[bank])
              refuse(
                row,
                "has a half width of more than 0.9 times the radius, which "
                "a circle cannot span.");
          }
        result.push_back(arch);
      }
    if (result.size() < 2)
      throw UserError("\"Arches\" in section \"" + section +
                      "\" needs at least two arches.");
    return result;
  }


  void
  ArchDamShape::check_numbers(const std::string &section) const
  {
    for (unsigned int bank = 0; bank < 2; ++bank)
      {
        if (crest_width[bank] <= base_width[bank])
          throw UserError("In section \"" + section +
                          "\" the \"Crest half width\" must be larger than the "
                          "\"Base half width\" on both banks.");
        if (arch == ArchCurve::circle &&
            (crest_width[bank] > 0.9 * crest_radius ||
             base_width[bank] > 0.9 * base_radius))
          throw UserError("In section \"" + section +
                          "\" a circle cannot span the canyon: let the half "
                          "widths be at most 0.9 times the radius, at the "
                          "crest and at the base.");
      }
    for (unsigned int i = 0; i <= 100; ++i)
      if (crown_thickness(0.01 * i * height) < 0.005 * height)
        throw UserError("In section \"" + section +
                        "\" the \"Crown thickness\" falls below 0.005 times "
                        "the height somewhere between base and crest; it must "
                        "stay above.");
  }


  // A cubic whose slope at each arch is that of the parabola through the arch
  // and its neighbours: exact for quadratic functions.
  template <typename Quantity>
  double
  ArchDamShape::interpolated(const double z, const Quantity &quantity) const
  {
    const unsigned int n = table.size();
    unsigned int       k = 0;
    while (k + 2 < n && table[k + 1].elevation < z)
      ++k;
    const auto secant = [&](const unsigned int i) {
      return (quantity(table[i + 1]) - quantity(table[i])) /
             (table[i + 1].elevation - table[i].elevation);
    };
    const auto slope = [&](const unsigned int i) {
      if (n == 2)
        return secant(0);
      const unsigned int middle = std::clamp(i, 1U, n - 2);
      const double       lower =
                     table[middle].elevation - table[middle - 1].elevation,
                   upper =
                     table[middle + 1].elevation - table[middle].elevation;
      const double curvature =
        (secant(middle) - secant(middle - 1)) / (lower + upper);
      return secant(middle - 1) +
             curvature * (2. * table[i].elevation - table[middle].elevation -
                          table[middle - 1].elevation);
    };
    const double length = table[k + 1].elevation - table[k].elevation,
                 t      = std::clamp((z - table[k].elevation) / length, 0., 1.);
    return (1. - t) * (1. - t) *
             ((1. + 2. * t) * quantity(table[k]) + t * length * slope(k)) +
           t * t *
             ((3. - 2. * t) * quantity(table[k + 1]) -
              (1. - t) * length * slope(k + 1));
  }


  double
  ArchDamShape::crown_face(const double z) const
  {
    if (!table.empty())
      return interpolated(z, [](const Arch &arch) { return arch.face; });
    const double e = (height - z) / height;
    return e * (face[0] + e * (face[1] + e * face[2]));
  }


  double
  ArchDamShape::crown_thickness(const double z) const
  {
    if (!table.empty())
      return interpolated(z, [](const Arch &arch) { return arch.thickness; });
    const double e = (height - z) / height;
    return thickness[0] +
           e * (thickness[1] + e * (thickness[2] + e * thickness[3]));
  }


  double
  ArchDamShape::relative_abutment_thickness(const double x,
                                            const double z) const
  {
    if (table.empty())
      return abutment_thickness;
    return interpolated(z,
                        [&](const Arch &arch) {
                          return arch.abutment_thickness[x < 0 ? 0 : 1];
                        }) /
           crown_thickness(z);
  }


  double
  ArchDamShape::radius(const double x, const double z) const
  {
    if (!table.empty())
      return interpolated(z, [&](const Arch &arch) {
        return arch.radius[x < 0 ? 0 : 1];
      });
    return base_radius +
           (crest_radius - base_radius) * std::pow(z / height, radius_exponent);
  }


  double
  ArchDamShape::half_width(const double x, const double z) const
  {
    const unsigned int bank = x < 0 ? 0 : 1;
    if (!table.empty())
      return interpolated(z, [&](const Arch &arch) {
        return arch.half_width[bank];
      });
    return base_width[bank] + (crest_width[bank] - base_width[bank]) *
                                std::pow(z / height, canyon_exponent);
  }


  double
  ArchDamShape::centre_line(const double x, const double z) const
  {
    const double R     = radius(x, z);
    const double crown = crown_face(z) - 0.5 * crown_thickness(z);
    if (arch == ArchCurve::parabola)
      return crown - x * x / (2. * R);

    const double limit  = circle_limit * R;
    const double inside = std::min(std::abs(x), limit);
    const double y      = std::sqrt(R * R - inside * inside);
    return crown - R + y - (std::abs(x) - inside) * inside / y;
  }


  double
  ArchDamShape::angle(const double x, const double z) const
  {
    const double R = radius(x, z);
    if (arch == ArchCurve::parabola)
      return std::atan(x / R);
    return std::asin(std::max(-circle_limit, std::min(circle_limit, x / R)));
  }


  double
  ArchDamShape::arc_length(const double x, const double z) const
  {
    const double R = radius(x, z);
    if (arch == ArchCurve::parabola)
      {
        const double t = x / R;
        return 0.5 * R * (t * std::sqrt(1. + t * t) + std::asinh(t));
      }
    return R * angle(x, z);
  }


  ArchDamSections::ArchDamSections(const ArchDamShape &shape)
    : right_end(shape.arc_length(-shape.crest_width[0], shape.height))
    , left_end(shape.arc_length(shape.crest_width[1], shape.height))
    , shape(shape)
    , turning_length(relative_turning_length * shape.height)
  {}


  double
  ArchDamSections::arc_length_at(const double x) const
  {
    const double width = shape.crest_width[x < 0 ? 0 : 1];
    if (std::abs(x) <= width)
      return shape.arc_length(x, shape.height);

    // Beyond the turn the continued arch runs straight along x.
    const double sign = x < 0 ? -1. : 1.;
    const double turned =
      (x < 0 ? right_end : left_end) + sign * turning_length;
    return turned + x - crest(turned).centre[0];
  }


  ArchDamSections::Line
  ArchDamSections::crest(const double s) const
  {
    const double H   = shape.height;
    const double end = s < 0 ? right_end : left_end;
    Line         line;
    line.thickness = 0.;
    if (std::abs(s) <= std::abs(end))
      {
        double x = end / std::abs(end) * shape.crest_width[s < 0 ? 0 : 1];
        // quadratic convergence: after such a step x is exact to round-off
        const double small = 1e-9 * std::abs(x);
        double       step  = std::abs(s) < std::abs(end) ? x : 0.;
        for (unsigned int i = 0; i < 60 && std::abs(step) > small; ++i)
          {
            step = (shape.arc_length(x, H) - s) * std::cos(shape.angle(x, H));
            x -= step;
          }
        line.centre = {x, shape.centre_line(x, H)};
        line.angle  = shape.angle(x, H);
        return line;
      }

    // Integrate the tangent over the turn.
    line                = crest(end);
    const double start  = line.angle;
    const double beyond = s - end;
    const double sign   = beyond < 0 ? -1. : 1.;
    const double turned = std::min(std::abs(beyond), turning_length);
    const auto   angle  = [&](const double length) {
      return start * 0.5 *
             (1. + std::cos(numbers::PI * length / turning_length));
    };
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        const double phi = angle(quadrature.point(q)[0] * turned);
        line.centre += quadrature.weight(q) * sign * turned *
                       Tensor<1, 2>({std::cos(phi), -std::sin(phi)});
      }
    line.centre[0] += sign * (std::abs(beyond) - turned);
    line.angle = angle(turned);
    return line;
  }


  double
  ArchDamSections::cut(const Line &crest, const double z) const
  {
    // Newton's method for the distance t along the section.
    const double sine = std::sin(crest.angle), cosine = std::cos(crest.angle);
    double       t = 0., x = crest.centre[0];
    for (unsigned int i = 0; i < 50; ++i)
      {
        const double residual =
          crest.centre[1] + t * cosine - shape.centre_line(x, z);
        const double slope = cosine + sine * std::tan(shape.angle(x, z));
        t -= residual / slope;
        x = crest.centre[0] + t * sine;
        if (std::abs(residual) < tolerance * shape.height)
          break;
      }
    return x;
  }


  double
  ArchDamSections::contour(const double s, const double near) const
  {
    if (s <= right_end || s >= left_end)
      return shape.height;

    // Distance by which the section ends beyond the canyon, in the rock.
    const Line section       = crest(s);
    const auto depth_in_rock = [&](const double z) {
      const double x = cut(section, z);
      return std::abs(x) - shape.half_width(x, z);
    };
    const double distance = near_contour * shape.height;
    double       below    = std::clamp(near - distance, 0., shape.height),
           above          = std::clamp(near + distance, 0., shape.height);
    double at_below = depth_in_rock(below), at_above = depth_in_rock(above);
    if (at_below <= 0.)
      {
        above    = below;
        at_above = at_below;
        below    = 0.;
        at_below = depth_in_rock(below);
        if (at_below <= 0.)
          return 0.;
      }
    else if (at_above >= 0.)
      {
        below    = above;
        at_below = at_above;
        above    = shape.height;
        at_above = depth_in_rock(above);
        if (at_above >= 0.)
          return shape.height;
      }
    std::uintmax_t n_steps = 100;
    return boost::math::tools::toms748_solve(
             depth_in_rock,
             below,
             above,
             at_below,
             at_above,
             [&](const double lower, const double upper) {
               return upper - lower < tolerance * shape.height;
             },
             n_steps)
      .second;
  }


  ArchDamSections::Line
  ArchDamSections::line(const double s, const double z) const
  {
    Line line = crest(s);
    if (s <= right_end || s >= left_end)
      {
        line.thickness = shape.relative_abutment_thickness(s, shape.height) *
                         shape.crown_thickness(shape.height);
        return line;
      }

    const double level = std::max(z, contour(s));
    const double x     = cut(line, level);
    const double ratio =
      shape.arc_length(x, level) /
      shape.arc_length(std::copysign(shape.half_width(x, level), x), level);
    const double normal =
      shape.crown_thickness(level) *
      (1. + (shape.relative_abutment_thickness(x, level) - 1.) *
              std::min(1., ratio * ratio));
    line.centre    = {x, shape.centre_line(x, level)};
    line.thickness = normal / std::cos(shape.angle(x, level) - line.angle);
    return line;
  }
} // namespace Voussoir
