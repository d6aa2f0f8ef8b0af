#include <voussoir/base/error.h>
#include <voussoir/mesh/arch_dam_shape.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>

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

    // To which lines are cut and the contour is found, over the dam's height.
    constexpr double tolerance = 1e-12;


    std::map<std::string, ArchDamShape>
    presets()
    {
      ArchDamShape shapai;
      shapai.height             = 132.;
      shapai.arch               = "circle";
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
    prm.add_parameter("Arch",
                      arch,
                      "Centre line of the horizontal arches.",
                      Patterns::Selection("parabola|circle"));
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
  }


  void
  ArchDamShape::check(const std::string &section) const
  {
    for (unsigned int bank = 0; bank < 2; ++bank)
      {
        if (crest_width[bank] <= base_width[bank])
          throw UserError("In section \"" + section +
                          "\" the \"Crest half width\" must be larger than the "
                          "\"Base half width\" on both banks.");
        if (arch == "circle" && (crest_width[bank] > 0.9 * crest_radius ||
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


  double
  ArchDamShape::crown_face(const double z) const
  {
    const double e = (height - z) / height;
    return e * (face[0] + e * (face[1] + e * face[2]));
  }


  double
  ArchDamShape::crown_thickness(const double z) const
  {
    const double e = (height - z) / height;
    return thickness[0] +
           e * (thickness[1] + e * (thickness[2] + e * thickness[3]));
  }


  double
  ArchDamShape::radius(const double z) const
  {
    return base_radius +
           (crest_radius - base_radius) * std::pow(z / height, radius_exponent);
  }


  double
  ArchDamShape::half_width(const double x, const double z) const
  {
    const unsigned int bank = x < 0 ? 0 : 1;
    return base_width[bank] + (crest_width[bank] - base_width[bank]) *
                                std::pow(z / height, canyon_exponent);
  }


  double
  ArchDamShape::centre_line(const double x, const double z) const
  {
    const double R     = radius(z);
    const double crown = crown_face(z) - 0.5 * crown_thickness(z);
    if (arch == "parabola")
      return crown - x * x / (2. * R);

    const double limit  = circle_limit * R;
    const double inside = std::min(std::abs(x), limit);
    const double y      = std::sqrt(R * R - inside * inside);
    return crown - R + y - (std::abs(x) - inside) * inside / y;
  }


  double
  ArchDamShape::angle(const double x, const double z) const
  {
    const double R = radius(z);
    if (arch == "parabola")
      return std::atan(x / R);
    return std::asin(std::max(-circle_limit, std::min(circle_limit, x / R)));
  }


  double
  ArchDamShape::arc_length(const double x, const double z) const
  {
    const double R = radius(z);
    if (arch == "parabola")
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
        for (unsigned int i = 0; i < 60 && std::abs(s) < std::abs(end); ++i)
          x -= (shape.arc_length(x, H) - s) * std::cos(shape.angle(x, H));
        line.centre = {x, shape.centre_line(x, H)};
        line.angle  = shape.angle(x, H);
        return line;
      }

    // Integrate the tangent over the turn.
    static const QGauss<1> quadrature(16);
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
  ArchDamSections::contour(const double s) const
  {
    if (s <= right_end || s >= left_end)
      return shape.height;

    // How far the section ends beyond the canyon, into the rock.
    const Line section       = crest(s);
    const auto depth_in_rock = [&](const double z) {
      const double x = cut(section, z);
      return std::abs(x) - shape.half_width(x, z);
    };
    const double at_base  = depth_in_rock(0.),
                 at_crest = depth_in_rock(shape.height);
    if (at_base <= 0.)
      return 0.;
    if (at_crest >= 0.)
      return shape.height;
    std::uintmax_t n_steps = 100;
    return boost::math::tools::toms748_solve(
             depth_in_rock,
             0.,
             shape.height,
             at_base,
             at_crest,
             [&](const double below, const double above) {
               return above - below < tolerance * shape.height;
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
        line.thickness =
          shape.abutment_thickness * shape.crown_thickness(shape.height);
        return line;
      }

    const double level = std::max(z, contour(s));
    const double x     = cut(line, level);
    const double ratio = shape.arc_length(x, level) /
                         shape.arc_length(shape.half_width(x, level), level);
    const double normal =
      shape.crown_thickness(level) *
      (1. + (shape.abutment_thickness - 1.) * std::min(1., ratio * ratio));
    line.centre    = {x, shape.centre_line(x, level)};
    line.thickness = normal / std::cos(shape.angle(x, level) - line.angle);
    return line;
  }
} // namespace Voussoir
