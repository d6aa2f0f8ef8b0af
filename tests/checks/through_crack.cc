#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block that is pulled by 4 mm sin(pi t)^2, all of which opens its middle
     * layer: from face to face if all cells there are weak, nowhere on the way
     * if the middle one bears a hundred times as much.
     */
    class ThroughCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        verdicts.near("all cells are weak: open all the way [mm]",
                      widest_way(file, communicator),
                      4.,
                      0.01);
        // half of the way in time
        std::ifstream in(folder + "/through_cracks.csv");
        std::string   line;
        for (unsigned int i = 0; i < 7; ++i)
          std::getline(in, line); // heading, t = 0 to 0.25 s
        verdicts.near("  at 0.25 s [mm]",
                      std::stod(line.substr(line.find(',') + 1)),
                      2.,
                      0.02);
        verdicts.is_true(
          "the middle one is sound: not open",
          widest_way(file.with({"Materials/middle/Tensile strength=1.8e8",
                                "Materials/middle/Fracture energy=1e7"}),
                     communicator) == 0.);
      }

    private:
      double
      widest_way(const ParameterFile &file, const MPI_Comm communicator) const
      {
        const auto parameters =
          make_case(file.with({"Output/Folder=" + folder}));
        make_simulation_with_files(*parameters, communicator)->run.march();
        MPI_Barrier(communicator);
        return read_summary(folder).at("through cracks").begin()->get<double>();
      }

      const std::string folder = "through_crack";
    };

    // Reference: closed form
    const Registry<Check>::Add<ThroughCrack>
      registered("through crack", "A crack from face to face, and none.");
  } // namespace
} // namespace Voussoir
