// Runs the test that a parameter file names in its section "Check":
//   voussoir_check test.prm
// Exit code 1: something is WRONG, or an error.

#include <voussoir/base/parallel_session.h>
#include <voussoir/driver/command_line.h>

#include <iomanip>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  Verdicts::Verdicts(const MPI_Comm communicator)
    : communicator(communicator)
    , speaks(Utilities::MPI::this_mpi_process(communicator) == 0)
  {}


  void
  Verdicts::near(const std::string &name,
                 const double       value,
                 const double       reference,
                 const double       tolerance,
                 const std::string &unit)
  {
    std::ostringstream text;
    text << name << " = " << std::setprecision(4) << value
         << (unit.empty() ? "" : " " + unit) << "  (reference " << reference
         << ", allowed " << 100. * tolerance << " %)";
    print(text.str(),
          std::abs(value - reference) <= tolerance * std::abs(reference));
  }


  void
  Verdicts::below(const std::string &name,
                  const double       value,
                  const double       limit)
  {
    std::ostringstream text;
    text << name << " below " << limit;
    const bool good = std::abs(value) <= limit;
    if (!good)
      text << ": it is " << value;
    print(text.str(), good);
  }


  void
  Verdicts::above(const std::string &name,
                  const double       value,
                  const double       limit)
  {
    std::ostringstream text;
    text << name << " at least " << limit;
    const bool good = value >= limit;
    if (!good)
      text << ": it is " << value;
    print(text.str(), good);
  }


  void
  Verdicts::is_true(const std::string &name, const bool value)
  {
    print(name, value);
  }


  void
  Verdicts::same_text(const std::string &name,
                      const std::string &text,
                      const std::string &expected)
  {
    const bool good = text == expected;
    print(name + ": " + text + (good ? "" : " (must be: " + expected + ')'),
          good);
  }


  void
  Verdicts::heading(const std::string &text)
  {
    if (speaks)
      std::cout << text << std::endl;
  }


  bool
  Verdicts::any_wrong() const
  {
    // results of the other ranks may be NaN
    return Utilities::MPI::logical_or(speaks && !all_good, communicator);
  }


  void
  Verdicts::print(const std::string &text, const bool good)
  {
    all_good = all_good && good;
    if (speaks)
      std::cout << text << "  " << (good ? "ok" : "WRONG") << std::endl;
  }


  double
  largest_entry(const Vector &vector)
  {
    double largest = 0., sum = 0.;
    for (const double entry : vector)
      {
        largest = std::max(largest, std::abs(entry));
        sum += entry;
      }
    const MPI_Comm communicator = vector.get_mpi_communicator();
    largest                     = Utilities::MPI::max(largest, communicator);
    sum                         = Utilities::MPI::sum(sum, communicator);
    return std::isnan(sum) ? sum : largest;
  }


  namespace
  {
    std::unique_ptr<Check>
    make_check(const ParameterFile &file)
    {
      return Registry<Check>::create(file.given("Check/Name"),
                                     "\"Name\" in section \"Check\"");
    }

    void
    declare_check(const ParameterFile &file,
                  Check               &check,
                  ParameterHandler    &prm)
    {
      prm.enter_subsection("Check");
      prm.declare_entry("Name", file.given("Check/Name"));
      check.declare_parameters(prm);
      prm.leave_subsection();
    }
  } // namespace


  std::unique_ptr<Case>
  make_case(const ParameterFile &file)
  {
    const auto ignored = make_check(file);
    return std::make_unique<Case>(file, [&](ParameterHandler &prm) {
      declare_check(file, *ignored, prm);
    });
  }


  std::unique_ptr<Simulation>
  make_simulation(const Case &parameters, const MPI_Comm communicator)
  {
    RunOptions options;
    options.quiet     = true;
    options.no_output = true;
    return std::make_unique<Simulation>(parameters, options, communicator);
  }
} // namespace Voussoir


int
main(int argc, char **argv)
{
  using namespace Voussoir;
  const ParallelSession session(argc, argv);
  bool                  any_wrong = false;
  const int             code      = guarded(
    [&] {
      const ParameterFile file(argv[1]);
      const auto          check = make_check(file);
      // the check reads its own entries when the case is parsed
      const Case parsed(file, [&](dealii::ParameterHandler &prm) {
        declare_check(file, *check, prm);
      });
      Verdicts   verdicts(MPI_COMM_WORLD);
      check->run(file, verdicts, MPI_COMM_WORLD);
      any_wrong = verdicts.any_wrong();
    },
    MPI_COMM_WORLD);
  return any_wrong ? 1 : code;
}
