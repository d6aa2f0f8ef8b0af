#include <voussoir/loads/wave_column.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Quadrature<1>
    stiffness_quadrature(const QuadratureRule rule, const unsigned int degree)
    {
      // one point in linear elements suffices
      if (rule == QuadratureRule::gauss_lobatto)
        return QGaussLobatto<1>(degree + 1);
      return QGauss<1>(degree + 1);
    }
  } // namespace


  WaveColumn::WaveColumn(const std::vector<Layer> &layers,
                         const unsigned int        degree,
                         const QuadratureRule      quadrature,
                         const Damping            &damping,
                         const LeapFrog           &leap_frog)
    : degree(degree)
    , leap_frog(leap_frog)
    , maxwell(damping, leap_frog.time_step)
    , mass_coefficient(damping.mass_coefficient)
    , stiffness_coefficient(damping.stiffness_coefficient)
    , mesh_viscosity(damping.mesh_viscosity)
  {
    const QGaussLobatto<1> lobatto(degree + 1);
    shapes =
      Polynomials::generate_complete_Lagrange_basis(lobatto.get_points());
    const Quadrature<1> rule = stiffness_quadrature(quadrature, degree);
    weights                  = rule.get_weights();
    for (const Point<1> &point : rule.get_points())
      {
        gradients.emplace_back();
        for (const auto &shape : shapes)
          gradients.back().push_back(shape.derivative().value(point[0]));
      }

    mass.assign(degree * layers.size() + 1, 0.);
    for (const Layer &layer : layers)
      {
        const ElasticConstants &c      = layer.constants;
        const double            height = layer.upper - layer.lower;
        const double scale = damping.stiffness_scale(layer.damping_factor);
        const double G     = scale * c.shear_modulus();
        const double M     = scale * (c.lame_lambda() + 2. * c.shear_modulus());
        for (unsigned int i = 0; i <= degree; ++i)
          mass[degree * elements.size() + i] +=
            c.density * height * lobatto.weight(i);
        elements.push_back({layer.lower,
                            height,
                            Tensor<1, 3>({G, G, M}),
                            layer.damping_factor,
                            c.poisson_ratio / (1. - c.poisson_ratio),
                            c.s_wave_speed()});
      }
    const ElasticConstants &rock = layers.front().constants;
    const double            S    = rock.density * rock.s_wave_speed();
    impedance = Tensor<1, 3>({S, S, rock.density * rock.p_wave_speed()});

    u.resize(mass.size());
    middle_velocity = next_u = v = effective = u;
    memory.assign(maxwell.decay.size(), u);
  }


  void
  WaveColumn::advance(const Tensor<1, 3> &incident_velocity)
  {
    // the same operations as CentralDifference::step
    u = next_u;
    for (unsigned int i = 0; i < u.size(); ++i)
      {
        effective[i] = stiffness_coefficient * v[i];
        for (unsigned int k = 0; k < memory.size(); ++k)
          {
            memory[k][i] =
              maxwell.decay[k] * memory[k][i] + maxwell.gain[k] * v[i];
            effective[i] += memory[k][i];
          }
      }

    std::vector<Tensor<1, 3>> &force = next_u;
    std::fill(force.begin(), force.end(), Tensor<1, 3>());
    for (unsigned int e = 0; e < elements.size(); ++e)
      {
        const Element &element = elements[e];
        for (unsigned int q = 0; q < weights.size(); ++q)
          {
            Tensor<1, 3> strain;
            for (unsigned int i = 0; i <= degree; ++i)
              strain +=
                gradients[q][i] *
                (u[degree * e + i] + mesh_viscosity * v[degree * e + i] +
                 element.damping_factor * effective[degree * e + i]);
            for (unsigned int d = 0; d < 3; ++d)
              strain[d] *= weights[q] * element.modulus[d] / element.height;
            for (unsigned int i = 0; i <= degree; ++i)
              force[degree * e + i] += gradients[q][i] * strain;
          }
      }

    for (unsigned int i = 0; i < u.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double dashpot =
            mass_coefficient * mass[i] + (i == 0 ? impedance[d] : 0.);
          const double push =
            (i == 0 ? 2. * impedance[d] * incident_velocity[d] : 0.) -
            force[i][d];
          const double before = v[i][d];
          v[i][d] = ((mass[i] - leap_frog.explicit_share() * dashpot) * before +
                     leap_frog.time_step * push) /
                    (mass[i] + leap_frog.implicit_share() * dashpot);
          middle_velocity[i][d] = leap_frog.damped(before, v[i][d]);
          next_u[i][d]          = u[i][d] + leap_frog.time_step * v[i][d];
        }
    for (unsigned int d = 0; d < 3; ++d)
      base[d] =
        impedance[d] * (2. * incident_velocity[d] - middle_velocity[0][d]);
  }


  std::vector<double>
  WaveColumn::save() const
  {
    std::vector<double> numbers;
    const auto          add = [&](const std::vector<Tensor<1, 3>> &vectors) {
      for (const Tensor<1, 3> &vector : vectors)
        numbers.insert(numbers.end(), vector.begin_raw(), vector.end_raw());
    };
    add(next_u);
    add(v);
    for (const auto &branch : memory)
      add(branch);
    return numbers;
  }


  void
  WaveColumn::load(const std::vector<double> &numbers)
  {
    AssertThrow(numbers.size() == 3 * (2 + memory.size()) * v.size(),
                ExcDimensionMismatch(numbers.size(),
                                     3 * (2 + memory.size()) * v.size()));
    auto       number = numbers.begin();
    const auto take   = [&](std::vector<Tensor<1, 3>> &vectors) {
      for (Tensor<1, 3> &vector : vectors)
        {
          std::copy(number, number + 3, vector.begin_raw());
          number += 3;
        }
    };
    take(next_u);
    take(v);
    for (auto &branch : memory)
      take(branch);
  }


  unsigned int
  WaveColumn::element_at(const double z) const
  {
    unsigned int e = 0;
    while (e + 1 < elements.size() && z >= elements[e + 1].lower)
      ++e;
    return e;
  }


  WaveColumn::Interpolation
  WaveColumn::interpolation(const double z) const
  {
    const unsigned int e = element_at(z);
    const double       x =
      std::min(1., std::max(0., (z - elements[e].lower) / elements[e].height));
    Interpolation result{degree * e, {}};
    for (const auto &shape : shapes)
      result.weights.push_back(shape.value(x));
    return result;
  }


  Tensor<1, 3>
  WaveColumn::displacement(const Interpolation &at) const
  {
    Tensor<1, 3> value;
    for (unsigned int i = 0; i <= degree; ++i)
      value += at.weights[i] * u[at.first_node + i];
    return value;
  }


  Tensor<1, 3>
  WaveColumn::velocity(const Interpolation &at) const
  {
    Tensor<1, 3> value;
    for (unsigned int i = 0; i <= degree; ++i)
      value += at.weights[i] * middle_velocity[at.first_node + i];
    return value;
  }


  WaveColumn::StressPoint
  WaveColumn::stress_point(const double z, const double middle) const
  {
    const unsigned int e = element_at(z + 1e-6 * (middle - z));
    StressPoint        point{e, {}};
    for (const auto &shape : shapes)
      point.gradients.push_back(
        shape.derivative().value((z - elements[e].lower) / elements[e].height) /
        elements[e].height);
    return point;
  }


  Tensor<1, 3>
  WaveColumn::stress(const StressPoint &at) const
  {
    const Element &element = elements[at.element];
    Tensor<1, 3>   strain;
    for (unsigned int i = 0; i <= degree; ++i)
      strain += at.gradients[i] *
                (u[degree * at.element + i] +
                 element.damping_factor * effective[degree * at.element + i]);
    for (unsigned int d = 0; d < 3; ++d)
      strain[d] *= element.modulus[d];
    return strain;
  }


  double
  WaveColumn::lateral_ratio(const StressPoint &at) const
  {
    return elements[at.element].lateral_ratio;
  }


  Tensor<1, 3>
  WaveColumn::base_traction() const
  {
    return base;
  }


  Tensor<1, 3>
  WaveColumn::surface_velocity() const
  {
    return middle_velocity.back();
  }


  double
  WaveColumn::bottom() const
  {
    return elements.front().lower;
  }


  double
  WaveColumn::top() const
  {
    return elements.back().lower + elements.back().height;
  }


  double
  WaveColumn::travel_time() const
  {
    double sum = 0.;
    for (const Element &element : elements)
      sum += element.height / element.s_wave_speed;
    return sum;
  }
} // namespace Voussoir
