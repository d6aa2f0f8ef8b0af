#include <voussoir/materials/point_test.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Cracking in mixed mode: the path of strains of Willam, Pramono and Sture
     * (1987) in plane stress. A point is pulled along z to its strength, and
     * then the strains continue as de_zz : de_xx : dgamma_xz = 0.5 : 0.75 : 1 ,
     * so that the principal axes turn while the crack opens. A rotating crack
     * has the axes of the strain, never more stress than the strength, and no
     * shear stress at the end; with fixed cracks some shear stress remains.
     */
    class Willam : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tensile strength", strength, "[Pa]");
        prm.add_parameter("Fracture energy", energy, "[N/m]");
        prm.add_parameter("Cell size", size, "[m]");
        prm.add_parameter("Axes turn",
                          turns,
                          "Whether the stress has the axes of the strain.");
        prm.add_parameter("Stages",
                          stages,
                          "Shear strain gamma, largest stress, shear stress "
                          "[Pa], energy lost [N/m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const auto      parameters = make_case(file);
        const Material &material   = *parameters->material_list().at(0);
        const double    first =
          strength / material.elastic_constants().young_modulus;
        PointTest test(material, size, 1e-3);
        Envelope  envelope;
        for (unsigned int i = 1; i <= 100; ++i)
          {
            PointTest::Controls controls;
            controls[2] = {true, first * i / 100.};
            test.advance(controls);
            envelope.evaluate(test);
          }
        const auto cracked = test.strain;
        double     shear   = 0.;
        const auto go_to   = [&](const double target) {
          while (shear < target - 1e-9)
            {
              shear += 1e-7;
              advance(test, cracked, shear);
              envelope.evaluate(test);
            }
        };
        for (const std::string &stage : split_list(stages))
          {
            const auto numbers =
              Utilities::string_to_double(split_list(stage, ':'));
            go_to(numbers[0]);
            compare(test, numbers, verdicts);
          }
        go_to(6e-4);
        judge(test, envelope, verdicts);
      }

    private:
      /** Proceeds to a shear strain gamma after cracking. */
      static void
      advance(PointTest                   &test,
              const SymmetricTensor<2, 3> &cracked,
              const double                 shear)
      {
        PointTest::Controls controls;
        controls[0] = {true, cracked[0][0] + 0.75 * shear};
        controls[2] = {true, cracked[2][2] + 0.5 * shear};
        controls[4] = {true, 0.5 * shear};
        test.advance(controls);
      }

      /** The extremes of a path. */
      struct Envelope
      {
        double largest = 0.; // principal stress
        double turned  = 0.; // stress and strain that do not commute [Pa]
        double made    = 0.; // energy lost in a step, if below zero
        double missing = 0.; // work less energy stored and lost
        double lost    = 0.;

        void
        evaluate(const PointTest &test)
        {
          keep_largest(largest, eigenvalues(test.stress)[0]);
          const Tensor<2, 3> product =
            Tensor<2, 3>(test.stress) * Tensor<2, 3>(test.strain);
          keep_largest(turned,
                       (product - transpose(product)).norm() /
                         test.strain.norm());
          keep_smallest(made, test.dissipated - lost);
          lost = test.dissipated;
          keep_largest(missing,
                       std::abs(test.work - test.dissipated - test.stored));
        }
      };

      void
      compare(const PointTest           &test,
              const std::vector<double> &expected,
              Verdicts                  &verdicts) const
      {
        std::ostringstream name;
        name << " at a shear strain of " << 1e3 * expected[0] << " mm/m";
        verdicts.near("largest stress" + name.str(),
                      1e-6 * eigenvalues(test.stress)[0],
                      1e-6 * expected[1],
                      1e-3,
                      "MPa");
        verdicts.near("shear stress" + name.str(),
                      1e-6 * test.stress[0][2],
                      1e-6 * expected[2],
                      1e-3,
                      "MPa");
        verdicts.near("energy lost" + name.str(),
                      size * test.dissipated,
                      expected[3],
                      2e-3,
                      "N/m");
      }

      void
      judge(const PointTest &test,
            const Envelope  &envelope,
            Verdicts        &verdicts) const
      {
        verdicts.near("largest principal stress of all",
                      1e-6 * envelope.largest,
                      1e-6 * strength,
                      1e-4,
                      "MPa");
        if (turns)
          verdicts.below("axes of the stress off those of the strain",
                         envelope.turned / strength,
                         1e-10);
        verdicts.below(
          "energy generated in a step, over the energy of the crack",
          envelope.made * size / energy,
          1e-12);
        verdicts.below("work less energy stored and lost, over the same",
                       envelope.missing * size / energy,
                       1e-3);
        verdicts.below("largest principal stress at the end, over the strength",
                       eigenvalues(test.stress)[0] / strength,
                       1e-6);
        verdicts.below("shear stress at the end, over the strength",
                       test.stress[0][2] / strength,
                       1e-6);
        verdicts.above("energy lost over the energy of one crack",
                       size * test.dissipated / energy,
                       1.);
      }

      double      strength = 3e6, energy = 300., size = 0.5;
      bool        turns = true;
      std::string stages;
    };

    // Reference: published
    const Registry<Check>::Add<Willam>
      registered("willam", "A crack whose principal axes turn.");
  } // namespace
} // namespace Voussoir
