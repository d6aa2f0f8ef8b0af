#include <voussoir/output/stress_points.h>

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
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of the motion, over the largest.");
        prm.add_parameter(
          "Stress tolerance",
          stress_tolerance,
          "Tolerance of the largest principal stress in the centre of "
          "any cell at the end [Pa]; 0: not compared.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto alone = evaluate(file, "p4est", MPI_COMM_SELF);
        for (const std::string partition : {"p4est", "METIS"})
          {
            verdicts.above("largest displacement [mm]",
                           1e3 * alone.motion.largest(),
                           0.1);
            const Result together = evaluate(file, partition, communicator);
            verdicts.below("difference to one rank, by " + partition,
                           relative_difference(together.motion, alone.motion),
                           tolerance);
            if (stress_tolerance > 0.)
              {
                double largest = 0., difference = 0.;
                for (const auto &[cell, stress] : alone.stress)
                  keep_largest(largest, stress);
                for (const auto &[cell, stress] : together.stress)
                  keep_largest(difference,
                               std::abs(stress - alone.stress.at(cell)));
                verdicts.above("largest principal stress [MPa]",
                               1e-6 * largest,
                               0.1);
                verdicts.below("difference of stresses [Pa], by " + partition,
                               Utilities::MPI::max(difference, communicator),
                               stress_tolerance);
              }
          }
      }

    private:
      struct Result
      {
        Histories                       motion;
        std::map<std::uint64_t, double> stress; // of own cells [Pa]
      };

      Result
      evaluate(const ParameterFile &file,
               const std::string   &partition,
               const MPI_Comm       communicator) const
      {
        // the stable step differs in the last digits, so a step is given
        const auto parameters =
          make_case(file.with({"Mesh/Partition=" + partition}));
        const auto simulation = make_simulation(*parameters, communicator);
        Result     result{run_and_record(*simulation,
                                     parse_points(points, "Points")),
                      {}};

        std::vector<StressPoints::Place> places;
        for (const auto &cell : simulation->model.solid.discretization
                                  .dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            places.push_back({cell, Point<3>(0.5, 0.5, 0.5)});
        StressPoints centres(simulation->run.observed, places);
        const auto  &stress = centres.evaluate(simulation->run.state);
        for (unsigned int i = 0; i < places.size(); ++i)
          result.stress[Grid::global_key(places[i].cell)] =
            eigenvalues(stress[i])[0];
        return result;
      }

      std::string points;
      double      tolerance = 1e-9, stress_tolerance = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Ranks>
      registered("ranks", "Any number of ranks gives the same motion.");
  } // namespace
} // namespace Voussoir
