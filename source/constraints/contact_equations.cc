#include <voussoir/constraints/contact_equations.h>
#include <voussoir/constraints/contact_homotopy.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;
  using namespace Dense;

  ContactEquations::ContactEquations(
    const std::vector<double>        &given_delassus,
    const std::vector<Tensor<1, 3>>  &given_gaps,
    const std::vector<ContactLimits> &limits,
    const double                      round_off_of_gaps,
    const double                      cap)
    : n(3 * limits.size())
    , delassus(given_delassus)
    , gaps(n)
  {
    double length = round_off_of_gaps / unsolved_contact, softest = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        // the width of an open gap is no measure for the accuracy
        const double gap = given_gaps[i / 3][i % 3];
        length =
          std::max(length,
                   i % 3 == 0 ? std::max(-gap, 1e-3 * gap) : std::abs(gap));
        softest = std::max(softest, delassus[i * n + i]);
      }
    if (softest == 0.)
      return;
    if (length == 0.)
      length = 1.;
    force_unit = length / softest;
    for (double &value : delassus)
      value /= softest;
    for (unsigned int i = 0; i < n; ++i)
      gaps[i] = given_gaps[i / 3][i % 3] / length;
    for (unsigned int k = 0; k < limits.size(); ++k)
      {
        double own = 0.;
        for (unsigned int i = 3 * k; i < 3 * k + 3; ++i)
          own = std::max(own, delassus[i * n + i]);
        ContactLimits scaled = limits[k];
        scaled.tension /= force_unit;
        scaled.bond /= force_unit;
        scaled.cohesion /= force_unit;
        scaled.opening /= length;
        points.emplace_back(scaled, own, cap);
      }
  }


  Vector
  ContactEquations::softening(const Vector &x) const
  {
    const auto now = states(x);
    Vector     result(n);
    for (unsigned int i = 0; i < n; ++i)
      result[i] = -softness / points[i / 3].stiffness * now[i / 3].force[i % 3];
    return result;
  }


  double
  ContactEquations::limit(const unsigned int k, const Vector &x) const
  {
    const ContactSegment &s = points[k].now();
    return s.limit + s.limit_slope * (x[3 * k] - s.at) +
           points[k].bond * (1. - bond_slope * (1. - x.back()));
  }


  ContactEquations::State
  ContactEquations::state(const unsigned int k, const Vector &x) const
  {
    const ContactLawPoint &point = points[k];
    const ContactSegment  &s     = point.now();
    const double           z     = x[3 * k] - s.at;
    State                  result;
    result.force[0]       = s.force + s.force_slope * z;
    result.force_by[0][0] = s.force_slope;
    result.gap[0]         = s.gap + s.gap_slope * z;
    result.gap_by[0][0]   = s.gap_slope;
    if (!point.slips)
      {
        for (unsigned int d = 1; d < 3; ++d)
          {
            result.force[d]       = x[3 * k + d];
            result.force_by[d][d] = 1.;
          }
        return result;
      }
    const Tensor<1, 2> y({x[3 * k + 1], x[3 * k + 2]});
    const double       size = y.norm(), L = limit(k, x);
    for (unsigned int d = 1; d < 3; ++d)
      {
        const double direction = size > 0. ? y[d - 1] / size : 0.;
        result.force[d]        = L * direction;
        result.force_by[0][d]  = s.limit_slope * direction;
        result.force_by[3][d]  = bond_slope * point.bond * direction;
        for (unsigned int e = 1; e < 3; ++e)
          if (size > 0.)
            result.force_by[e][d] =
              L / size * ((d == e ? 1. : 0.) - direction * y[e - 1] / size);
        result.gap[d] = (result.force[d] - y[d - 1]) / point.stiffness;
        for (unsigned int j = 0; j < 4; ++j)
          result.gap_by[j][d] =
            (result.force_by[j][d] - (d == j ? 1. : 0.)) / point.stiffness;
      }
    return result;
  }


  std::vector<ContactEquations::State>
  ContactEquations::states(const Vector &x) const
  {
    std::vector<State> result;
    for (unsigned int k = 0; k < points.size(); ++k)
      result.push_back(state(k, x));
    return result;
  }


  Vector
  ContactEquations::residual(const Vector &x, const bool of_homotopy) const
  {
    const auto now = states(x);
    Vector     result(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        result[i] = now[i / 3].gap[i % 3] - gaps[i];
        for (unsigned int j = 0; j < n; ++j)
          result[i] -= delassus[i * n + j] * now[j / 3].force[j % 3];
        if (of_homotopy)
          result[i] -=
            (1. - x.back()) * widening[i] + shift[i] +
            softness / points[i / 3].stiffness * now[i / 3].force[i % 3];
      }
    return result;
  }


  Line
  ContactEquations::linearize(const Vector &x) const
  {
    const auto          now = states(x);
    std::vector<Vector> matrix(n, Vector(n + 1));
    for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int k = 0; k < points.size(); ++k)
          for (unsigned int j = 0; j < 4; ++j)
            {
              double &entry = matrix[i][j < 3 ? 3 * k + j : n];
              entry -= Tensor<1, 3>({delassus[i * n + 3 * k],
                                     delassus[i * n + 3 * k + 1],
                                     delassus[i * n + 3 * k + 2]}) *
                       now[k].force_by[j];
              if (k == i / 3)
                entry += now[k].gap_by[j][i % 3] - softness /
                                                     points[k].stiffness *
                                                     now[k].force_by[j][i % 3];
            }
        matrix[i][n] += widening[i];
      }
    Vector right = residual(x, true);
    for (double &value : right)
      value = -value;
    return solve(std::move(matrix), std::move(right));
  }


  std::vector<ContactEquations::End>
  ContactEquations::ends() const
  {
    std::vector<End> result{{End::time, 0}};
    for (unsigned int k = 0; k < points.size(); ++k)
      {
        if (points[k].segment + 1 < points[k].segments.size())
          result.push_back({End::opening, k});
        if (points[k].segment > 0)
          result.push_back({End::closing, k});
        if (!points[k].locked)
          result.push_back({End::shear, k});
      }
    return result;
  }


  double
  ContactEquations::way_to(const End    &end,
                           const Vector &x,
                           Vector       &gradient) const
  {
    const unsigned int     k     = end.point;
    const ContactLawPoint &point = points[k];
    gradient.assign(n + 1, 0.);
    switch (end.kind)
      {
        case End::time:
          gradient[n] = -1.;
          return 1. - x.back();
        case End::opening:
          gradient[3 * k] = 1.;
          return x[3 * k] - point.now().from;
        case End::closing:
          gradient[3 * k] = -1.;
          return point.segments[point.segment - 1].from - x[3 * k];
        default:
          const Tensor<1, 2> y({x[3 * k + 1], x[3 * k + 2]});
          const double       sign = point.slips ? 1. : -1., size = y.norm();
          gradient[3 * k] = -sign * point.now().limit_slope;
          for (unsigned int d = 0; d < 2 && size > 0.; ++d)
            gradient[3 * k + 1 + d] = sign * y[d] / size;
          gradient[n] = -sign * bond_slope * point.bond;
          return sign * (size - limit(k, x));
      }
  }


  double
  ContactEquations::way_to(const End &end, const Vector &x) const
  {
    Vector gradient;
    return way_to(end, x, gradient);
  }
} // namespace Voussoir
