#include <voussoir/base/text.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A bar fixed at both ends, with a bond in its middle, in static stages:
     * cooled until the bond breaks, warmed until the joint has closed again,
     * and cooled once more by so little that a whole bond would resist it. By
     * then the joint is open by L alpha T and transmits nothing.
     */
    class LostBond : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Laws", laws, "Laws of the joint.");
        prm.add_parameter("Length", length, "Length of the bar [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto entry = [&](const std::string &name) {
          return std::stod(file.given("Materials/stone/" + name));
        };
        const double expansion = entry("Thermal expansion"),
                     modulus   = entry("Young's modulus");
        for (const std::string &law : split_list(laws))
          {
            const std::vector<std::string> all{"cold", "warm", "cool"};
            std::string                    stages;
            std::vector<std::string> changes{"Interfaces/joint/Law=" + law};
            for (const std::string &stage : all)
              changes.push_back("Loads/" + stage + "/Active=false");
            double change = 0.;
            for (const std::string &stage : all)
              {
                stages += (stages.empty() ? "" : "; ") + stage;
                changes.push_back("Loads/" + stage + "/Active=true");
                changes.push_back("Static state/Stages=" + stages);
                change +=
                  std::stod(file.given("Loads/" + stage + "/Uniform change"));
                const auto parameters = make_case(file.with(changes));
                const auto simulation =
                  make_simulation(*parameters, communicator);
                const ContactSums sums = contact_sums(*simulation, 0);
                const std::string name = law + ", " + stage + ": ";
                if (change > 0.)
                  verdicts.near(name + "pressure [MPa]",
                                1e-6 * sums.pressure / sums.area,
                                1e-6 * modulus * expansion * change,
                                0.005);
                else
                  {
                    verdicts.near(name + "opening [mm]",
                                  1e3 * sums.opening,
                                  -1e3 * expansion * change * length,
                                  0.005);
                    verdicts.below(name + "tension [Pa]",
                                   sums.pressure / sums.area,
                                   1.);
                  }
              }
          }
      }

    private:
      std::string laws   = "brittle bond";
      double      length = 1.;
    };

    // Reference: closed form
    const Registry<Check>::Add<LostBond>
      registered("contact lost bond",
                 "A bond that breaks in a static stage stays broken.");


    /** The same of a bond that breaks in shear while it is open: pushed aside,
     *  the cooled bar has an opening too small to break the bond. */
    class BondLostInShear : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Opening", opening, "L alpha T [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters  = make_case(file);
        const auto simulation  = make_simulation(*parameters, communicator);
        const ContactSums sums = contact_sums(*simulation, 0);
        verdicts.near("mean opening [mm]",
                      1e3 * sums.opening,
                      1e3 * opening,
                      0.005);
        verdicts.below("tension [Pa]", sums.pressure / sums.area, 1.);
      }

    private:
      double opening = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<BondLostInShear> registered_in_shear(
      "contact bond lost in shear",
      "A bond that breaks in shear in a static stage stays broken.");
  } // namespace
} // namespace Voussoir
