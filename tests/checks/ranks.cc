#include <voussoir/base/mpi.h>
#include <voussoir/fem/point_weights.h>

#include "check.h"

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
            const auto together   = history(file, partition, communicator);
            double     difference = 0., size = 0.;
            for (unsigned int i = 0; i < alone.size(); ++i)
              {
                size = std::max(size, std::abs(alone[i]));
                difference =
                  std::max(difference, std::abs(alone[i] - together[i]));
              }
            verdicts.above("largest displacement [mm]", 1e3 * size, 0.1);
            verdicts.below("difference to one rank, by " + partition,
                           difference / size,
                           1e-9);
          }
      }

    private:
      std::vector<double>
      history(const ParameterFile &file,
              const std::string   &partition,
              const MPI_Comm       communicator) const
      {
        // the stable step differs in the last digits, so it is given
        const auto parameters =
          make_case(file.with({"Mesh/Partition=" + partition}));
        const auto simulation = make_simulation(*parameters, communicator);
        const PointWeights  weights(simulation->discretization,
                                   parse_points(points, "Points"),
                                   "Points");
        std::vector<double> values;
        while (simulation->state.time < parameters->time.end_time)
          {
            simulation->scheme.step(simulation->state);
            for (const auto &value :
                 weights.share(simulation->state.displacement))
              for (unsigned int d = 0; d < 3; ++d)
                values.push_back(value[d]);
          }
        return sum_over_ranks(values, communicator);
      }

      std::string points;
    };

    const Registry<Check>::Add<Ranks>
      registered("ranks", "Any number of ranks gives the same motion.");
  } // namespace
} // namespace Voussoir
