#include <voussoir/materials/tension_split.h>

#include <random>

#include "point_path.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Tensor2 = SymmetricTensor<2, 3>;

    Tensor2
    jump(const Tensor<1, 3> &normal, const Tensor<1, 3> &opening)
    {
      return symmetrize(outer_product(normal, opening));
    }


    /**
     * Cracks at an angle to the rows of cells: their strain sym(n m) w / l, of
     * a crack of normal n whose faces part in the direction m, has a negative
     * principal value.
     */
    class ObliqueCrack : public MaterialCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", strength, "[Pa]");
        prm.add_parameter("Fracture energy", energy, "[N/m]");
        prm.add_parameter("Angles", angles, "Between n and m [degrees].");
        prm.add_parameter("Largest stress left",
                          most_left,
                          "Over the strength, once open by ten times the ratio "
                          "of energy and strength.");
      }

      void
      evaluate(const Material &material, Verdicts &verdicts) const override
      {
        check_conditions(verdicts);
        for (const double angle : angles)
          open(material, angle, verdicts);
        close(material, verdicts);
        verdicts.near("largest change of half a step over that of one",
                      largest_change(material, 8000) /
                        largest_change(material, 4000),
                      0.5,
                      0.05,
                      "");
      }

    private:
      /**
       * The conditions of least energy, for any method: the strain of the
       * cracks a and the remaining stress n lie in cones that are polar to each
       * other, and n : a = 0.
       */
      void
      check_conditions(Verdicts &verdicts) const
      {
        std::mt19937                     random(31);
        std::normal_distribution<double> normal_distribution;
        double product = 0., strain_off = 0., stress_off = 0.;
        for (const double nu : {0., 0.2, 0.35})
          for (const double friction : {0.3, 1., 1.7})
            for (unsigned int repetition = 0; repetition < 1000; ++repetition)
              {
                IsotropicElasticity elasticity;
                elasticity.young_modulus = 1.;
                elasticity.poisson_ratio = nu;
                Tensor2 strain;
                for (unsigned int i = 0; i < 6; ++i)
                  strain.access_raw_entry(i) = normal_distribution(random);
                Tensor<1, 3> normal;
                for (unsigned int d = 0; d < 3; ++d)
                  normal[d] = normal_distribution(random);
                normal /= normal.norm();
                const Tensor2 left = stress_beside_crack(
                  elasticity.stress(strain), normal, elasticity, friction);
                const Tensor2 cracks = strain - elasticity.strain(left);
                keep_largest(product, std::abs(left * cracks));

                // a = sym(n c) + b
                const Tensor<1, 3> half    = cracks * normal;
                const double       opening = half * normal;
                const Tensor<1, 3> slip    = 2. * (half - opening * normal);
                const Tensor2      beside =
                  cracks - jump(normal, opening * normal) - jump(normal, slip);
                keep_largest(strain_off, -eigenvalues(beside)[2]);
                keep_largest(strain_off, friction * slip.norm() - opening);

                const Tensor<1, 3> traction = left * normal;
                const double       pull     = traction * normal;
                const Tensor<1, 3> shear    = traction - pull * normal;
                const Tensor2      in_plane =
                  left - 2. * jump(normal, shear) - jump(normal, pull * normal);
                keep_largest(stress_off, eigenvalues(in_plane)[0]);
                keep_largest(stress_off, shear.norm() + friction * pull);
              }
        verdicts.below("stress left times the strain of the cracks",
                       product,
                       1e-12);
        // roots of round-off where two principal values are equal
        verdicts.below("strain of the cracks outside its cone",
                       strain_off,
                       1e-6);
        verdicts.below("stress left outside the polar cone", stress_off, 1e-6);
      }


      /** A point pulled along x to its strength, and then apart at an angle. */
      void
      open(const Material &material,
           const double    angle,
           Verdicts       &verdicts) const
      {
        const double size = 0.5, radian = angle * numbers::PI / 180.;
        const double modulus = material.elastic_constants().young_modulus;
        Tensor<1, 3> normal, direction;
        normal[0]    = 1.;
        direction[0] = std::cos(radian);
        direction[2] = std::sin(radian);
        const PointSituation<double> situation{size, 1e-3};
        std::vector<double>          history(material.n_history());
        Tensor2                      strain;
        for (unsigned int i = 1; i <= 105; ++i)
          {
            strain[0][0] = 0.01 * i * strength / modulus;
            strain[1][1] = strain[2][2] =
              -material.elastic_constants().poisson_ratio * strain[0][0];
            material.respond(strain, history.data(), situation);
          }
        Tensor2      stress;
        const double apart = 10. * energy / strength / size;
        for (unsigned int i = 1; i <= 2000; ++i)
          {
            // also relieved along the crack
            const double share = i / 2000.;
            stress             = material
                       .respond((1. - share) * strain +
                                  jump(normal, share * apart * direction),
                                history.data(),
                                situation)
                       .stress;
          }
        std::ostringstream name;
        name << "stress left over the strength at " << angle << " degrees";
        verdicts.below(name.str(), stress.norm() / strength, most_left);
      }


      /** The work of a closed path of strains is the energy stored and lost at
       *  its end, and zero as long as damage does not grow. */
      void
      close(const Material &material, Verdicts &verdicts) const
      {
        const PointSituation<double> situation{0.5, 1e-3};
        const double                 largest =
          40. * strength / material.elastic_constants().young_modulus;
        std::mt19937                     random(5);
        std::normal_distribution<double> normal_distribution;
        double                           missing = 0.;
        for (unsigned int repetition = 0; repetition < 20; ++repetition)
          {
            std::vector<double> history(material.n_history());
            Tensor2             strain;
            for (unsigned int i = 1; i <= 400; ++i)
              {
                strain[0][0] = largest * i / 400.;
                material.respond(strain, history.data(), situation);
              }
            std::vector<Tensor2> corners(5);
            for (unsigned int i = 1; i < 5; ++i)
              for (unsigned int k = 0; k < 6; ++k)
                corners[i].access_raw_entry(k) =
                  0.05 * largest * normal_distribution(random);
            corners.push_back(corners[1]);
            double  work = 0., most = 0., last_stored = 0.;
            Tensor2 last_strain, last_stress;
            for (unsigned int i = 0; i + 1 < corners.size(); ++i)
              for (unsigned int step = 1; step <= 4000; ++step)
                {
                  const Tensor2 now =
                    corners[i] + step / 4000. * (corners[i + 1] - corners[i]);
                  const auto response =
                    material.respond(now, history.data(), situation);
                  const double stored = 0.5 * (response.stress * now);
                  work += 0.5 * ((response.stress + last_stress) *
                                 (now - last_strain)) -
                          (stored - last_stored) - response.dissipation;
                  keep_largest(most, stored);
                  last_strain = now;
                  last_stress = response.stress;
                  last_stored = stored;
                }
            keep_largest(missing, std::abs(work) / most);
          }
        verdicts.below("work less what is stored and lost, over the largest "
                       "energy stored",
                       missing,
                       2e-3);
      }

      /** Largest change of the stress over the strength in one of @p steps from
       * one random strain of an open crack to the next: half as large in half
       * the step unless the stress jumps. */
      double
      largest_change(const Material &material, const unsigned int steps) const
      {
        const PointSituation<double> situation{0.5, 1e-3};
        const double                 widest =
          40. * strength / material.elastic_constants().young_modulus;
        std::mt19937                     random(7);
        std::normal_distribution<double> normal_distribution;
        std::vector<double>              history(material.n_history());
        Tensor2                          begin, last;
        for (unsigned int i = 1; i <= 400; ++i)
          {
            begin[0][0] = widest * i / 400.;
            last = material.respond(begin, history.data(), situation).stress;
          }
        double largest = 0.;
        for (unsigned int corner = 0; corner < 100; ++corner)
          {
            Tensor2 end;
            for (unsigned int k = 0; k < 6; ++k)
              end.access_raw_entry(k) =
                0.05 * widest * normal_distribution(random);
            for (unsigned int step = 1; step <= steps; ++step)
              {
                const Tensor2 stress =
                  material
                    .respond(begin + double(step) / steps * (end - begin),
                             history.data(),
                             situation)
                    .stress;
                keep_largest(largest, (stress - last).norm() / strength);
                last = stress;
              }
            begin = end;
          }
        return largest;
      }

      double              strength = 2.5e6, energy = 250.;
      std::vector<double> angles{0.};
      double              most_left = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<ObliqueCrack>
      registered("oblique crack",
                 "Cracks at an angle to the rows of cells that they run in.");
  } // namespace
} // namespace Voussoir
