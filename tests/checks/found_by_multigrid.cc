#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The static stages of a case are found, by multigrid unless any method is
     * allowed, and the reactions equal the loads.
     */
    class FoundByMultigrid : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("By any method",
                          by_any_method,
                          "Not by multigrid only.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        for (const auto &stage : simulation->static_state.summary.at("stages"))
          {
            if (!by_any_method)
              verdicts.is_true(stage.at("names").dump() + " found by multigrid",
                               stage.at("found by multigrid").get<bool>());
            double loads = 0., missing = 0.;
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double load     = stage.at("sum of loads so far [N]")[d],
                             reaction = stage.at("sum of reactions [N]")[d];
                keep_largest(loads, std::abs(load));
                keep_largest(missing, std::abs(load + reaction));
              }
            verdicts.above("  largest component of the loads [N]", loads, 1.);
            verdicts.below("  reactions off the loads, over them",
                           missing / loads,
                           1e-6);
          }
      }

    private:
      bool by_any_method = false;
    };

    // Reference: closed form
    const Registry<Check>::Add<FoundByMultigrid>
      registered("found by multigrid", "Static stages.");
  } // namespace
} // namespace Voussoir
