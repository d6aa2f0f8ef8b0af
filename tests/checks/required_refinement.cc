#include <voussoir/driver/verdict_tables.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Cells too long for the fracture energy of their concrete: the refinement
     *  that the numerical check requires is sufficient, one level less is not,
     *  and the number of cells is as reported. */
    class RequiredRefinement : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const Found given = evaluate(file, communicator);
        verdicts.is_true("cells as given: not met",
                         given.line.at("met") == false);
        const std::string remedy = given.line.at("remedy");
        verdicts.is_true("a remedy for some of the cells",
                         remedy.find("Refine where") != remedy.npos);
        const std::string wanted  = "Local refinement = dam: ";
        const int         levels  = std::stoi(after(remedy, wanted));
        const auto        refined = [&](const int by) {
          return evaluate(file.with({"Mesh/Local refinement=dam: " +
                                     std::to_string(by)}),
                          communicator);
        };
        verdicts.is_true("one level less than required: not met",
                         refined(levels - 1).line.at("met") == false);
        const Found better = refined(levels);
        verdicts.is_true("required levels: met",
                         better.line.at("met") == true &&
                           !better.line.contains("remedy"));
        // beside them, cells of the rock are refined on the way to large ones
        verdicts.below("number of cells: error",
                       std::stod(after(remedy, "with about ")) /
                           (better.n_cells / given.n_cells) -
                         1.,
                       0.1);
      }

    private:
      struct Found
      {
        nlohmann::json line;
        double         n_cells;
      };

      static Found
      evaluate(const ParameterFile &file, const MPI_Comm communicator)
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        return {numerical_checks(simulation->run)
                  .at("strength lowered by long cells [%]"),
                double(simulation->model.grid.triangulation()
                         .n_global_active_cells())};
      }

      static std::string
      after(const std::string &text, const std::string &words)
      {
        return text.substr(text.find(words) + words.size());
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<RequiredRefinement>
      registered("required refinement",
                 "Cells whose length the fracture energy allows.");
  } // namespace
} // namespace Voussoir
