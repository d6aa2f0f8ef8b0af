#include <voussoir/base/error.h>
#include <voussoir/grid/partition_counts.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The rank of each cell, owned ones and ghosts.
    std::vector<unsigned int>
    deal_cells(const Grid                                      &grid,
               const std::function<double(const Grid::Cell &)> &cost,
               const unsigned int                               n_ranks)
    {
      const auto &mesh = grid.triangulation();
      // a CellId is ordered by the trees of p4est and the children in them
      std::vector<std::pair<CellId, Grid::ActiveCell>> cells;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          cells.emplace_back(cell->id(), cell);
      std::sort(cells.begin(), cells.end(), [](const auto &a, const auto &b) {
        return a.first < b.first;
      });

      double mine = 0.;
      for (const auto &item : cells)
        mine += cost(item.second);
      double before = 0., total = 0.;
      for (const double of_rank :
           Utilities::MPI::all_gather(grid.communicator(), mine))
        total += of_rank;
      MPI_Exscan(&mine, &before, 1, MPI_DOUBLE, MPI_SUM, grid.communicator());
      std::vector<unsigned int> rank(mesh.n_active_cells());
      for (const auto &[id, cell] : cells)
        {
          const double own = cost(cell);
          rank[cell->active_cell_index()] =
            std::min<unsigned int>(n_ranks * ((before + 0.5 * own) / total),
                                   n_ranks - 1);
          before += own;
        }
      GridTools::exchange_cell_data_to_ghosts<unsigned int,
                                              dealii::Triangulation<3>>(
        mesh,
        [&](const auto &cell) { return rank[cell->active_cell_index()]; },
        [&](const auto &cell, const unsigned int of_ghost) {
          rank[cell->active_cell_index()] = of_ghost;
        });
      return rank;
    }
  } // namespace


  std::string
  PartitionCounts::describe() const
  {
    std::ostringstream text;
    text << std::setprecision(3) << ranks << " ranks: largest load " << balance
         << " of the mean, neighbours of a rank " << neighbours << " (at most "
         << most_neighbours << "), nodes it exchanges with them " << nodes
         << " (at most " << most_nodes << ")";
    return text.str();
  }


  PartitionCounts
  count_partition(const Grid                                      &grid,
                  const std::function<double(const Grid::Cell &)> &cost,
                  const unsigned int                               n_ranks)
  {
    const auto &mesh = grid.triangulation();
    if (dynamic_cast<const parallel::distributed::Triangulation<3> *>(&mesh) ==
        nullptr)
      throw UserError("\"Count partitions\" in section \"Mesh\" needs "
                      "\"Partition = p4est\".");
    const auto rank = deal_cells(grid, cost, n_ranks);

    // the rank that owns the first cell at a node counts the node
    constexpr auto none = numbers::invalid_unsigned_int;
    struct Node
    {
      types::global_cell_index first =
        std::numeric_limits<types::global_cell_index>::max();
      bool                      is_owned = false;
      std::vector<unsigned int> ranks;
    };
    std::vector<unsigned int> lowest(mesh.n_vertices(), none),
      highest(mesh.n_vertices(), 0);
    for (const auto &cell : mesh.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int vertex = cell->vertex_index(v),
                               own    = rank[cell->active_cell_index()];
            lowest[vertex]            = std::min(lowest[vertex], own);
            highest[vertex]           = std::max(highest[vertex], own);
          }
    std::map<unsigned int, Node> shared;
    std::vector<double>          load(n_ranks, 0.);
    for (const auto &cell : mesh.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const unsigned int own = rank[cell->active_cell_index()];
          if (cell->is_locally_owned())
            load[own] += cost(cell);
          for (const unsigned int v : cell->vertex_indices())
            if (const unsigned int vertex = cell->vertex_index(v);
                lowest[vertex] != highest[vertex])
              {
                Node &node = shared[vertex];
                if (cell->global_active_cell_index() < node.first)
                  {
                    node.first    = cell->global_active_cell_index();
                    node.is_owned = cell->is_locally_owned();
                  }
                if (std::find(node.ranks.begin(), node.ranks.end(), own) ==
                    node.ranks.end())
                  node.ranks.push_back(own);
              }
        }
    using Pairs = std::map<std::pair<unsigned int, unsigned int>, unsigned int>;
    Pairs pairs; // owner and other rank, number of nodes
    for (const auto &[vertex, node] : shared)
      if (node.is_owned)
        for (const unsigned int other : node.ranks)
          if (other != lowest[vertex])
            ++pairs[{lowest[vertex], other}];

    Utilities::MPI::sum(load, grid.communicator(), load);
    const auto all = Utilities::MPI::gather(
      grid.communicator(),
      std::vector<std::pair<std::pair<unsigned int, unsigned int>,
                            unsigned int>>(pairs.begin(), pairs.end()));
    std::vector<std::set<unsigned int>> neighbours(n_ranks);
    std::vector<unsigned int>           nodes(n_ranks, 0);
    for (const auto &of_rank : all)
      for (const auto &[pair, n] : of_rank)
        for (const unsigned int side : {0, 1})
          {
            const unsigned int own   = side == 0 ? pair.first : pair.second,
                               other = side == 0 ? pair.second : pair.first;
            neighbours[own].insert(other);
            nodes[own] += n;
          }
    PartitionCounts result{n_ranks, 0., 0., 0., 0, 0};
    double          total = 0.;
    for (unsigned int r = 0; r < n_ranks; ++r)
      {
        total += load[r];
        result.balance = std::max(result.balance, load[r]);
        result.neighbours += double(neighbours[r].size()) / n_ranks;
        result.nodes += double(nodes[r]) / n_ranks;
        result.most_neighbours =
          std::max<unsigned int>(result.most_neighbours, neighbours[r].size());
        result.most_nodes = std::max(result.most_nodes, nodes[r]);
      }
    result.balance *= n_ranks / total;
    return Utilities::MPI::broadcast(grid.communicator(), result);
  }
} // namespace Voussoir
