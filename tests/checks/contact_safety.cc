#include <voussoir/output/observer.h>

#include <filesystem>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The sliding safety that the observer "interfaces" reports for a block at
     * rest on an incline: (c A + f W cos) / (W sin), also where the block is
     * warmer than its base, so that shear in all directions cancels, and where
     * a moment pulls at the bond of one side.
     */
    class Safety : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Weight", weight, "Weight of the block [N].");
        prm.add_parameter("Area", area, "Area of its base [m2].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double friction =
          std::stod(file.given("Interfaces/plane/Friction coefficient"));
        for (const auto &[slope, cohesion] : std::vector<std::array<double, 2>>{
               {{0.4, 0.}}, {{0.9, 0.}}, {{1.2, 5e3}}})
          {
            const double angle  = std::atan(slope * friction),
                         normal = std::cos(angle), along = std::sin(angle);
            std::ostringstream name;
            name << "tan(theta) = " << slope
                 << " f, cohesion = " << 1e-3 * cohesion << " kPa: safety";
            for (const std::string stages : {"weight", "weight; warmth"})
              verdicts.near(
                stages + ", " + name.str(),
                reported(
                  file.with(
                    {vector_entry("Loads/weight/Acceleration",
                                  9.81 * Tensor<1, 3>({along, 0., -normal})),
                     "Interfaces/plane/Cohesion=" + std::to_string(cohesion),
                     "Loads/warmth/Active=" +
                       std::string(stages == "weight" ? "false" : "true"),
                     "Static state/Stages=" + stages}),
                  communicator),
                (cohesion * area + friction * weight * normal) /
                  (weight * along),
                0.01);
          }
        const double slope = 0.9 * friction, cohesion = 5e3,
                     angle = std::atan(slope);
        for (const std::string law : {"softening bond", "brittle bond"})
          verdicts.near(
            "bond that a moment pulls at, " + law + ": safety",
            reported(file.with(
                       {vector_entry("Loads/weight/Acceleration",
                                     9.81 * Tensor<1, 3>({std::sin(angle),
                                                          0.,
                                                          -std::cos(angle)})),
                        "Interfaces/plane/Law=" + law,
                        "Interfaces/plane/Tensile strength=1e6",
                        "Interfaces/plane/Cohesion=" + std::to_string(cohesion),
                        "Loads/warmth/Active=false",
                        "Loads/up/Active=true",
                        "Loads/down/Active=true",
                        "Static state/Stages=weight, up, down"}),
                     communicator),
            (cohesion * area + friction * weight * std::cos(angle)) /
              (weight * std::sin(angle)),
            0.01);
      }

    private:
      static double
      reported(const ParameterFile &file, const MPI_Comm communicator)
      {
        const auto  parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        ObservedRun model      = simulation->run.observed;
        model.folder           = "observed";
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          std::filesystem::create_directories(model.folder);
        MPI_Barrier(communicator);

        const auto observer =
          Registry<Observer>::create("interfaces", "the check");
        ParameterHandler prm;
        observer->declare_parameters(prm);
        observer->begin(model);
        observer->observe(simulation->run.state);
        nlohmann::json summary;
        observer->finish(simulation->run.state, summary);
        return summary.at("interfaces")
          .at("surfaces")
          .at("plane")
          .at("smallest sliding safety");
      }

      double weight = 1., area = 1.;
    };

    // Reference: closed form
    const Registry<Check>::Add<Safety>
      registered("contact safety",
                 "Sliding safety of a block in its static state.");
  } // namespace
} // namespace Voussoir
