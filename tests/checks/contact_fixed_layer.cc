#include <voussoir/base/text.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A thin layer fixed at its top, with its foot on a plane, and shear
     * tractions at the foot in static stages: the plane resists R of the
     * shear t and the layer the rest, t = R + k s with k = G / H. The foot
     * sticks while |R| is below c + f p, then slides until |R| is at that
     * limit, or at the limit of the broken bond, which stays broken; p = rho g
     * H / 2.
     */
    class FixedLayer : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Height", height, "Height of the layer [m].");
        prm.add_parameter("Tractions", tractions, "After the stages [Pa].");
        prm.add_parameter("Cohesion", cohesion, "Whole and broken [Pa].");
        prm.add_parameter("Friction", friction, "Whole and broken.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto entry = [&](const std::string &name) {
          return std::stod(file.given("Materials/stone/" + name));
        };
        const double stiffness = 0.5 * entry("Young's modulus") / height,
                     pressure  = 0.5 * entry("Density") * 9.81 * height;
        const auto limit       = [&](const bool broken) {
          return cohesion[broken] + friction[broken] * pressure;
        };
        double      slip   = 0.;
        bool        broken = false;
        std::string stages = "weight";
        for (unsigned int i = 0; i < tractions.size(); ++i)
          {
            const double shear = tractions[i] - stiffness * slip;
            if (std::abs(shear) > limit(broken))
              {
                broken = true;
                slip   = (tractions[i] - std::copysign(limit(true), shear)) /
                       stiffness;
              }
            stages += "; shear " + std::to_string(i + 1);
            const auto parameters =
              make_case(file.with({"Static state/Stages=" + stages}));
            const auto simulation = make_simulation(*parameters, communicator);
            double     found = 0., area = 0.;
            for (const ContactPoint &point : simulation->run.contact->points())
              {
                found += point.area * (point.gap * point.frame)[0];
                area += point.area;
              }
            found = Utilities::MPI::sum(found, communicator) /
                    Utilities::MPI::sum(area, communicator);
            std::ostringstream name;
            name << "t = " << 1e-3 * tractions[i] << " kPa: slip [mm]";
            if (slip == 0.)
              verdicts.below(name.str(), 1e3 * found, 1e-6);
            else
              verdicts.near(name.str(), 1e3 * found, 1e3 * slip, 0.02);
          }
      }

    private:
      double              height = 1.;
      std::vector<double> tractions{0.};
      Tensor<1, 2>        cohesion, friction;
    };

    // Reference: closed form
    const Registry<Check>::Add<FixedLayer>
      registered("contact fixed layer",
                 "A layer that is sheared over a plane in static stages.");
  } // namespace
} // namespace Voussoir
