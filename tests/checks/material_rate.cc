#include <voussoir/materials/point_test.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Damage with a delay: under a constant rate of strain the equivalent
     * strain of a point without lateral contraction is
     *   x = e - T de/dt (1 - exp(-(t - t0)/T)) ,
     * with the time t0 of cracking, and with linear softening to zero at the
     * strain w/l the stress is ft (w/l - x)/(w/l - ft/E) e/x.
     */
    class MaterialRate : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const double ft = 2e6, modulus = 20e9, energy = 200., length = 0.5,
                     lag   = 1e-3;
        const double first = ft / modulus, last = 2. * energy / ft / length;
        for (const double rate : {0.02, 0.1})
          {
            const auto   parameters = make_case(file);
            const double time_step  = 1e-7 / rate;
            PointTest    test(*parameters->material_list().at(0),
                           length,
                           time_step);
            double       strain = 0.;
            for (const double target : {1.5e-4, 2e-4, 3e-4})
              {
                for (; strain < target; strain += 1e-7)
                  {
                    PointTest::Controls controls;
                    controls[0] = {true, strain};
                    test.advance(controls);
                  }
                const double now = test.strain[0][0];
                const double slow =
                  now -
                  lag * rate * (1. - std::exp(-(now - first) / (rate * lag)));
                std::ostringstream name;
                name << "stress at a rate of " << rate << "/s and a strain of "
                     << 1e3 * target << " mm/m";
                verdicts.near(name.str(),
                              1e-6 * test.stress[0][0],
                              1e-6 * ft * (last - slow) / (last - first) * now /
                                slow,
                              2e-3,
                              "MPa");
              }
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<MaterialRate>
      registered("material rate", "Concrete with delayed damage.");
  } // namespace
} // namespace Voussoir
