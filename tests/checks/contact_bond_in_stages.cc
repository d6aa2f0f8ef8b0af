#include <voussoir/base/text.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block on a bond that softens, in static stages: the opening of the bond
     * does not depend on the number of stages in which its load is applied, as
     * the load grows throughout, and is that of the load applied slowly.
     */
    class BondInStages : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Stages",
                          stages,
                          "Static stages of the same load, separated by "
                          "\">\".");
        prm.add_parameter("Tractions",
                          tractions,
                          "Of the whole load, separated by \">\" [Pa].");
        prm.add_parameter("Openings",
                          openings,
                          "Largest opening for each [mm].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto loads = split_list(tractions, '>'),
                   found = split_list(openings, '>');
        for (unsigned int i = 0; i < loads.size(); ++i)
          for (const std::string &which : split_list(stages, '>'))
            {
              const double traction = std::stod(loads[i]);
              const auto   whole    = [&](const std::string &load,
                                     const double       share) {
                return "Loads/" + load +
                       "/Traction=" + std::to_string(share * traction) +
                       ", 0, 0";
              };
              const auto parameters =
                make_case(file.with({whole("push", 1.),
                                     whole("half", 0.5),
                                     whole("other half", 0.5),
                                     "Static state/Stages=" + which}));
              const auto simulation =
                make_simulation(*parameters, communicator);
              double opening = 0.;
              for (const ContactPoint &point :
                   simulation->run.contact->points())
                opening = std::max(opening, point.gap[0]);
              opening = 1e3 * Utilities::MPI::max(opening, communicator);
              const std::string name =
                loads[i] + " Pa, " + which + ": largest opening [mm]";
              const double reference = std::stod(found.at(i));
              if (reference > 0.)
                verdicts.near(name, opening, reference, 0.01);
              else
                verdicts.below(name, opening, 1e-6);
            }
      }

    private:
      std::string stages, tractions, openings;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<BondInStages>
      registered("contact bond in stages",
                 "A bond that softens under a load in one stage and in two.");
  } // namespace
} // namespace Voussoir
