#include <voussoir/base/mpi.h>
#include <voussoir/fem/point_weights.h>

#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A body cut along interfaces that stay closed moves as the uncut body; the
     * ranks together find the same motion as one, also where it opens and
     * slips.
     */
    class Bonded : public Check
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
        const auto same_law = [&](const std::vector<std::string> &entries) {
          std::vector<std::string> changes;
          for (const auto &name : split_list(file.given("Interfaces/Names")))
            for (const std::string &entry : entries)
              changes.push_back("Interfaces/" + name + "/" + entry);
          return file.with(changes);
        };
        const auto strong = same_law(
          {"Law=brittle bond", "Tensile strength=1e12", "Cohesion=1e12"});
        const auto whole = history(file, communicator, false);
        compare(verdicts,
                "bonded against uncut",
                history(strong, communicator),
                whole);
        const auto alone = history(file, MPI_COMM_SELF);
        for (const std::string partition : {"p4est", "METIS"})
          compare(verdicts,
                  partition + " against one rank",
                  history(file.with({"Mesh/Partition=" + partition}),
                          communicator),
                  alone);
        double way = 0., size = 0.;
        for (unsigned int i = 0; i < alone.size(); ++i)
          {
            way  = std::max(way, std::abs(alone[i] - whole[i]));
            size = std::max(size, std::abs(whole[i]));
          }
        verdicts.above("change of the motion by slip and opening [%]",
                       100. * way / size,
                       1.);
        verdicts.below("penetration over cell size",
                       Utilities::MPI::max(penetration, communicator),
                       1e-10);
      }

    private:
      std::vector<double>
      history(const ParameterFile &file,
              const MPI_Comm       communicator,
              const bool           cut = true)
      {
        const auto parameters = make_case(file);
        if (!cut)
          parameters->interfaces.list.clear();
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
        if (simulation->contact)
          penetration = std::max(penetration,
                                 simulation->contact->effort().penetration /
                                   simulation->contact->cell_size);
        return sum_over_ranks(values, communicator);
      }

      static void
      compare(Verdicts                  &verdicts,
              const std::string         &name,
              const std::vector<double> &values,
              const std::vector<double> &reference)
      {
        double difference = 0., size = 0.;
        for (unsigned int i = 0; i < reference.size(); ++i)
          {
            size = std::max(size, std::abs(reference[i]));
            difference =
              std::max(difference, std::abs(values[i] - reference[i]));
          }
        verdicts.below(name + ": difference over size",
                       difference / size,
                       1e-9);
      }

      std::string points;
      double      penetration = 0.;
    };

    const Registry<Check>::Add<Bonded>
      registered("contact bonded", "Bonded against uncut, ranks against one.");
  } // namespace
} // namespace Voussoir
