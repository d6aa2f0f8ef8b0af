#include <voussoir/base/error.h>
#include <voussoir/loads/column_field.h>
#include <voussoir/signals/deconvolution.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Largest stable c dt / h of one element by itself, from its eigenvalues by
    // power iteration.
    double
    element_limit(const unsigned int degree)
    {
      const QGaussLobatto<1> lobatto(degree + 1);
      const QGauss<1>        gauss(degree + 1);
      std::vector<Point<1>>  points = lobatto.get_points();
      const auto shapes = Polynomials::generate_complete_Lagrange_basis(points);
      std::vector<double> mode(degree + 1), product(degree + 1);
      for (unsigned int i = 0; i <= degree; ++i)
        mode[i] = (i % 2 == 0 ? 1. : -1.) + 0.1 * i;
      double eigenvalue = 0.;
      for (unsigned int iteration = 0; iteration < 200; ++iteration)
        {
          std::fill(product.begin(), product.end(), 0.);
          for (unsigned int q = 0; q < gauss.size(); ++q)
            {
              const double x        = gauss.point(q)[0];
              double       gradient = 0.;
              for (unsigned int i = 0; i <= degree; ++i)
                gradient += shapes[i].derivative().value(x) * mode[i];
              for (unsigned int i = 0; i <= degree; ++i)
                product[i] +=
                  gauss.weight(q) * gradient * shapes[i].derivative().value(x);
            }
          double norm = 0.;
          for (unsigned int i = 0; i <= degree; ++i)
            {
              product[i] /= lobatto.weight(i);
              norm = std::max(norm, std::abs(product[i]));
            }
          eigenvalue = norm;
          for (unsigned int i = 0; i <= degree; ++i)
            mode[i] = product[i] / norm;
        }
      return 2. / std::sqrt(eigenvalue);
    }


    /** The material with the largest area of side faces at a height; each
     *  height must not be below the one before. */
    class MaterialOfHeight
    {
    public:
      explicit MaterialOfHeight(const std::vector<SideFace> &faces)
        : by_lower(faces)
        , by_upper(faces)
        , begin(by_lower.begin())
        , end(by_upper.begin())
      {
        std::sort(by_lower.begin(),
                  by_lower.end(),
                  [](const auto &a, const auto &b) {
                    return a.lower < b.lower;
                  });
        std::sort(by_upper.begin(),
                  by_upper.end(),
                  [](const auto &a, const auto &b) {
                    return a.upper < b.upper;
                  });
      }

      unsigned int
      operator()(const double z)
      {
        for (; begin != by_lower.end() && begin->lower <= z; ++begin)
          {
            Faces &here = at[begin->material];
            ++here.n;
            here.area += begin->area;
          }
        for (; end != by_upper.end() && end->upper < z; ++end)
          {
            Faces &here = at[end->material];
            here.area -= end->area;
            if (--here.n == 0)
              at.erase(end->material);
          }
        return std::max_element(at.begin(),
                                at.end(),
                                [](const auto &a, const auto &b) {
                                  return a.second.area < b.second.area;
                                })
          ->first;
      }

    private:
      struct Faces
      {
        unsigned int n    = 0;
        double       area = 0.;
      };

      std::vector<SideFace>                 by_lower, by_upper;
      std::vector<SideFace>::const_iterator begin, end;
      std::map<unsigned int, Faces>         at;
    };
  } // namespace


  std::vector<WaveColumn::Layer>
  layers_of_sides(const std::vector<SideFace>         &faces,
                  const std::vector<ElasticConstants> &constants,
                  const std::vector<double>           &damping_factors,
                  const unsigned int                   degree,
                  const double                         time_step,
                  const Damping                       &damping)
  {
    std::vector<double> levels;
    for (const SideFace &face : faces)
      {
        levels.push_back(face.lower);
        levels.push_back(face.upper);
      }
    std::sort(levels.begin(), levels.end());
    const double tolerance = 1e-9 * (levels.back() - levels.front());

    MaterialOfHeight               material_of(faces);
    const double                   limit = element_limit(degree);
    std::vector<WaveColumn::Layer> layers;
    double                         lower = levels.front();
    for (const double level : levels)
      {
        if (level - lower <= tolerance)
          continue;
        const unsigned int material = material_of(0.5 * (lower + level));
        const double       factor   = damping_factors[material];
        const double       speed =
          constants[material].p_wave_speed() *
          std::sqrt(damping.stiffness_scale(factor) *
                    (1. + factor * damping.stiffening(time_step) +
                     2. * damping.mesh_viscosity / time_step));
        const bool last = levels.back() - level <= tolerance;
        const bool thin = limit * (level - lower) < time_step * speed;
        if (thin && !last)
          continue;
        if (thin && !layers.empty())
          layers.back().upper = level;
        else
          layers.push_back({lower, level, constants[material], factor});
        lower = level;
      }
    return layers;
  }


  ColumnField::ColumnField(WaveColumn            &&wave_column,
                           GroundMotionSignals   &&incident_motion,
                           const BoundaryGeometry &geometry)
    : column(std::move(wave_column))
    , incident(std::move(incident_motion))
  {
    displacement.resize(geometry.nodes.size());
    velocity = force = displacement;

    // many nodes and points share a level up to round-off; where results are
    // reproducible, their level must not be that of the first one of a rank
    const double tolerance = 1e-6 * (column.top() - column.bottom());
    const auto   key       = [&](const double z) -> double {
      return geometry.reproducible ?
                       z :
                       std::lround((z - column.bottom()) / tolerance);
    };
    std::map<double, unsigned int>                          level_numbers;
    std::map<std::pair<unsigned int, double>, unsigned int> stress_numbers;
    for (const Point<3> &node : geometry.nodes)
      {
        const auto [place, is_new] =
          level_numbers.emplace(key(node[2]), levels.size());
        if (is_new)
          levels.push_back(column.interpolation(node[2]));
        level_of_node.push_back(place->second);
      }
    const auto is_lateral = [](const auto &item) {
      return std::abs(item.area[2]) < 0.9 * item.area.norm();
    };
    // linear elements have one stress each
    const auto stress_key = [&](const double z) -> double {
      return column.has_uniform_stress() ? 0. : key(z);
    };
    if (geometry.reproducible)
      {
        // in the order of their positions, in which a node sums them up
        std::map<std::pair<unsigned int, double>, WaveColumn::StressPoint> all;
        for (const auto &item : geometry.contributions)
          if (is_lateral(item))
            {
              const auto at = column.stress_point(item.point[2], item.middle);
              all[{at.element, stress_key(item.point[2])}] = at;
            }
        for (const auto &[place, at] : all)
          {
            stress_numbers[place] = stress_points.size();
            stress_points.push_back(at);
          }
      }
    std::map<std::pair<unsigned int, unsigned int>, Tensor<1, 3>> sums;
    for (const auto &item : geometry.contributions)
      {
        unsigned int point = numbers::invalid_unsigned_int;
        if (is_lateral(item))
          {
            const auto at = column.stress_point(item.point[2], item.middle);
            const auto [place, is_new] =
              stress_numbers.emplace(std::make_pair(at.element,
                                                    stress_key(item.point[2])),
                                     stress_points.size());
            if (is_new)
              stress_points.push_back(at);
            point = place->second;
          }
        sums[{item.node, point}] += item.area;
      }
    for (const auto &[where, area] : sums)
      shares.push_back({where.first, where.second, area});
  }


  std::vector<double>
  ColumnField::save() const
  {
    return column.save();
  }


  void
  ColumnField::load(const std::vector<double> &numbers)
  {
    column.load(numbers);
  }


  void
  ColumnField::advance(const double time)
  {
    Tensor<1, 3> incident_velocity;
    for (unsigned int d = 0; d < 3; ++d)
      if (incident[d])
        incident_velocity[d] = incident[d]->velocity(time);
    column.advance(incident_velocity);

    std::vector<Tensor<1, 3>> level_displacement, level_velocity;
    for (const auto &level : levels)
      {
        level_displacement.push_back(column.displacement(level));
        level_velocity.push_back(column.velocity(level));
      }
    for (unsigned int i = 0; i < displacement.size(); ++i)
      {
        displacement[i] = level_displacement[level_of_node[i]];
        velocity[i]     = level_velocity[level_of_node[i]];
        force[i]        = 0.;
      }

    std::vector<Tensor<1, 3>> stresses;
    std::vector<double>       lateral;
    for (const auto &point : stress_points)
      {
        stresses.push_back(column.stress(point));
        lateral.push_back(column.lateral_ratio(point) * stresses.back()[2]);
      }
    const Tensor<1, 3> base = column.base_traction();
    for (const Share &share : shares)
      if (share.stress_point == numbers::invalid_unsigned_int)
        force[share.node] += -share.area[2] * base;
      else
        {
          // sigma n with sigma_xx = sigma_yy = nu/(1-nu) sigma_zz, sigma_xy = 0
          const Tensor<1, 3> &s = stresses[share.stress_point];
          const Tensor<1, 3> &n = share.area;
          force[share.node] +=
            Tensor<1, 3>({lateral[share.stress_point] * n[0] + s[0] * n[2],
                          lateral[share.stress_point] * n[1] + s[1] * n[2],
                          s[0] * n[0] + s[1] * n[1] + s[2] * n[2]});
        }
  }


  GroundMotionSignals
  incident_for_surface(const WaveColumn          &column,
                       const GroundMotionSignals &surface,
                       const double               time_step,
                       const double               longest,
                       const double               maximum_frequency)
  {
    // independent of the end time of this run, since a run that continues it
    // needs the same motion
    double duration = 0.;
    for (const auto &component : surface)
      if (component)
        duration = std::max(duration,
                            std::isfinite(component->end()) ?
                              component->end() + 4. * column.travel_time() :
                              longest);

    // the column's response to a short pulse, until it has decayed over a
    // period (four travel times) of its slowest layer
    WaveColumn         trial = column;
    const double       width = 2. / maximum_frequency;
    const Pulse        pulse(Quantity::velocity, width, 1.);
    const unsigned int period = static_cast<unsigned int>(
      std::ceil((width + 4. * column.travel_time()) / time_step));
    TimeSeries excitation{time_step, {}}, response[3];
    for (auto &series : response)
      series.time_step = time_step;
    double peak = 0., recent = 0.;
    do
      {
        recent = 0.;
        for (unsigned int i = 0; i < period; ++i)
          {
            const double v =
              pulse.velocity(excitation.values.size() * time_step);
            trial.advance(Tensor<1, 3>({v, v, v}));
            excitation.values.push_back(v);
            for (unsigned int d = 0; d < 3; ++d)
              response[d].values.push_back(trial.surface_velocity()[d]);
            recent = std::max(recent, trial.surface_velocity().norm());
          }
        peak = std::max(peak, recent);
        if (excitation.values.size() > 200 * period)
          throw UserError(
            "The layers at the sides of the model oscillate too long for a "
            "motion \"Given at\" the free surface; lower the \"Maximum "
            "frequency\" in section \"Wave field\" to what the mesh resolves, "
            "or give the layers damping in section \"Damping\".");
      }
    while (recent > 1e-4 * peak);

    GroundMotionSignals incident;
    for (unsigned int d = 0; d < 3; ++d)
      if (surface[d])
        {
          // the incident wave precedes its response at the surface
          const unsigned int delay = static_cast<unsigned int>(
            std::ceil(2. * column.travel_time() / time_step));
          TimeSeries target{time_step, std::vector<double>(delay, 0.)};
          for (unsigned int i = 0; i * time_step <= duration; ++i)
            target.values.push_back(surface[d]->acceleration(i * time_step));
          incident[d] = std::make_unique<Tabulated>(TimeSeries{
            time_step,
            deconvolve(response[d], excitation, target, maximum_frequency)});
        }
    return incident;
  }
} // namespace Voussoir
