#include "csv_table.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Runs a case with its files in this folder, and returns the results of
     * the observer "through cracks". */
    nlohmann::json
    through_cracks_of(const ParameterFile &file,
                      const std::string   &folder,
                      const MPI_Comm       communicator)
    {
      const auto parameters = make_case(file.with({"Output/Folder=" + folder}));
      make_simulation_with_files(*parameters, communicator)->run.march();
      MPI_Barrier(communicator);
      return read_summary(folder).at("through cracks");
    }


    /**
     * A block that is pulled by 4 mm sin(pi t)^2, all of which is the opening
     * of its middle layer: from face to face if all cells there are weak,
     * nowhere if the middle one is a hundred times as strong.
     */
    class ThroughCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto all_weak = through_cracks_of(file, folder, communicator);
        verdicts.near("all cells are weak: open from face to face [mm]",
                      all_weak.at(largest),
                      4.,
                      0.01);
        verdicts.near("  at the time [s]",
                      all_weak.at("at the time [s]"),
                      0.5,
                      0.1);
        verdicts.below("  at the end, when it is closed [mm]",
                       all_weak.at("opening from face to face at the end [mm]"),
                       0.01);
        const CsvTable table(folder + "/through_cracks.csv");
        const auto now = table.numbers("opening from face to face now [mm]");
        const auto ever =
          table.numbers("largest openings ever from face to face [mm]");
        // lines every 0.05 s
        verdicts.near("  now, at 0.25 s [mm]", now.at(5), 2., 0.02);
        verdicts.near("  now, at 0.75 s [mm]", now.at(15), 2., 0.02);
        verdicts.near("  largest ever, at 0.75 s [mm]", ever.at(15), 4., 0.01);
        const auto materials = read_summary(folder).at("materials").at("weak");
        verdicts.near("  largest crack opening [mm]",
                      materials.at("largest crack opening [mm]"),
                      4.,
                      0.01);
        verdicts.below("  widest crack opening at the end [mm]",
                       materials.at("widest crack opening at the end [mm]"),
                       0.01);

        const auto one_sound =
          through_cracks_of(file.with(
                              {"Materials/middle/Tensile strength=1.8e8",
                               "Materials/middle/Fracture energy=1e7"}),
                            folder,
                            communicator);
        verdicts.near("the middle one is sound: open from face to face [mm]",
                      one_sound.at(largest),
                      0.,
                      0.);
      }

    private:
      const std::string
        folder  = "through_crack",
        largest = "largest opening from face to face at one moment [mm]";
    };


    /**
     * A block pressed on its foundation, which a force at its top bends to and
     * fro: the eccentricity e of the pressure on a weak layer opens it from
     * either face in turn, and as e stays within the layer, a part of it is
     * always in compression.
     */
    class CracksInTurn : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const std::string folder = "cracks_in_turn";
        const auto        found = through_cracks_of(file, folder, communicator);
        const CsvTable    table(folder + "/through_cracks.csv");
        double            now = 0., ever = 0.;
        for (const double way :
             table.numbers("opening from face to face now [mm]"))
          keep_largest(now, way);
        for (const double way :
             table.numbers("largest openings ever from face to face [mm]"))
          keep_largest(ever, way);
        // struts beside the pressed end open by less
        verdicts.below(
          "open from face to face at one moment, of all lines [mm]", now, 0.01);
        verdicts.below(
          "  of the run [mm]",
          found.at("largest opening from face to face at one moment [mm]"),
          0.01);
        verdicts.above("largest openings ever, of whatever moments [mm]",
                       ever,
                       0.1);
        verdicts.above("  of the run [mm]",
                       found.at("largest openings ever from face to face [mm]"),
                       0.01);
      }
    };

    /**
     * A plate that is pulled apart by 1 mm along a layer at an angle to its
     * principal stress: the crack is as wide as the ends have moved, with the
     * stress along it that its shear leaves.
     */
    class InclinedCrack : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string direction : {"rotating", "fixed"})
          {
            const std::string folder = "inclined_crack_" + direction;
            const auto        found =
              through_cracks_of(file.with({"Materials/weak/Crack direction=" +
                                           direction}),
                                folder,
                                communicator);
            verdicts.near(
              direction + ": open from face to face at one moment [mm]",
              found.at("largest opening from face to face at one moment [mm]"),
              1.,
              0.1);
            verdicts.near("  at the end [mm]",
                          found.at("opening from face to face at the end [mm]"),
                          1.,
                          0.1);
          }
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<ThroughCrack>
      registered("through crack", "A crack from face to face, and none.");
    // Reference: closed form
    const Registry<Check>::Add<InclinedCrack>
      inclined("inclined crack", "A crack at an angle to rows of cells.");
    // Reference: closed form
    const Registry<Check>::Add<CracksInTurn>
      in_turn("cracks in turn", "Cracks from both faces that never meet.");
  } // namespace
} // namespace Voussoir
