#include <voussoir/base/mpi.h>
#include <voussoir/grid/curve_partition.h>
#include <voussoir/grid/partition_counts.h>

#include <deal.II/base/mpi.h>
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
    using Mesh = parallel::DistributedTriangulationBase<3>;
    using Cost = std::function<double(const Triangulation<3>::cell_iterator &)>;


    // The rank of each cell, owned ones and ghosts.
    std::vector<unsigned int>
    deal_cells(const Mesh &mesh, const Cost &cost, const unsigned int n_ranks)
    {
      // a CellId is ordered by the trees of p4est and the children in them
      using Cell = Triangulation<3>::active_cell_iterator;
      std::vector<std::pair<CellId, Cell>> cells;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          cells.emplace_back(cell->id(), cell);
      std::sort(cells.begin(), cells.end(), [](const auto &a, const auto &b) {
        return a.first < b.first;
      });

      const MPI_Comm communicator = mesh.get_communicator();
      double         mine         = 0.;
      for (const auto &item : cells)
        mine += cost(item.second);
      double before = 0., total = 0.;
      for (const double of_rank :
           Utilities::MPI::all_gather(communicator, mine))
        total += of_rank;
      MPI_Exscan(&mine, &before, 1, MPI_DOUBLE, MPI_SUM, communicator);
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


    // The lowest and the highest rank of the cells at each vertex.
    class RanksAtVertices
    {
    public:
      explicit RanksAtVertices(const std::size_t n_vertices)
        : lowest(n_vertices, std::numeric_limits<unsigned int>::max())
        , highest(n_vertices, 0)
      {}

      void
      add(const unsigned int vertex, const unsigned int rank)
      {
        lowest[vertex]  = std::min(lowest[vertex], rank);
        highest[vertex] = std::max(highest[vertex], rank);
      }

      unsigned int
      owner(const unsigned int vertex) const
      {
        return lowest[vertex];
      }

      bool
      is_shared(const unsigned int vertex) const
      {
        return lowest[vertex] != highest[vertex];
      }

    private:
      std::vector<unsigned int> lowest, highest;
    };


    // What one rank of the run knows of the ranks that are counted.
    struct Counts
    {
      explicit Counts(const unsigned int n_ranks)
        : load(n_ranks, 0.)
        , cells(n_ranks, 0.)
        , inner_cells(n_ranks, 0.)
      {}

      void
      add_cell(const unsigned int rank, const double cost, const bool is_inner)
      {
        load[rank] += cost;
        cells[rank] += 1.;
        inner_cells[rank] += is_inner ? 1. : 0.;
      }

      PartitionCounts
      sum(const MPI_Comm communicator) const
      {
        const auto                          n_ranks = load.size();
        std::vector<std::set<unsigned int>> neighbours(n_ranks);
        std::vector<unsigned int>           nodes(n_ranks, 0);
        std::vector<
          std::pair<std::pair<unsigned int, unsigned int>, unsigned int>>
          list(pairs.begin(), pairs.end());
        for (const auto &of_rank : Utilities::MPI::gather(communicator, list))
          for (const auto &[pair, n] : of_rank)
            for (const auto &[own, other] :
                 {pair, std::make_pair(pair.second, pair.first)})
              {
                neighbours[own].insert(other);
                nodes[own] += n;
              }
        const auto loads     = sum_over_ranks(load, communicator),
                   n_cells   = sum_over_ranks(cells, communicator),
                   all_inner = sum_over_ranks(inner_cells, communicator);
        PartitionCounts result{
          static_cast<unsigned int>(n_ranks), 0., 0., 0., 0, 0, 0., 1.};
        double total = 0.;
        for (unsigned int r = 0; r < n_ranks; ++r)
          {
            const unsigned int n_neighbours = neighbours[r].size();
            const double       inner =
              n_cells[r] > 0. ? all_inner[r] / n_cells[r] : 1.;
            total += loads[r];
            result.balance = std::max(result.balance, loads[r]);
            result.neighbours += double(n_neighbours) / n_ranks;
            result.nodes += double(nodes[r]) / n_ranks;
            result.inner += inner / n_ranks;
            result.most_neighbours =
              std::max(result.most_neighbours, n_neighbours);
            result.most_nodes  = std::max(result.most_nodes, nodes[r]);
            result.least_inner = std::min(result.least_inner, inner);
          }
        result.balance *= n_ranks / total;
        return Utilities::MPI::broadcast(communicator, result);
      }

      std::vector<double> load, cells, inner_cells; // of each rank

      // owner and other rank, number of nodes
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> pairs;
    };
  } // namespace


  std::string
  PartitionCounts::describe() const
  {
    std::ostringstream text;
    text << std::setprecision(3) << ranks << " ranks: largest load " << balance
         << " of the mean, neighbours of a rank " << neighbours << " (at most "
         << most_neighbours << "), nodes it exchanges with them " << nodes
         << " (at most " << most_nodes << "), part of its cells without these "
         << inner << " (at least " << least_inner << ")";
    return text.str();
  }


  PartitionCounts
  count_by_p4est(const Mesh &mesh, const Cost &cost, const unsigned int n_ranks)
  {
    const auto rank = deal_cells(mesh, cost, n_ranks);

    RanksAtVertices at(mesh.n_vertices());
    for (const auto &cell : mesh.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          at.add(cell->vertex_index(v), rank[cell->active_cell_index()]);

    // the rank of the run that owns the first cell at a node counts the node
    struct Node
    {
      types::global_cell_index first =
        std::numeric_limits<types::global_cell_index>::max();
      bool                   is_owned = false;
      std::set<unsigned int> ranks;
    };
    std::map<unsigned int, Node> shared;
    Counts                       counts(n_ranks);
    for (const auto &cell : mesh.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const unsigned int own      = rank[cell->active_cell_index()];
          bool               is_inner = true;
          for (const unsigned int v : cell->vertex_indices())
            if (const unsigned int vertex = cell->vertex_index(v);
                at.is_shared(vertex))
              {
                is_inner   = false;
                Node &node = shared[vertex];
                if (cell->global_active_cell_index() < node.first)
                  {
                    node.first    = cell->global_active_cell_index();
                    node.is_owned = cell->is_locally_owned();
                  }
                node.ranks.insert(own);
              }
          if (cell->is_locally_owned())
            counts.add_cell(own, cost(cell), is_inner);
        }
    for (const auto &[vertex, node] : shared)
      if (node.is_owned)
        for (const unsigned int other : node.ranks)
          if (other != at.owner(vertex))
            ++counts.pairs[{at.owner(vertex), other}];
    return counts.sum(mesh.get_communicator());
  }


  PartitionCounts
  count_along_curve(const CoarseMesh          &mesh,
                    const std::vector<double> &costs,
                    const unsigned int         n_ranks,
                    const MPI_Comm             communicator)
  {
    Counts counts(n_ranks);
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        const auto      rank = ranks_along_curve(costs, n_ranks);
        RanksAtVertices at(mesh.vertices.size());
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          for (const unsigned int vertex : mesh.cells[cell])
            at.add(vertex, rank[cell]);
        std::set<std::pair<unsigned int, unsigned int>> shared; // node, rank
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          {
            bool is_inner = true;
            for (const unsigned int vertex : mesh.cells[cell])
              if (at.is_shared(vertex))
                {
                  is_inner = false;
                  if (rank[cell] != at.owner(vertex))
                    shared.emplace(vertex, rank[cell]);
                }
            counts.add_cell(rank[cell], costs[cell], is_inner);
          }
        for (const auto &[vertex, other] : shared)
          ++counts.pairs[{at.owner(vertex), other}];
      }
    return counts.sum(communicator);
  }
} // namespace Voussoir
