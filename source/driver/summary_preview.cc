#include <voussoir/analysis/measured_shapes.h>
#include <voussoir/analysis/static_outline.h>
#include <voussoir/driver/summary_preview.h>
#include <voussoir/driver/verdict_tables.h>

#include <unistd.h>

#include <filesystem>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    nlohmann::json
    outline_of(const Model &model)
    {
      StaticState found(model);
      return outline_of_static_state({model.solid,
                                      model.parameters.boundaries,
                                      model.terms,
                                      found.contact ? &*found.contact :
                                                      nullptr},
                                     model.parameters.static_state,
                                     model.load_list());
    }


    /** The summary of a run, as far as it is known at the beginning. */
    nlohmann::json
    preview(Run &run)
    {
      const MPI_Comm communicator = run.log.communicator();
      ObservedRun    observed     = run.observed;
      const auto     name =
        fs::temp_directory_path() /
        ("voussoir-preview-" +
         std::to_string(Utilities::MPI::broadcast(communicator, getpid())));
      observed.folder = name.string();
      std::error_code ignored; // the folder may be shared by the ranks or not
      fs::create_directories(name, ignored);
      MPI_Barrier(communicator);
      RunSummary summary = summary_of(run);
      if (!run.model.parameters.static_state.stage_names().empty())
        summary.march->static_state = outline_of(run.model);
      if (const unsigned int n = run.model.parameters.modes.number; n > 0)
        {
          Modes modes;
          modes.list.resize(n);
          for (const MeasuredShape &shape :
               measured_shapes(run.model.parameters.modes))
            modes.measured_shapes[shape.name] = nearest_mode(1, 0., 0.);
          summary.march->modes = modes.summary();
        }
      for (const auto &observer : run.setup->plan.observers)
        {
          observer.second->begin(observed);
          observer.second->observe(run.state);
          observer.second->finish(run.state, summary.observers);
        }
      run.log.write_growing_files();
      MPI_Barrier(communicator);
      fs::remove_all(name, ignored);
      summary.checks = numerical_checks(run);
      summary.judge(run.model.parameters.acceptance);
      return summary;
    }
  } // namespace


  void
  check_summary_paths(Run &run)
  {
    const Case &parameters = run.model.parameters;

    NamedNumbers wanted = parameters.study.named_numbers();
    for (const AcceptanceCriterion &criterion :
         parameters.acceptance.of_the_run())
      wanted.emplace_back(SummaryNumber(criterion.quantity),
                          "\"Quantity\" in section \"Acceptance/" +
                            criterion.name + "\"");
    if (!wanted.empty())
      check_numbers(wanted, preview(run));
  }
} // namespace Voussoir
