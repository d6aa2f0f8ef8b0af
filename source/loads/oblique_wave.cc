#include <voussoir/loads/oblique_wave.h>

#include <map>

namespace Voussoir
{
  using namespace dealii;

  ObliqueWave::ObliqueWave(const Type              type,
                           const double            angle,
                           const double            azimuth,
                           const ElasticConstants &rock,
                           const Point<3>         &origin,
                           const double            delay)
    : origin(origin)
    , delay(delay)
  {
    const double cp = rock.p_wave_speed(), cs = rock.s_wave_speed();
    const double kappa  = cp / cs;
    const double lambda = rock.lame_lambda(), G = rock.shear_modulus();

    // directions in the plane of travel: horizontal h, vertical z
    const auto in_plane = [&](const double h, const double z) {
      return Tensor<1, 3>({h * std::cos(azimuth), h * std::sin(azimuth), z});
    };
    const Tensor<1, 3> across({-std::sin(azimuth), std::cos(azimuth), 0.});

    const auto add = [&](const Tensor<1, 3> &direction,
                         const double        speed,
                         const Tensor<1, 3> &polarisation) {
      // grad u = -(1/c) f' polarisation x direction
      SymmetricTensor<2, 3> strain =
        symmetrize(outer_product(polarisation, direction)) * (-1. / speed);
      SymmetricTensor<2, 3> stress = 2. * G * strain;
      for (unsigned int d = 0; d < 3; ++d)
        stress[d][d] += lambda * trace(strain);
      waves.push_back({direction / speed, polarisation, stress});
    };

    const double sin_a = std::sin(angle), cos_a = std::cos(angle);
    switch (type)
      {
        case Type::SH:
          add(in_plane(sin_a, cos_a), cs, across);
          add(in_plane(sin_a, -cos_a), cs, across);
          break;
        case Type::SV:
          {
            const double b   = std::asin(kappa * sin_a);
            const double c2  = std::cos(2. * angle);
            const double ss  = std::sin(2. * angle) * std::sin(2. * b);
            const double den = ss + kappa * kappa * c2 * c2;
            const double A1  = (ss - kappa * kappa * c2 * c2) / den;
            const double A2  = 2. * kappa * std::sin(2. * angle) * c2 / den;
            add(in_plane(sin_a, cos_a), cs, in_plane(cos_a, -sin_a));
            add(in_plane(sin_a, -cos_a), cs, A1 * in_plane(-cos_a, -sin_a));
            add(in_plane(std::sin(b), -std::cos(b)),
                cp,
                A2 * in_plane(std::sin(b), -std::cos(b)));
            break;
          }
        case Type::P:
          {
            const double b   = std::asin(sin_a / kappa);
            const double c2  = std::cos(2. * b);
            const double ss  = std::sin(2. * angle) * std::sin(2. * b);
            const double den = ss + kappa * kappa * c2 * c2;
            const double B1  = (ss - kappa * kappa * c2 * c2) / den;
            const double B2  = 2. * kappa * std::sin(2. * angle) * c2 / den;
            add(in_plane(sin_a, cos_a), cp, in_plane(sin_a, cos_a));
            add(in_plane(sin_a, -cos_a), cp, B1 * in_plane(sin_a, -cos_a));
            add(in_plane(std::sin(b), -std::cos(b)),
                cs,
                B2 * in_plane(std::cos(b), std::sin(b)));
            break;
          }
      }
  }


  double
  ObliqueWave::arrival(const Point<3> &point) const
  {
    return delay + waves[0].slowness * (point - origin);
  }


  Tensor<1, 3>
  ObliqueWave::displacement(const Signal   &motion,
                            const Point<3> &point,
                            const double    time) const
  {
    Tensor<1, 3> sum;
    for (const PlaneWave &wave : waves)
      sum +=
        motion.displacement(time - delay - wave.slowness * (point - origin)) *
        wave.polarisation;
    return sum;
  }


  Tensor<1, 3>
  ObliqueWave::velocity(const Signal   &motion,
                        const Point<3> &point,
                        const double    time) const
  {
    Tensor<1, 3> sum;
    for (const PlaneWave &wave : waves)
      sum += motion.velocity(time - delay - wave.slowness * (point - origin)) *
             wave.polarisation;
    return sum;
  }


  SymmetricTensor<2, 3>
  ObliqueWave::stress(const Signal   &motion,
                      const Point<3> &point,
                      const double    time) const
  {
    SymmetricTensor<2, 3> sum;
    for (const PlaneWave &wave : waves)
      sum += motion.velocity(time - delay - wave.slowness * (point - origin)) *
             wave.stress;
    return sum;
  }


  Tensor<1, 3>
  ObliqueWave::surface_factor() const
  {
    Tensor<1, 3> sum;
    for (const PlaneWave &wave : waves)
      sum += wave.polarisation;
    return sum;
  }


  ObliqueField::ObliqueField(const ObliqueWave        &wave,
                             std::unique_ptr<Signal> &&signal,
                             const BoundaryGeometry   &geometry)
    : wave(wave)
    , motion(std::move(signal))
    , nodes(geometry.nodes)
  {
    displacement.resize(nodes.size());
    velocity = force = displacement;

    // the nodes of a face share its points
    std::map<std::array<double, 3>, unsigned int> numbers;
    for (const auto &item : geometry.contributions)
      {
        const auto [place, is_new] = numbers.emplace(
          std::array<double, 3>{{item.point[0], item.point[1], item.point[2]}},
          points.size());
        if (is_new)
          points.push_back(item.point);
        shares.push_back({item.node, place->second, item.area});
      }
  }


  void
  ObliqueField::advance(const double time)
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        displacement[i] = wave.displacement(*motion, nodes[i], time);
        velocity[i]     = wave.velocity(*motion, nodes[i], time);
        force[i]        = 0.;
      }
    std::vector<SymmetricTensor<2, 3>> stresses;
    for (const Point<3> &point : points)
      stresses.push_back(wave.stress(*motion, point, time));
    for (const Share &share : shares)
      force[share.node] += stresses[share.point] * share.area;
  }
} // namespace Voussoir
