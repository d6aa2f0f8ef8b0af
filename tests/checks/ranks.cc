#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * All ranks together, with either partition, compute what one rank computes
     * by itself.
     */
    class Ranks : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points", points, "Points to compare.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto alone = history(file, "p4est", MPI_COMM_SELF);
        for (const std::string partition : {"p4est", "METIS"})
          {
            verdicts.above("largest displacement [mm]",
                           1e3 * alone.largest(),
                           0.1);
            verdicts.below("difference to one rank, by " + partition,
                           relative_difference(
                             history(file, partition, communicator), alone),
                           1e-9);
          }
      }

    private:
      Histories
      history(const ParameterFile &file,
              const std::string   &partition,
              const MPI_Comm       communicator) const
      {
        // the stable step differs in the last digits, so it is given
        const auto parameters =
          make_case(file.with({"Mesh/Partition=" + partition}));
        const auto simulation = make_simulation(*parameters, communicator);
        return run_and_record(*simulation, parse_points(points, "Points"));
      }

      std::string points;
    };

    const Registry<Check>::Add<Ranks>
      registered("ranks", "Any number of ranks gives the same motion.");
  } // namespace
} // namespace Voussoir
