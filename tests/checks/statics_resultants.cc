#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Resultants of the loads of the Koyna section against loaded areas, and
     * the reactions against the loads.
     */
    class KoynaResultants : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        const auto &stages     = simulation->static_state.summary.at("stages");

        std::map<std::string, Tensor<1, 3>> found;
        Tensor<1, 3>                        applied;
        for (const auto &stage : stages)
          {
            for (const auto &[name, load] : stage.at("loads").items())
              {
                applied += found[name] = vector(load.at("resultant [N]"));
                const Tensor<1, 3> by_geometry =
                  vector(load.at("resultant by volumes and areas [N]"));
                verdicts.below(name + ": forces and geometry differ by",
                               (by_geometry - found[name]).norm() /
                                 found[name].norm(),
                               name == "weight" ? 1e-8 : 1e-3);
              }
            const Tensor<1, 3> reactions =
              vector(stage.at("sum of reactions [N]"));
            verdicts.below("reactions and loads of a stage, sum over loads",
                           (applied + reactions).norm() / applied.norm(),
                           1e-8);
          }

        // per metre of the slice: polygon of the section; z up, the river flows
        // to negative y
        const double area =
          0.5 * (70. + 19.25) * 66.5 + 0.5 * (19.25 + 14.8) * (103. - 66.5);
        const double thickness =
          std::stod(file.given("Mesh/gravity section/Thickness"));
        const double slope  = (70. - 19.25) / 66.5; // below the neck
        const auto   thrust = [&](const std::string &load,
                                const double       gradient) {
          return 0.5 * gradient *
                 std::pow(std::stod(file.given("Loads/" + load + "/Level")), 2);
        };
        const double tailwater = thrust("tailwater", 9810.);
        const double angle     = (45. - 15. / 2.) * numbers::PI / 180.;
        const auto   near      = [&](const std::string &name,
                              const std::string &load,
                              const unsigned int d,
                              const double       reference) {
          verdicts.near(name,
                        1e-6 * found.at(load)[d] / thickness,
                        1e-6 * reference,
                        1e-8,
                        "MN/m");
        };
        near("weight", "weight", 2, -area * 2643. * 9.81);
        near("water on the upright face", "water", 1, -thrust("water", 9810.));
        near("silt",
             "silt",
             1,
             -thrust("silt", 9e3 * std::pow(std::tan(angle), 2)));
        near("tailwater, along the river", "tailwater", 1, tailwater);
        near("tailwater, downwards", "tailwater", 2, -slope * tailwater);
      }

    private:
      static Tensor<1, 3>
      vector(const nlohmann::json &values)
      {
        Tensor<1, 3> result;
        for (unsigned int d = 0; d < 3; ++d)
          result[d] = values[d];
        return result;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<KoynaResultants>
      registered("Koyna resultants", "Resultants of loads and reactions.");
  } // namespace
} // namespace Voussoir
