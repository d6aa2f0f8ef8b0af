#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A case with one entry after another changed: each mistake gives one or
     *  several warnings in the log. */
    class Warnings : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Mistakes",
                          mistakes,
                          "Separated by |, each \"Section/Entry=value\", or "
                          "more than one, separated by &.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        verdicts.is_true("as it is: no warning",
                         n_warnings(file, communicator) == 0);
        for (const std::string &mistake : split_list(mistakes, '|'))
          verdicts.is_true(mistake + ": warned",
                           n_warnings(file.with(split_list(mistake, '&')),
                                      communicator) > 0);
      }

    private:
      static std::size_t
      n_warnings(const ParameterFile &file, const MPI_Comm communicator)
      {
        const auto parameters = make_case(file);
        RunOptions options;
        options.quiet     = true;
        options.no_output = true;
        options.validate  = true;
        const Simulation simulation(*parameters, options, communicator);
        const auto      &said = simulation.log.warnings();
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          for (const std::string &warning : said)
            std::cout << "Warning: " << warning << std::endl;
        return said.size();
      }

      std::string mistakes;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Warnings>
      registered("warnings", "Values outside their usual range are warned of.");
  } // namespace
} // namespace Voussoir
