#include <voussoir/base/first_rank.h>
#include <voussoir/base/machine.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/mesh_against_case.h>
#include <voussoir/driver/model.h>
#include <voussoir/driver/model_checks.h>
#include <voussoir/grid/curve_partition.h>
#include <voussoir/loads/added_mass.h>
#include <voussoir/loads/water_level.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/reservoir_mesh.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    bool
    wants_water(const Case &parameters)
    {
      const ReservoirParameters &reservoir = parameters.reservoir;
      return reservoir.model == ReservoirModel::compressible ||
             parameters.modes.want_cells_of_water(reservoir);
    }


    // Takes the water out of a mesh into a mesh of its own, whether or not the
    // case uses it.
    CoarseMesh
    take_water(const Case &parameters, CoarseMesh &mesh)
    {
      const ReservoirParameters &reservoir = parameters.reservoir;
      const bool                 wanted    = wants_water(parameters);
      std::vector<std::string>   sets;
      for (const std::string &set : split_list(reservoir.cell_sets))
        if (wanted || mesh.cell_sets.count(set) > 0)
          sets.push_back(set);
      if (sets.empty())
        return {};
      std::vector<std::string> open_faces = split_list(reservoir.surface);
      for (const std::string &set : split_list(reservoir.end))
        open_faces.push_back(set);
      return split_off_reservoir(mesh,
                                 sets,
                                 "\"Cell sets\" in section \"Reservoir\"",
                                 open_faces);
    }


    std::vector<Support>
    checked_supports(const Case &parameters, const Grid &grid)
    {
      parameters.boundaries.check(grid);
      return parameters.boundaries.supports.list();
    }


    // Faces at whose nodes a step has more to do than the mass and the cells.
    std::map<std::string, double>
    costs_of_faces(const Case &parameters, const InterfaceSurfaces &surfaces)
    {
      const double cost = parameters.discretization.relative_cost_of_face();
      std::map<std::string, double> result;
      for (const std::string &set :
           split_list(parameters.boundaries.absorbing.face_sets))
        result[set] = cost;
      for (const std::string &set : surfaces.names())
        result[set] = result[set + other_side] = cost;
      return result;
    }


    Grid::Materials
    materials_of_grid(const Case                         &parameters,
                      const InterfaceSurfaces            &surfaces,
                      std::vector<unsigned int>           of_cell,
                      std::shared_ptr<const CellsAndRing> stressed)
    {
      Grid::Materials result{std::move(of_cell),
                             {},
                             {},
                             crack_edges(parameters),
                             std::move(stressed),
                             costs_of_faces(parameters, surfaces)};
      for (const Material *material : parameters.material_list())
        {
          result.costs.push_back(
            material->relative_cost() *
            parameters.discretization.relative_cost(material->n_history() > 0));
          result.longest_edges.push_back(parameters.grid.longest_edge(
            material->elastic_constants().s_wave_speed(),
            parameters.discretization.degree));
        }
      return result;
    }


    // Gives the other ranks the names of the first one's sets, and their faces.
    void
    share_sets(CoarseMesh &mesh, const MPI_Comm communicator)
    {
      using Utilities::MPI::broadcast;
      std::vector<std::string>                           names;
      std::vector<std::pair<unsigned int, unsigned int>> faces;
      for (const auto &set : mesh.cell_sets)
        names.push_back(set.first);
      for (const std::string &name : broadcast(communicator, names))
        mesh.cell_sets[name];
      names.clear();
      for (const auto &set : mesh.face_sets)
        names.push_back(set.first);
      for (const std::string &name : broadcast(communicator, names))
        {
          auto &set = mesh.face_sets[name];
          faces.clear();
          for (const auto &[cell, face] : set)
            faces.emplace_back(cell, face);
          set.clear();
          for (const auto &[cell, face] : broadcast(communicator, faces))
            set.push_back({cell, face});
        }
    }


    // Makes a grid of the mesh and frees the mesh.
    Grid
    make_grid(const GridParameters  &parameters,
              CoarseMesh           &&mesh,
              const Grid::Materials &materials,
              const MPI_Comm         communicator)
    {
      const CoarseMesh   coarse = std::move(mesh);
      Grid               grid(coarse, parameters, materials, communicator);
      const auto         n_cells = grid.triangulation().n_global_active_cells();
      const unsigned int n_ranks =
        Utilities::MPI::n_mpi_processes(communicator);
      if (n_cells < n_ranks)
        throw UserError("The mesh has " + counted(n_cells, "cell", "cells") +
                        ", fewer than the " + std::to_string(n_ranks) +
                        " ranks; take fewer ranks, or smaller cells.");
      return grid;
    }


    using Loads =
      std::vector<std::pair<std::string, std::unique_ptr<const Load>>>;


    Loads
    prepared_loads(const Case &parameters, const Solid &solid, Log &log)
    {
      Loads list;
      for (auto &[name, load] : parameters.loads.make(parameters.file))
        {
          load->prepare(solid, parameters.file, "Loads/" + name, log);
          list.emplace_back(name, std::move(load));
        }
      return list;
    }


    AddedMass
    make_added_mass(const Discretization      &discretization,
                    const ReservoirParameters &water,
                    Log                       &log)
    {
      return water.model == ReservoirModel::added_mass ?
               westergaard_mass(discretization,
                                water.added_mass,
                                water.density,
                                log) :
               AddedMass();
    }


    std::shared_ptr<const Reservoir>
    make_reservoir(const Case           &parameters,
                   const CoarseMesh     &water_mesh,
                   const Discretization &discretization,
                   Log                  &log)
    {
      if (parameters.reservoir.model != ReservoirModel::compressible)
        return nullptr;
      return std::make_shared<const Reservoir>(
        water_mesh, parameters.grid, parameters.reservoir, discretization, log);
    }


    // Water for the natural modes alone, without contact with the solid in the
    // run.
    std::shared_ptr<const Reservoir>
    make_reservoir_of_modes(const Case                             &parameters,
                            const CoarseMesh                       &water_mesh,
                            const Discretization                   &solid,
                            const std::shared_ptr<const Reservoir> &of_the_run,
                            Log                                    &log)
    {
      if (!parameters.modes.want_cells_of_water(parameters.reservoir))
        return nullptr;
      if (of_the_run)
        return of_the_run;
      return std::make_shared<const Reservoir>(
        water_mesh, parameters.grid, parameters.reservoir, solid, log);
    }


    NodalTerms
    assembled_terms(const Solid             &solid,
                    const AbsorbingBoundary &boundary,
                    const Loads             &loads,
                    const AddedMass         &added_mass,
                    const Reservoir         *reservoir)
    {
      NodalTerms terms(solid.discretization.n_owned_nodes());
      terms.add(boundary.terms());
      for (const auto &load : loads)
        terms.add_nodes(load.second->nodes());
      terms.add(added_mass.terms);
      if (reservoir != nullptr)
        terms.add_nodes(reservoir->wet_nodes());
      return terms;
    }


    std::unique_ptr<const Contact>
    make_contact(const Solid                &solid,
                 const InterfacesParameters &interfaces,
                 const InterfaceSurfaces    &surfaces,
                 Log                        &log)
    {
      const Discretization &discretization = solid.discretization;
      if (interfaces.list.empty())
        return nullptr;
      for (const InterfaceParameters &interface : interfaces.list)
        if (interface.uplift.given())
          {
            const std::string section =
              " in section \"Interfaces/" + interface.name + "/Uplift\"";
            check_level(discretization,
                        split_list(interface.uplift.upstream_faces),
                        "\"Upstream faces\"" + section,
                        interface.uplift.upstream_level,
                        "\"Upstream level\"" + section,
                        log);
          }
      auto contact =
        std::make_unique<Contact>(discretization, interfaces, surfaces);
      const double delay =
        contact->set_delay(discretization, [&](const Grid::Cell &cell) {
          return solid.material_of(cell).elastic_constants().s_wave_speed();
        });
      const double at_5_hz = 1. / std::hypot(1., 10. * numbers::PI * delay);
      log.line("Friction follows the pressure with a delay of up to ",
               1e3 * delay,
               " ms, depending on the cells at the interfaces; a change at 5 "
               "Hz acts with ",
               std::round(100. * at_5_hz),
               " %");
      contact->prepare_tips(solid);
      if (const BondTips *tips = contact->bond_tips())
        log.line("At tips of cracks along interfaces the strength of the bond "
                 "is lowered to ",
                 std::round(100. * tips->smallest_factor(
                                     contact->points_of_interfaces())),
                 " % in the longest cells");
      return contact;
    }
  } // namespace


  Model::Meshes::Meshes(const Case &parameters, Log &log)
    : grid(parameters.grid)
  {
    if (awaits_linear_run(parameters, log.communicator()))
      grid.refine_where = {};
    const RanksOfMachine machine(log.communicator());
    const bool           first_rank_suffices =
      grid.divided_along_curve() ||
      (grid.partition == Partition::metis && !parameters.generator &&
       machine.is_group());
    if (!first_rank_suffices)
      make(parameters, log);
    else
      {
        on_first_rank(machine.communicator, [&] { make(parameters, log); });
        share_sets(solid, machine.communicator);
        share_sets(water, machine.communicator);
        surfaces.of_interface =
          Utilities::MPI::broadcast(machine.communicator,
                                    surfaces.of_interface);
      }
  }


  void
  Model::Meshes::make(const Case &parameters, Log &log)
  {
    std::ostringstream report;
    solid = parameters.make_mesh(report);
    order_along_curve(solid); // its cells keep these numbers in checkpoints
    log(report.str());
    // before, cells of water would hold the sides of an interface together
    water     = take_water(parameters, solid);
    surfaces  = parameters.interfaces.split(solid);
    materials = parameters.material_of_coarse_cells(solid);
    check_parts(parameters, solid, surfaces, log);
    report_sets_on_interfaces(parameters, solid, surfaces, log);
    check_mesh_against_case(parameters, solid, surfaces, materials, log);
    if (grid.refine_where.wanted())
      stressed = stressed_cells(parameters, solid);
  }


  Model::Model(const Case &parameters, Log &log)
    : Model(parameters, Meshes(parameters, log), log)
  {}


  Model::Model(const Case &parameters, Meshes &&meshes, Log &log)
    : parameters(parameters)
    , grid(make_grid(meshes.grid,
                     std::move(meshes.solid),
                     materials_of_grid(parameters,
                                       meshes.surfaces,
                                       std::move(meshes.materials),
                                       std::move(meshes.stressed)),
                     log.communicator()))
    , solid(grid,
            parameters.discretization,
            checked_supports(parameters, grid),
            parameters.material_list())
    , boundary(solid,
               parameters.boundaries.absorbing,
               parameters.discretization.quadrature)
    , loads(prepared_loads(parameters, solid, log))
    , added_mass(
        make_added_mass(solid.discretization, parameters.reservoir, log))
    , reservoir(
        make_reservoir(parameters, meshes.water, solid.discretization, log))
    , reservoir_of_modes(make_reservoir_of_modes(parameters,
                                                 meshes.water,
                                                 solid.discretization,
                                                 reservoir,
                                                 log))
    , terms(
        assembled_terms(solid, boundary, loads, added_mass, reservoir.get()))
    , contact(make_contact(solid, parameters.interfaces, meshes.surfaces, log))
  {
    for (const std::string &warning : parameters.warnings)
      log.warn(warning);
    for (const std::string &note : parameters.notes)
      log.line("note: ", note);
    check_levels(parameters, reservoir.get(), log);
    report(log);
  }


  Model::~Model() = default;


  NamedLoads
  Model::load_list() const
  {
    NamedLoads list;
    for (const auto &[name, load] : loads)
      list.emplace_back(name, load.get());
    return list;
  }


  std::vector<const Load *>
  Model::running_loads() const
  {
    std::set<std::string> staged;
    for (const auto &stage : parameters.static_state.stage_names())
      staged.insert(stage.begin(), stage.end());
    std::vector<const Load *> running;
    for (const auto &[name, load] : loads)
      if (staged.count(name) == 0)
        running.push_back(load.get());
    return running;
  }


  bool
  Model::rigid_base() const
  {
    return parameters.ground_motion.type != GroundMotionType::none &&
           parameters.wave.enters_through == WaveEntrance::rigid_base;
  }


  void
  Model::report(Log &log) const
  {
    const MPI_Comm communicator = grid.communicator();
    log.line("Mesh: ",
             grid.describe_balance(),
             ", partition ",
             grid.partition(),
             ", at most ",
             solid.discretization.largest_interface(),
             " ghost nodes of a rank");
    for (const PartitionCounts &counts : grid.partition_counts())
      log.line("Partition into ", counts.describe());
    if (const std::string refined =
          describe_refinement(parameters, grid.refinement());
        !refined.empty())
      log.line("Refined where cracks are expected: ", refined);
    if (grid.refinement().before > 0 && grid.refinement().chosen == 0)
      log.warn("\"Refine where\" in section \"Mesh\" refines nothing, as "
               "no cell is stressed so much; take a smaller \"Threshold\", or "
               "leave it out");
    log.line("Unknowns: ",
             solid.discretization.dof_handler.n_dofs(),
             " of degree ",
             solid.discretization.degree);
    report_materials(log);
    if (parameters.reservoir.model == ReservoirModel::added_mass)
      log.line("Reservoir: added mass of ",
               added_mass.mass,
               " kg for motion along the river, (",
               added_mass.river,
               ")");
    if (reservoir)
      {
        double surface = std::numeric_limits<double>::lowest();
        for (const Point<3> &node : reservoir->space.node_positions)
          surface = std::max(surface, node[2]);
        log.line("Reservoir: ",
                 reservoir->space.dof_handler.n_dofs(),
                 " unknowns of compressible water up to z = ",
                 Utilities::MPI::max(surface, communicator),
                 " m, ",
                 reservoir->space.grid.describe_balance(),
                 ", largest step ",
                 reservoir->stable_step(),
                 " s");
        if (reservoir->end && !reservoir->end->modes.frequencies.empty())
          log.line("Far reservoir: ",
                   reservoir->end->modes.frequencies.size(),
                   " modes across the channel, cut-off frequency of the first ",
                   reservoir->end->modes.frequencies[0] / (2. * numbers::PI),
                   " Hz");
      }
    check_source_point(log);
  }


  std::vector<double>
  Model::longest_edges() const
  {
    std::vector<double> longest(solid.materials.size(), 0.);
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        longest[grid.material(cell)] =
          std::max(longest[grid.material(cell)], longest_edge(cell));
    Utilities::MPI::max(longest, grid.communicator(), longest);
    return longest;
  }


  std::vector<double>
  Model::carried_frequencies() const
  {
    std::vector<double> frequencies = longest_edges();
    for (unsigned int m = 0; m < solid.materials.size(); ++m)
      if (double &value = frequencies[m]; value > 0.)
        value = solid.materials[m]->elastic_constants().s_wave_speed() *
                solid.discretization.degree / (8. * value);
    return frequencies;
  }


  double
  Model::carried_frequency() const
  {
    const std::vector<double> frequencies = carried_frequencies();
    return *std::max_element(frequencies.begin(), frequencies.end());
  }


  std::vector<double>
  Model::widest_crack_bands() const
  {
    std::vector<double> widest(solid.materials.size(), 0.);
    for (const auto &cell : grid.triangulation().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int m = grid.material(cell);
          widest[m] =
            std::max(widest[m],
                     CrackBands::along_edges(cell,
                                             solid.discretization.crack_share));
        }
    Utilities::MPI::max(widest, grid.communicator(), widest);
    return widest;
  }


} // namespace Voussoir
