// Rock that yields on the planes of Mohr and Coulomb.

#include <voussoir/base/usual_range.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/perfect_plasticity.h>
#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * In principal stresses s1 >= s2 >= s3, the planes
     *   (si - sj) + (si + sj) sin phi <= 2 c cos phi   (i < j)
     * and the tension cut-off si <= ft, at or before the apex. Plastic flow is
     * along (ei - ej) + (ei + ej) sin psi, and ei on the cut-off. Planes, edges
     * and corners are the sets of up to three of these six; on each the return
     * is linear; the admissible one has no negative multiplier and violates no
     * plane.
     */
    struct MohrCoulomb : PerfectPlasticity
    {
      using Triple = Tensor<1, 3>;

      struct Plane
      {
        Triple normal;
        double limit = 0.;
        Triple flow; // elastic stress of the flow
      };

      /** Planes that the stress returns to. */
      struct Corner
      {
        std::vector<unsigned int> planes;
        Tensor<2, 3>              inverse; // of normal times flow
      };

      std::vector<Plane>  planes;
      std::vector<Corner> corners;
      double              sine = 0., strength = 0., tension = 0.;

      void
      declare_parameters(ParameterHandler &prm)
      {
        PerfectPlasticity::declare_parameters(prm);
        prm.add_parameter("Tension cut-off",
                          cut_off,
                          "Largest principal stress [Pa]; beyond the apex it "
                          "has no effect." +
                            usually(Usual::cut_off),
                          Patterns::Double(1.));
      }

      void
      check(const std::string &place)
      {
        PerfectPlasticity::check(place);
        const double phi = friction_angle * numbers::PI / 180.,
                     psi = dilation_angle * numbers::PI / 180.;
        sine             = std::sin(phi);
        strength         = cohesion * std::cos(phi);
        tension = sine * cut_off > strength ? strength / sine : cut_off;

        planes.clear();
        const auto add = [&](const Triple &normal,
                             const double  limit,
                             const Triple &direction) {
          Plane        plane{normal, limit, 2. * shear_modulus() * direction};
          const double sum = direction[0] + direction[1] + direction[2];
          for (unsigned int d = 0; d < 3; ++d)
            plane.flow[d] += (bulk_modulus() - 2. / 3. * shear_modulus()) * sum;
          planes.push_back(plane);
        };
        const auto unit = [](const unsigned int i) {
          Triple result;
          result[i] = 1.;
          return result;
        };
        for (const auto &[i, j] :
             {std::pair{0, 2}, std::pair{0, 1}, std::pair{1, 2}})
          add((1. + sine) * unit(i) - (1. - sine) * unit(j),
              2. * strength,
              (1. + std::sin(psi)) * unit(i) - (1. - std::sin(psi)) * unit(j));
        for (unsigned int i = 0; i < 3; ++i)
          add(unit(i), tension, unit(i));

        // single planes first, which most points return to
        corners.clear();
        for (unsigned int size = 1; size <= 3; ++size)
          for (unsigned int set = 1; set < 64; ++set)
            {
              Corner corner;
              for (unsigned int k = 0; k < 6; ++k)
                if ((set >> k) & 1)
                  corner.planes.push_back(k);
              if (corner.planes.size() != size)
                continue;
              Tensor<2, 3> matrix = unit_symmetric_tensor<3>();
              for (unsigned int k = 0; k < size; ++k)
                for (unsigned int l = 0; l < size; ++l)
                  matrix[k][l] = planes[corner.planes[k]].normal *
                                 planes[corner.planes[l]].flow / young_modulus;
              if (std::abs(determinant(matrix)) < 1e-6)
                continue;
              corner.inverse = invert(matrix) / young_modulus;
              corners.push_back(corner);
            }
      }

      template <typename Number>
      Number
      yield_ratio(const SymmetricTensor3<Number> &stress, const Number &) const
      {
        // over all Lode angles: p sin phi + sqrt(J2 (1 + sin^2 phi / 3)), and
        // principal values within p +- 2 sqrt(J2 / 3)
        const auto [first, second] = invariants(stress);
        const Number mean = first / 3., shear = std::sqrt(Number(second));
        return std::max(Number((sine * mean +
                                std::sqrt(1. + sine * sine / 3.) * shear) /
                               strength),
                        Number((mean + 2. / std::sqrt(3.) * shear) / tension));
      }

      /** The largest excess over a plane [Pa]. */
      double
      violation(const Triple &stress) const
      {
        double largest = -1e300;
        for (const Plane &plane : planes)
          largest = std::max(largest, plane.normal * stress - plane.limit);
        return largest;
      }

      /** Returns to the surface, from principal stresses in descending order.
       */
      Triple
      returned(const Triple &trial) const
      {
        const double tolerance = 1e-12 * (trial.norm() + strength);
        double       least     = 1e300;
        Triple       best      = trial;
        for (const Corner &corner : corners)
          {
            const unsigned int n = corner.planes.size();
            Triple             excess;
            for (unsigned int k = 0; k < n; ++k)
              {
                const Plane &plane = planes[corner.planes[k]];
                excess[k]          = plane.normal * trial - plane.limit;
              }
            const Triple multipliers = corner.inverse * excess;
            Triple       now         = trial;
            double       miss        = 0.;
            for (unsigned int k = 0; k < n; ++k)
              {
                now -= multipliers[k] * planes[corner.planes[k]].flow;
                miss = std::max(miss, -multipliers[k] * young_modulus);
              }
            miss = std::max(miss, violation(now));
            if (miss < least)
              {
                least = miss;
                best  = now;
              }
            if (least < tolerance)
              break;
          }
        return best;
      }

      template <typename Number>
      PointResponse<Number>
      respond(const SymmetricTensor3<Number> &strain,
              Number                         *history,
              const PointSituation<Number> &) const
      {
        const SymmetricTensor3<Number> trial =
          stress(strain - tensor_of(history));
        const auto            principal = spectrum(trial);
        std::array<Number, 3> excess;
        for (unsigned int lane = 0; lane < n_lanes<Number>(); ++lane)
          {
            std::array<unsigned int, 3> order{{0, 1, 2}};
            std::sort(order.begin(),
                      order.end(),
                      [&](const unsigned int i, const unsigned int j) {
                        return lane_of(principal.values[i], lane) >
                               lane_of(principal.values[j], lane);
                      });
            Triple sorted;
            for (unsigned int d = 0; d < 3; ++d)
              sorted[d] = lane_of(principal.values[order[d]], lane);
            const Triple change =
              violation(sorted) > 0. ? sorted - returned(sorted) : Triple();
            for (unsigned int d = 0; d < 3; ++d)
              lane_of(excess[order[d]], lane) = change[d];
          }
        return flow(strain, trial, principal.compose(excess), history);
      }
    };

    const Registry<Material>::Add<MaterialOf<MohrCoulomb>>
      registered_mohr_coulomb(
        "mohr-coulomb",
        "Rock that yields on the planes of Mohr and Coulomb without hardening, "
        "with tension cut-off.");
  } // namespace
} // namespace Voussoir
