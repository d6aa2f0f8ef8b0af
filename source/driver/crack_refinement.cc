#include <voussoir/base/json_entries.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/simulation.h>
#include <voussoir/driver/summary_numbers.h>
#include <voussoir/files/hdf5_file.h>
#include <voussoir/files/tension_file.h>
#include <voussoir/output/checkpoint.h>

#include <filesystem>
#include <fstream>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const std::string demand_entry =
      "\"Demand of\" in section \"Mesh/Refine where\"";

    /** The box around a mesh, beside that of the run. */
    void
    check_box(const Case        &parameters,
              const TensionFile &tension,
              const CoarseMesh  &mesh)
    {
      std::vector<Point<3>> corners;
      for (const auto &cell : mesh.cells)
        for (const unsigned int v : cell)
          corners.push_back(mesh.vertices[v]);
      const auto [lower, upper] = BoundingBox<3>(corners).get_boundary_points();
      const double same         = 0.01 * lower.distance(upper);
      if (lower.distance(tension.lower) < same &&
          upper.distance(tension.upper) < same)
        return;
      std::ostringstream text;
      text << demand_entry << " is \"" << parameters.grid.refine_where.demand_of
           << "\", a run of another model, which reaches from ("
           << tension.lower << ") to (" << tension.upper << ") m, not from ("
           << lower << ") to (" << upper << ") m; name a run of this model.";
      throw UserError(text.str());
    }


    TensionFile
    tension_of_run(const Case &parameters)
    {
      const std::string file = tension_file(demand_folder(parameters));
      try
        {
          return read_tension(file);
        }
      catch (const FileProblem &problem)
        {
          throw UserError(demand_entry + ": \"" + file + "\" cannot be read: " +
                          problem.what + "; repeat that run.");
        }
    }


    bool
    is_there(const std::string &file)
    {
      std::error_code none;
      return fs::exists(file, none);
    }
  } // namespace


  void
  check_refinement(const Case &parameters)
  {
    const RefineWhereParameters &where = parameters.grid.refine_where;
    if (!where.wanted())
      return;
    where.place();
    const auto edges = crack_edges(parameters);
    if (std::all_of(edges.begin(), edges.end(), [](const double edge) {
          return std::isinf(edge);
        }))
      throw UserError(
        "Section \"Mesh/Refine where\" takes the length of cells from tensile "
        "strength and fracture energy, which no material of the case has; "
        "choose for example \"Class = concrete damage\" in section "
        "\"Materials\", or refine by \"Local refinement\" in section "
        "\"Mesh\".");
    if (!where.demand_of.empty() && !where.wants_linear_run() &&
        !is_there(tension_file(where.demand_of)))
      throw UserError(demand_entry + " is \"" + where.demand_of +
                      "\", where no run has left the file \"" +
                      fs::path(tension_file("")).filename().string() +
                      "\"; name the output folder of a run with the observer "
                      "\"envelopes\", or \"linear run\".");
  }


  std::string
  demand_folder(const Case &parameters)
  {
    const RefineWhereParameters &where = parameters.grid.refine_where;
    return where.wants_linear_run() ? name_of_results(parameters) + "-linear" :
                                      where.demand_of;
  }


  std::vector<double>
  crack_edges(const Case &parameters)
  {
    std::vector<double> edges;
    for (const Material *material : parameters.material_list())
      {
        const double length =
          std::min(material->tensile_failure().crack_length,
                   material->at_rest().tensile_failure().crack_length);
        edges.push_back(length > 0. ?
                          parameters.grid.refine_where.share * length :
                          std::numeric_limits<double>::infinity());
      }
    return edges;
  }


  std::shared_ptr<const CellsAndRing>
  stressed_cells(const Case &parameters, const CoarseMesh &mesh)
  {
    const RefineWhereParameters &where = parameters.grid.refine_where;
    if (where.demand_of.empty())
      return nullptr;
    const TensionFile tension = tension_of_run(parameters);
    check_box(parameters, tension, mesh);
    const auto          known = parameters.material_names();
    const auto          edges = crack_edges(parameters);
    std::vector<double> limits; // of the materials of that run
    for (const std::string &name : tension.materials)
      {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end())
          throw UserError(demand_entry + " is \"" + where.demand_of +
                          "\", a run with a material \"" + name +
                          "\", which this case does not have" +
                          known_names(name, known) +
                          "; name a run of this model.");
        limits.push_back(std::isinf(edges[found - known.begin()]) ?
                           std::numeric_limits<double>::max() :
                           where.threshold *
                             parameters.materials.objects[found - known.begin()]
                               .second->at_rest()
                               .tensile_failure()
                               .strength);
      }
    std::vector<CellFrame> cells;
    for (const CellTension &cell : tension.cells)
      if (cell.stress > limits.at(cell.material))
        cells.push_back(cell.frame);
    return std::make_shared<const CellsAndRing>(cells);
  }


  namespace
  {
    /** Which cells are refined. */
    std::string
    chosen_cells(const Case &parameters)
    {
      const RefineWhereParameters &where = parameters.grid.refine_where;
      std::vector<std::string>     conditions;
      if (!where.demand_of.empty())
        conditions.push_back("tension above " + number_text(where.threshold) +
                             " of the strength in \"" +
                             demand_folder(parameters) +
                             "\", and the ring around them");
      if (!where.cell_sets.empty())
        conditions.push_back("of the sets " + where.cell_sets);
      if (!where.expression.empty())
        conditions.push_back(where.expression);
      return "cells with " + join(conditions, ", and ");
    }
  } // namespace


  nlohmann::json
  summary_of_refinement(const Case              &parameters,
                        const RefinementSummary &summary)
  {
    if (summary.before == 0)
      return {};
    nlohmann::json lengths;
    const auto     edges = crack_edges(parameters);
    for (unsigned int m = 0; m < edges.size(); ++m)
      if (!std::isinf(edges[m]))
        lengths[parameters.materials.objects[m].first] = edges[m];
    nlohmann::json result{{"chosen", chosen_cells(parameters)},
                          {"longest edge asked for [m]", lengths},
                          {"cells before", summary.before},
                          {"cells chosen", summary.chosen},
                          {"cells after", summary.after}};
    if (summary.chosen > 0)
      result.update({{"chosen from [m]", to_json(summary.lower)},
                     {"chosen to [m]", to_json(summary.upper)},
                     {"cells in their place", summary.fine},
                     {"longest edge there [m]", summary.longest},
                     {"cells that stay longer", summary.too_long}});
    return result;
  }


  std::string
  describe_refinement(const Case &parameters, const RefinementSummary &summary)
  {
    if (!parameters.grid.refine_where.wanted())
      return "";
    if (summary.before == 0)
      return "the linear run that chooses the cells has not been made yet";
    std::ostringstream text;
    text << summary.chosen << " of " << summary.before << " cells are chosen, "
         << chosen_cells(parameters);
    if (summary.chosen == 0)
      return text.str();
    text << ", from (" << summary.lower << ") to (" << summary.upper
         << ") m; in their place are " << summary.fine
         << " cells with edges of up to " << number_text(summary.longest, 3)
         << " m, " << summary.too_long << " of them longer than asked for";
    const auto edges = crack_edges(parameters);
    for (unsigned int m = 0; m < edges.size(); ++m)
      if (!std::isinf(edges[m]))
        text << ", " << number_text(edges[m], 3) << " m in \""
             << parameters.materials.objects[m].first << '"';
    text << "; the mesh has " << summary.after << " cells";
    return text.str();
  }


  namespace
  {
    ParameterFile
    file_of_linear_run(const Case &parameters)
    {
      std::vector<std::string> sets;
      std::vector<std::string> changes{"Title=Linear run of: " +
                                         (parameters.title.empty() ?
                                            parameters.file.name() :
                                            parameters.title),
                                       "Mesh/Refine where/Demand of=",
                                       "Mesh/Refine where/Cell sets=",
                                       "Mesh/Refine where/Expression=",
                                       "Acceptance/Names=",
                                       "Output/Observers=envelopes",
                                       "Output/Observers for the verdict=false",
                                       "Output/envelopes/Stress=true",
                                       "Output/Folder=" +
                                         demand_folder(parameters)};
      const auto               edges = crack_edges(parameters);
      for (unsigned int m = 0; m < edges.size(); ++m)
        {
          const auto &[name, material] = parameters.materials.objects[m];
          if (!std::isinf(edges[m]))
            sets.push_back(material->cell_sets);
          if (material->n_history() > 0)
            changes.push_back("Materials/" + name + "/Class=linear elastic");
        }
      changes.push_back("Output/envelopes/Stress in=" + join(sets, ", "));
      return parameters.file.with(changes);
    }


    /** File with the entries of a linear run that has ended. */
    std::string
    record_of(const Case &linear)
    {
      return linear.output.folder + "/linear_run.json";
    }


    nlohmann::json
    record_for(const Case &linear)
    {
      return {{"identity", identity_of(linear)},
              {"end time [s]", linear.time.end_time}};
    }


    /** Whether this linear run has ended; @p extended: a longer run may go on
     *  with it. */
    bool
    is_made(const Case    &linear,
            const bool     extended,
            const MPI_Comm communicator)
    {
      bool found = false;
      if (Utilities::MPI::this_mpi_process(communicator) == 0 &&
          is_there(tension_file(linear.output.folder)))
        {
          std::ifstream in(record_of(linear));
          const auto    record = nlohmann::json::parse(in, nullptr, false);
          found                = record.is_object() &&
                  (extended ? record.at("identity") == identity_of(linear) :
                              record == record_for(linear));
        }
      return Utilities::MPI::broadcast(communicator, found);
    }
  } // namespace


  bool
  awaits_linear_run(const Case &parameters, const MPI_Comm communicator)
  {
    return parameters.grid.refine_where.wants_linear_run() &&
           !is_made(Case(file_of_linear_run(parameters)), true, communicator);
  }


  RunOptions
  after_linear_run(const Case       &parameters,
                   const RunOptions &options,
                   const MPI_Comm    communicator)
  {
    if (!parameters.grid.refine_where.wants_linear_run() || options.validate ||
        options.no_output)
      return options;
    const Case linear(file_of_linear_run(parameters));
    if ((options.restart || !options.overwrite) &&
        is_made(linear, options.restart, communicator))
      return options;

    RunOptions               of_linear_run = options;
    std::vector<std::string> damaged;
    of_linear_run.restart =
      options.restart &&
      !Checkpoint(linear.output.folder + "/checkpoint", communicator)
         .newest(damaged)
         .empty();
    of_linear_run.overwrite = !of_linear_run.restart;
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    if (first)
      fs::remove(record_of(linear));
    Simulation(linear, of_linear_run, communicator).run.march();
    if (first)
      write_file(record_of(linear), record_for(linear).dump(2) + '\n');
    MPI_Barrier(communicator);
    RunOptions of_run = options;
    of_run.restart    = false;
    return of_run;
  }
} // namespace Voussoir
