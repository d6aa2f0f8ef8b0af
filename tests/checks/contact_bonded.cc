#include "check.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A body cut along interfaces that stay closed moves as the uncut body; all
     * ranks together compute the same motion as one, also where interfaces open
     * and slip.
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
        verdicts.above("change of the motion by slip and opening [%]",
                       100. * relative_difference(alone, whole),
                       1.);
        verdicts.below("penetration over cell size",
                       Utilities::MPI::max(penetration, communicator),
                       1e-10);
      }

    private:
      Histories
      history(const ParameterFile &file,
              const MPI_Comm       communicator,
              const bool           cut = true)
      {
        const auto parameters = make_case(file);
        if (!cut)
          parameters->interfaces.list.clear();
        const auto      simulation = make_simulation(*parameters, communicator);
        const Histories result =
          run_and_record(*simulation, parse_points(points, "Points"));
        if (simulation->run.contact)
          keep_largest(penetration,
                       simulation->run.contact->effort().penetration /
                         simulation->run.contact->cell_size());
        return result;
      }

      static void
      compare(Verdicts          &verdicts,
              const std::string &name,
              const Histories   &histories,
              const Histories   &reference)
      {
        verdicts.below(name + ": difference over size",
                       relative_difference(histories, reference),
                       1e-9);
      }

      std::string points;
      double      penetration = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Bonded>
      registered("contact bonded", "Bonded against uncut, ranks against one.");
  } // namespace
} // namespace Voussoir
