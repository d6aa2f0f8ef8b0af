#ifndef voussoir_mesh_sources_arch_dam_shape_h
#define voussoir_mesh_sources_arch_dam_shape_h

#include <voussoir/base/option.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>
#include <deal.II/base/quadrature_lib.h>

#include <array>
#include <string>
#include <vector>

namespace Voussoir
{
  enum class ArchCurve
  {
    parabola,
    circle
  };

  inline OptionNames<ArchCurve>
  option_names(const ArchCurve)
  {
    return {{ArchCurve::parabola, "parabola"}, {ArchCurve::circle, "circle"}};
  }


  /**
   * The shape of an arch dam and of its canyon, in a few numbers.
   *
   * Axes: x across, positive towards the left bank, 0 at the crown; y upstream,
   * 0 at the upstream edge of the crest's crown; z up, 0 at the base. Lengths
   * in metres.
   */
  struct ArchDamShape
  {
    /** Names of the dams whose numbers are built in. */
    static std::vector<std::string>
    preset_names();

    /** The numbers of one of preset_names(). */
    static ArchDamShape
    preset(const std::string &name);

    void
    declare(dealii::ParameterHandler &prm);

    /** The shape that the entries describe, by their numbers or by their
     *  arches. Throws UserError, which names the @p section, if they contradict
     *  each other. */
    ArchDamShape
    checked(const std::string &section) const;

    /** Upstream face of the crown cantilever at elevation @p z, y [m]. */
    double
    crown_face(const double z) const;

    /** Thickness of the crown cantilever at elevation @p z [m]. */
    double
    crown_thickness(const double z) const;

    /** Half width of the canyon [m] on the bank where @p x lies. */
    double
    half_width(const double x, const double z) const;

    /** y [m] of the arch centre line. */
    double
    centre_line(const double x, const double z) const;

    /** Angle [rad] from y to the centre line's normal; the sign of @p x. */
    double
    angle(const double x, const double z) const;

    /** Length [m] of the centre line from the crown to @p x, with its sign. */
    double
    arc_length(const double x, const double z) const;

    double              height          = 289.;
    ArchCurve           arch            = ArchCurve::parabola;
    double              crest_radius    = 309.;
    double              base_radius     = 150.;
    double              radius_exponent = 0.7;
    std::vector<double> crest_width{309., 309.}; // right bank, left bank
    std::vector<double> base_width{95., 95.};
    double              canyon_exponent = 0.7;
    std::vector<double> face{75., -60., -10.};
    std::vector<double> thickness{14., 90., -55., 14.};
    double              abutment_thickness = 1.25;
    std::string         arches;

    /** Thickness on the bank where @p x lies over that at the crown. */
    double
    relative_abutment_thickness(const double x, const double z) const;

  private:
    /** One arch of a table, as its entry lists them, right bank before left. */
    struct Arch
    {
      double                elevation, face, thickness;
      std::array<double, 2> abutment_thickness, radius, half_width;
    };

    std::vector<Arch>
    parse_arches(const std::string &section) const;

    void
    check_numbers(const std::string &section) const;

    /** A quantity at elevation @p z, interpolated between the arches of the
     *  table. */
    template <typename Quantity>
    double
    interpolated(const double z, const Quantity &quantity) const;

    double
    radius(const double x, const double z) const;

    std::vector<Arch> table; // from below; empty without arches
  };


  /**
   * Upright sections through the dam, square to its crest arch, by the arc
   * length s along that arch [m] from the crown; negative on the right bank.
   * In the rock beyond the abutments the arch turns gently into the x direction
   * and so do the sections.
   */
  class ArchDamSections
  {
  public:
    explicit ArchDamSections(const ArchDamShape &shape);

    /** s of the crest's end on the right bank (< 0) and the left bank. */
    double right_end, left_end;

    /** The s whose section reaches the centre line, or the continuation of it,
     *  at @p x on the crest. */
    double
    arc_length_at(const double x) const;

    /** Elevation [m] where the section's centre line meets the rock; found
     *  sooner if it is @p near. */
    double
    contour(const double s, const double near = 0.) const;

    /** The dam's part of the horizontal line at elevation z in section s. */
    struct Line
    {
      dealii::Point<2> centre;    // x, y [m]
      double           angle;     // from y, positive towards x [rad]
      double           thickness; // along the line [m]
    };

    /** Below the contour, in the rock, the line keeps its place in the plan. */
    Line
    line(const double s, const double z) const;

  private:
    /** The point where the section cuts the crest's centre line, and the angle.
     */
    Line
    crest(const double s) const;

    /** x where the section through @p crest cuts the centre line at z. */
    double
    cut(const Line &crest, const double z) const;

    const ArchDamShape      shape;
    const double            turning_length;
    const dealii::QGauss<1> quadrature{16}; // over the turn
  };
} // namespace Voussoir

#endif
