#include <filesystem>

#include "contact_sums.h"
#include "csv_table.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Keys prevent a block from sliding on an incline: the interface
     * resists more shear than friction could, and has no sliding safety.
     * Without keys the interface has a safety, on an incline on which the block
     * sticks.
     */
    class KeyedSafety : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Weight", weight, "Weight of the block [N].");
        prm.add_parameter("Slopes",
                          slopes,
                          "Tangent over the friction coefficient, with keys "
                          "and without.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto keyed = on_slope(file, slopes[0]);
        verdicts.is_true("without keys the block slides",
                         !stands(keyed.with({"Interfaces/plane/Key depth=0"}),
                                 communicator));
        const Observed observed = observe(keyed, communicator);
        verdicts.near("with keys: shear over the resistance of friction",
                      observed.shear / (friction * observed.pressure),
                      slopes[0],
                      1e-3);
        verdicts.near("normal force over the block's",
                      observed.pressure,
                      weight * std::cos(std::atan(slopes[0] * friction)),
                      1e-3,
                      "N");
        verdicts.is_true("no safety of the surface in interfaces.csv",
                         observed.safety.empty());
        verdicts.is_true("none of the block", observed.block_safety.empty());
        verdicts.is_true(
          "none in the summary, and none below one",
          observed.surface.at("smallest sliding safety").is_null() &&
            observed.surface.at("time at safety one or below [s]") == 0.);
        verdicts.is_true("none of the block in the summary",
                         observed.block.at("safety at the start").is_null() &&
                           observed.block.at("smallest safety").is_null() &&
                           observed.block.at(
                             "time at safety one or below [s]") == 0.);

        const Observed bare = observe(
          on_slope(file, slopes[1]).with({"Interfaces/plane/Key depth=0"}),
          communicator);
        verdicts.near("without keys: safety in interfaces.csv",
                      std::stod(bare.safety),
                      1. / slopes[1],
                      1e-3);
        verdicts.near("of the block",
                      std::stod(bare.block_safety),
                      1. / slopes[1],
                      1e-3);
        verdicts.near("in the summary",
                      bare.surface.at("smallest sliding safety"),
                      1. / slopes[1],
                      1e-3);
      }

    private:
      /** Results of the observer for the block without motion. */
      struct Observed
      {
        double         pressure, shear;      // [N]
        std::string    safety, block_safety; // in interfaces.csv
        nlohmann::json surface, block;       // in summary.json
      };


      ParameterFile
      on_slope(const ParameterFile &file, const double slope)
      {
        friction =
          std::stod(file.given("Interfaces/plane/Friction coefficient"));
        const double angle = std::atan(slope * friction);
        return file.with({vector_entry(
          "Loads/weight/Acceleration",
          9.81 * Tensor<1, 3>({std::sin(angle), 0., -std::cos(angle)}))});
      }


      static Observed
      observe(const ParameterFile &file, const MPI_Comm communicator)
      {
        const std::string folder     = "keyed";
        const auto        parameters = make_case(file);
        const auto  simulation = make_simulation(*parameters, communicator);
        ObservedRun model      = simulation->run.observed;
        model.folder           = folder;
        std::filesystem::create_directories(folder);

        const auto observer =
          Registry<Observer>::create("interfaces", "the check");
        ParameterHandler prm;
        observer->declare_parameters(prm);
        prm.set("Blocks", "block: plane");
        observer->check(model);
        observer->begin(model);
        // two samples, so that time could pass at a safety below one
        observer->observe(simulation->run.state);
        State later = simulation->run.state;
        later.time  = 1.;
        observer->observe(later);
        nlohmann::json summary;
        observer->finish(later, summary);
        // as written in the file
        summary = nlohmann::json::parse(summary.dump()).at("interfaces");

        const CsvTable table(folder + "/interfaces.csv");
        const auto     last = [&](const std::string &title) {
          return table.texts(title).back();
        };
        return {1e6 * std::stod(last("plane normal force [MN]")),
                1e6 * std::stod(last("plane shear force [MN]")),
                last("plane sliding safety [-]"),
                last("block block safety [-]"),
                summary.at("surfaces").at("plane"),
                summary.at("blocks").at("block")};
      }

      double              weight = 1., friction = 0.;
      std::vector<double> slopes{1., 1.};
    };

    // Reference: closed form
    const Registry<Check>::Add<KeyedSafety>
      registered("keyed safety", "No sliding safety where keys prevent slip.");
  } // namespace
} // namespace Voussoir
