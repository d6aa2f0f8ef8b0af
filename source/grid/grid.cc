#include <voussoir/base/error.h>
#include <voussoir/base/machine.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/text.h>
#include <voussoir/grid/chart_vertices.h>
#include <voussoir/grid/coarse_faces.h>
#include <voussoir/grid/curve_partition.h>
#include <voussoir/grid/grid.h>
#include <voussoir/mesh/mesh_check.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  double
  longest_edge(const Triangulation<3>::cell_iterator &cell)
  {
    double longest = 0.;
    // the vertices at the ends of an edge differ in one bit
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int bit = 1; bit < 8; bit *= 2)
        if ((v & bit) == 0)
          longest =
            std::max(longest, cell->vertex(v).distance(cell->vertex(v | bit)));
    return longest;
  }


  namespace
  {
    template <typename Visit>
    void
    for_each_face_with_cost(const CoarseMesh      &coarse,
                            const Grid::Materials &materials,
                            const Visit           &visit)
    {
      for (const auto &[name, cost] : materials.face_costs)
        if (const auto set = coarse.face_sets.find(name);
            set != coarse.face_sets.end())
          for (const CoarseMesh::Face &face : set->second)
            visit(face, cost);
    }


    // None on a rank that knows the face sets only.
    std::vector<double>
    costs_of_coarse_cells(const CoarseMesh      &coarse,
                          const Grid::Materials &materials)
    {
      std::vector<double> costs;
      costs.reserve(materials.of_cell.size());
      for (const unsigned int material : materials.of_cell)
        costs.push_back(materials.costs[material]);
      if (!costs.empty())
        for_each_face_with_cost(coarse,
                                materials,
                                [&](const CoarseMesh::Face &face,
                                    const double            cost) {
                                  costs[face.cell] += cost;
                                });
      return costs;
    }


    // Sets the ranks of the active cells of a mesh that is not distributed.
    void
    divide_by_metis(Triangulation<3>          &serial,
                    const std::vector<double> &costs,
                    const unsigned int         n_ranks)
    {
      std::vector<unsigned int> weights;
      weights.reserve(costs.size());
      for (const double cost : costs)
        weights.push_back(static_cast<unsigned int>(100. * cost));
      GridTools::partition_triangulation(n_ranks,
                                         weights,
                                         serial,
                                         SparsityTools::Partitioner::metis);
    }
  } // namespace


  Grid::Grid(const CoarseMesh     &coarse,
             const GridParameters &parameters,
             const Materials      &materials,
             const MPI_Comm        communicator)
    : mpi_communicator(communicator)
    , partition_name(parameters.divided_along_curve() ?
                       "along a Hilbert curve" :
                       "by " + option_name(parameters.partition))
    , faces_of_set(coarse.face_sets.size() + 1)
  {
    for (const auto &set : coarse.face_sets)
      face_sets.push_back(set.first);
    for (const auto &set : coarse.cell_sets)
      cell_sets.push_back(set.first);
    for (const LocalRefinement &item : parameters.local_refinements())
      if (!item.set.empty())
        check_cell_set(item.set, "\"Local refinement\" in section \"Mesh\"");
    for (const std::string &set : split_list(parameters.refine_where.cell_sets))
      check_cell_set(set, "\"Cell sets\" in section \"Mesh/Refine where\"");
    const auto tags = make_tags(coarse, materials.of_cell);
    share_tags();
    if (parameters.partition == Partition::metis)
      create_metis(coarse, tags, parameters, materials);
    else if (parameters.divided_along_curve())
      create_along_curve(coarse, tags, parameters, materials);
    else
      create_p4est(coarse, tags, parameters, materials);
    find_faces(coarse);
  }


  Grid::Grid(const CoarseMesh     &coarse,
             const GridParameters &parameters,
             const MPI_Comm        communicator)
    : Grid(coarse,
           parameters,
           {std::vector<unsigned int>(coarse.cells.size(), 0),
            {1.},
            {std::numeric_limits<double>::infinity()},
            {std::numeric_limits<double>::infinity()}},
           communicator)
  {}


  std::vector<types::material_id>
  Grid::make_tags(const CoarseMesh                &coarse,
                  const std::vector<unsigned int> &materials)
  {
    std::vector<std::vector<unsigned int>> sets_of_cell(coarse.cells.size());
    unsigned int                           number = 0;
    for (const auto &set : coarse.cell_sets)
      {
        for (const unsigned int cell : set.second)
          sets_of_cell[cell].push_back(number);
        ++number;
      }

    std::map<std::pair<unsigned int, std::vector<unsigned int>>, unsigned int>
                                    number_of_tag;
    std::vector<types::material_id> result(coarse.cells.size());
    for (std::size_t c = 0; c < result.size(); ++c)
      {
        const auto [tag, is_new] =
          number_of_tag.emplace(std::make_pair(materials[c], sets_of_cell[c]),
                                all_tags.size());
        if (is_new)
          all_tags.push_back({materials[c], sets_of_cell[c]});
        result[c] = tag->second;
      }
    return result;
  }


  void
  Grid::create_coarse(const CoarseMesh                      &coarse,
                      const std::vector<types::material_id> &tags,
                      dealii::Triangulation<3> &triangulation) const
  {
    std::vector<CellData<3>> cells(coarse.cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        cells[c].vertices.assign(coarse.cells[c].begin(),
                                 coarse.cells[c].end());
        cells[c].material_id = tags[c];
      }
    const auto &chart = coarse.chart;
    triangulation.create_triangulation(chart.vertices.empty() ?
                                         coarse.vertices :
                                         chart.vertices,
                                       cells,
                                       SubCellData());
    attach_surfaces(chart, triangulation);
    mark_surfaces(chart, triangulation);
  }


  void
  Grid::create_p4est(const CoarseMesh                      &coarse,
                     const std::vector<types::material_id> &tags,
                     const GridParameters                  &parameters,
                     const Materials                       &materials)
  {
    using Distributed = parallel::distributed::Triangulation<3>;
    auto triangulation =
      std::make_unique<Distributed>(mpi_communicator,
                                    dealii::Triangulation<3>::none,
                                    Distributed::no_automatic_repartitioning);
    check_copies(coarse.cells.size(), mpi_communicator);
    create_coarse(coarse, tags, *triangulation);
    refined_where = refine(*triangulation,
                           coarse,
                           parameters,
                           materials,
                           RanksOfMachine(mpi_communicator).n_machines());
    auto costs    = costs_of_active_cells(*triangulation, coarse, materials);
    triangulation->signals.weight.connect(
      [&](const auto &cell, const auto) -> unsigned int {
        return static_cast<unsigned int>(1000. *
                                         costs[cell->active_cell_index()]);
      });
    triangulation->repartition();
    triangulation->signals.weight.disconnect_all_slots();
    place_vertices(coarse.chart, *triangulation);
    if (!parameters.counted_ranks.empty())
      costs = costs_of_active_cells(*triangulation, coarse, materials);
    for (const unsigned int n_ranks : parameters.counted_ranks)
      counts.push_back(count_by_p4est(*triangulation, costs, n_ranks));
    mesh = std::move(triangulation);
  }


  // Makes the own cells and those around them only, while p4est would store the
  // whole mesh on every rank.
  void
  Grid::create_along_curve(const CoarseMesh                      &coarse,
                           const std::vector<types::material_id> &tags,
                           const GridParameters                  &parameters,
                           const Materials                       &materials)
  {
    const auto costs = costs_of_coarse_cells(coarse, materials);
    mesh = std::make_unique<parallel::fullydistributed::Triangulation<3>>(
      mpi_communicator);
    mesh->create_triangulation(
      part_along_curve(coarse, tags, costs, mpi_communicator));
    if (Utilities::MPI::this_mpi_process(mpi_communicator) == 0)
      for (const unsigned int n_ranks : parameters.counted_ranks)
        counts.push_back(count_partition(
          coarse.cells, ranks_along_curve(costs, n_ranks), costs, n_ranks));
    counts = Utilities::MPI::broadcast(mpi_communicator, counts);
  }


  void
  Grid::share_tags()
  {
    std::vector<std::pair<unsigned int, std::vector<unsigned int>>> tags;
    for (const CellTag &tag : all_tags)
      tags.emplace_back(tag.material, tag.sets);
    all_tags.clear();
    for (const auto &[material, sets] :
         Utilities::MPI::broadcast(mpi_communicator, tags))
      all_tags.push_back({material, sets});
  }


  std::vector<double>
  Grid::costs_of_active_cells(const dealii::Triangulation<3> &triangulation,
                              const CoarseMesh               &coarse,
                              const Materials                &materials) const
  {
    std::vector<double> costs(triangulation.n_active_cells());
    for (const auto &cell : triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        costs[cell->active_cell_index()] = materials.costs[material(cell)];

    CoarseFaces         faces;
    std::vector<double> costs_of_faces;
    for_each_face_with_cost(
      coarse, materials, [&](const CoarseMesh::Face &face, const double cost) {
        faces.add(face, costs_of_faces.size());
        costs_of_faces.push_back(cost);
      });
    faces.for_each(triangulation,
                   [&](const ActiveCell &cell,
                       const unsigned int,
                       const unsigned int number) {
                     costs[cell->active_cell_index()] += costs_of_faces[number];
                   });
    return costs;
  }


  void
  Grid::count_by_metis(dealii::Triangulation<3>        &serial,
                       const std::vector<unsigned int> &n_ranks,
                       const std::vector<double>       &costs)
  {
    if (n_ranks.empty())
      return;
    std::vector<std::array<unsigned int, 8>> cells(serial.n_active_cells());
    for (const auto &cell : serial.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        cells[cell->active_cell_index()][v] = cell->vertex_index(v);
    std::vector<types::subdomain_id> rank(cells.size());
    for (const unsigned int n : n_ranks)
      {
        divide_by_metis(serial, costs, n);
        GridTools::get_subdomain_association(serial, rank);
        counts.push_back(count_partition(cells, rank, costs, n));
      }
  }


  void
  Grid::create_metis(const CoarseMesh                      &coarse,
                     const std::vector<types::material_id> &tags,
                     const GridParameters                  &parameters,
                     const Materials                       &materials)
  {
    share_tags();
    const double machines  = RanksOfMachine(mpi_communicator).n_machines();
    const auto   make_mesh = [&](dealii::Triangulation<3> &serial) {
      create_coarse(coarse, tags, serial);
      refined_where = refine(serial, coarse, parameters, materials, machines);
    };
    const auto deal_cells = [&](dealii::Triangulation<3> &serial,
                                const MPI_Comm           &communicator,
                                const unsigned int) {
      const auto costs = costs_of_active_cells(serial, coarse, materials);
      if (Utilities::MPI::this_mpi_process(communicator) == 0)
        count_by_metis(serial, parameters.counted_ranks, costs);
      divide_by_metis(serial,
                      costs,
                      Utilities::MPI::n_mpi_processes(communicator));
    };
    // one rank of a machine makes the whole mesh, and sends the others their
    // parts
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(mpi_communicator);
    const auto description = TriangulationDescription::Utilities::
      create_description_from_triangulation_in_groups<3, 3>(
        make_mesh,
        deal_cells,
        mpi_communicator,
        std::ceil(n_ranks / machines),
        dealii::Triangulation<3>::limit_level_difference_at_vertices);

    refined_where = Utilities::MPI::broadcast(mpi_communicator, refined_where);
    counts        = Utilities::MPI::broadcast(mpi_communicator, counts);

    auto triangulation =
      std::make_unique<parallel::fullydistributed::Triangulation<3>>(
        mpi_communicator);
    attach_surfaces(coarse.chart, *triangulation);
    triangulation->create_triangulation(description);
    place_vertices(coarse.chart, *triangulation);
    mesh = std::move(triangulation);
  }


  void
  Grid::find_faces(const CoarseMesh &coarse)
  {
    CoarseFaces  faces;
    unsigned int number = 0;
    for (const auto &set : coarse.face_sets)
      {
        for (const CoarseMesh::Face &face : set.second)
          faces.add(face, number);
        ++number;
      }
    faces.for_each(*mesh,
                   [&](const ActiveCell  &cell,
                       const unsigned int face,
                       const unsigned int set) {
                     faces_of_set[set].push_back({cell, face});
                   });
  }


  const Grid::Triangulation &
  Grid::triangulation() const
  {
    return *mesh;
  }


  MPI_Comm
  Grid::communicator() const
  {
    return mpi_communicator;
  }


  const std::vector<CellTag> &
  Grid::tags() const
  {
    return all_tags;
  }


  std::vector<std::string>
  Grid::sets_of(const Cell &cell) const
  {
    std::vector<std::string> names;
    for (const unsigned int set : all_tags[cell->material_id()].sets)
      names.push_back(cell_sets[set]);
    return names;
  }


  std::vector<bool>
  Grid::tags_in(const std::vector<std::string> &names) const
  {
    std::vector<bool> result;
    for (const CellTag &tag : all_tags)
      result.push_back(
        std::any_of(tag.sets.begin(), tag.sets.end(), [&](const auto set) {
          return std::find(names.begin(), names.end(), cell_sets[set]) !=
                 names.end();
        }));
    return result;
  }


  const std::vector<Grid::Face> &
  Grid::faces(const std::string &name) const
  {
    return faces_of_set[std::find(face_sets.begin(), face_sets.end(), name) -
                        face_sets.begin()];
  }


  bool
  Grid::in_face_set(const ActiveCell  &cell,
                    const unsigned int face,
                    const std::string &name) const
  {
    const auto place = [](const Face &item) {
      return std::make_pair(item.cell->active_cell_index(), item.face);
    };
    const auto &list  = faces(name);
    const auto  found = std::lower_bound(list.begin(),
                                        list.end(),
                                        Face{cell, face},
                                        [&](const Face &a, const Face &b) {
                                          return place(a) < place(b);
                                        });
    return found != list.end() && found->cell == cell && found->face == face;
  }


  void
  Grid::for_each_face(
    const std::string                                                 &name,
    const std::function<void(const ActiveCell &, const unsigned int)> &visit)
    const
  {
    for (const Face &item : faces(name))
      if (item.cell->is_locally_owned())
        visit(item.cell, item.face);
  }


  unsigned int
  Grid::owned_cell(const Cell &cell) const
  {
    return cell->global_active_cell_index() -
           mesh->global_active_cell_index_partitioner()
             .lock()
             ->local_range()
             .first;
  }


  const std::vector<std::string> &
  Grid::cell_set_names() const
  {
    return cell_sets;
  }


  const std::vector<std::string> &
  Grid::face_set_names() const
  {
    return face_sets;
  }


  void
  Grid::check_cell_set(const std::string &name, const std::string &place) const
  {
    if (std::find(cell_sets.begin(), cell_sets.end(), name) == cell_sets.end())
      throw UserError(place + " names the cell set \"" + name +
                      "\", which the mesh does not have" +
                      known_names(name, cell_sets) + ".");
  }


  void
  Grid::check_face_set(const std::string &name, const std::string &place) const
  {
    if (std::find(face_sets.begin(), face_sets.end(), name) == face_sets.end())
      throw UserError(place + " names the face set \"" + name +
                      "\", which the mesh does not have" +
                      known_names(name, face_sets) + ".");
  }


  const RefinementSummary &
  Grid::refinement() const
  {
    return refined_where;
  }


  const std::string &
  Grid::partition() const
  {
    return partition_name;
  }


  const std::vector<PartitionCounts> &
  Grid::partition_counts() const
  {
    return counts;
  }


  std::string
  Grid::describe_balance() const
  {
    const auto cells =
      Utilities::MPI::min_max_avg(mesh->n_locally_owned_active_cells(),
                                  mpi_communicator);
    std::ostringstream text;
    text << mesh->n_global_active_cells() << " cells on "
         << Utilities::MPI::n_mpi_processes(mpi_communicator)
         << " ranks (smallest share " << cells.min << ", largest " << cells.max
         << ")";
    return text.str();
  }


  std::uint64_t
  Grid::global_key(const Cell &cell)
  {
    const auto    path = children_upwards(cell);
    std::uint64_t key  = coarse_cell(cell);
    for (auto child = path.rbegin(); child != path.rend(); ++child)
      key = 8 * key + *child;
    // the level distinguishes a cell from its own first child
    return (key << 4) + path.size();
  }
} // namespace Voussoir
