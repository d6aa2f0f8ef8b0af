#include <voussoir/base/mpi.h>
#include <voussoir/grid/partition_counts.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <iomanip>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Mesh = parallel::DistributedTriangulationBase<3>;


    // The rank of each cell, owned ones and ghosts.
    std::vector<unsigned int>
    deal_cells(const Mesh                &mesh,
               const std::vector<double> &costs,
               const unsigned int         n_ranks)
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
        mine += costs[item.second->active_cell_index()];
      double before = 0., total = 0.;
      for (const double of_rank :
           Utilities::MPI::all_gather(communicator, mine))
        total += of_rank;
      MPI_Exscan(&mine, &before, 1, MPI_DOUBLE, MPI_SUM, communicator);
      std::vector<unsigned int> rank(mesh.n_active_cells());
      for (const auto &[id, cell] : cells)
        {
          const double own = costs[cell->active_cell_index()];
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
        PartitionCounts result{sum_over_ranks(load, communicator),
                               sum_over_ranks(inner_cells, communicator),
                               {},
                               nodes};
        const double    mean =
          std::accumulate(result.load.begin(), result.load.end(), 0.) / n_ranks;
        const auto n_cells = sum_over_ranks(cells, communicator);
        for (unsigned int r = 0; r < n_ranks; ++r)
          {
            result.load[r] /= mean;
            result.inner[r] =
              n_cells[r] > 0. ? result.inner[r] / n_cells[r] : 1.;
            result.neighbours.push_back(neighbours[r].size());
          }
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
    const auto mean = [](const auto &values) {
      return std::accumulate(values.begin(), values.end(), 0.) / values.size();
    };
    const auto largest = [](const auto &values) {
      return *std::max_element(values.begin(), values.end());
    };
    std::ostringstream text;
    text << std::setprecision(3) << load.size() << " ranks: largest load "
         << largest(load) << " of the mean, neighbours of a rank "
         << mean(neighbours) << " (at most " << largest(neighbours)
         << "), nodes it exchanges with them " << mean(nodes) << " (at most "
         << largest(nodes) << "), part of its cells without these "
         << mean(inner) << " (at least "
         << *std::min_element(inner.begin(), inner.end()) << ")";
    return text.str();
  }


  PartitionCounts
  count_by_p4est(const Mesh                &mesh,
                 const std::vector<double> &costs,
                 const unsigned int         n_ranks)
  {
    const auto rank = deal_cells(mesh, costs, n_ranks);

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
            counts.add_cell(own, costs[cell->active_cell_index()], is_inner);
        }
    for (const auto &[vertex, node] : shared)
      if (node.is_owned)
        for (const unsigned int other : node.ranks)
          if (other != at.owner(vertex))
            ++counts.pairs[{at.owner(vertex), other}];
    return counts.sum(mesh.get_communicator());
  }


  PartitionCounts
  count_partition(const std::vector<std::array<unsigned int, 8>> &cells,
                  const std::vector<types::subdomain_id>         &rank,
                  const std::vector<double>                      &costs,
                  const unsigned int                              n_ranks)
  {
    unsigned int n_vertices = 0;
    for (const auto &vertices : cells)
      for (const unsigned int vertex : vertices)
        n_vertices = std::max(n_vertices, vertex + 1);
    RanksAtVertices at(n_vertices);
    for (unsigned int cell = 0; cell < cells.size(); ++cell)
      for (const unsigned int vertex : cells[cell])
        at.add(vertex, rank[cell]);
    Counts                                          counts(n_ranks);
    std::set<std::pair<unsigned int, unsigned int>> shared; // node, rank
    for (unsigned int cell = 0; cell < cells.size(); ++cell)
      {
        bool is_inner = true;
        for (const unsigned int vertex : cells[cell])
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
    return counts.sum(MPI_COMM_SELF);
  }
} // namespace Voussoir
