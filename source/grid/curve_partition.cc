#include <voussoir/base/first_rank.h>
#include <voussoir/base/machine.h>
#include <voussoir/grid/curve_partition.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The cells in the order in which the curve passes their centres.
    std::vector<unsigned int>
    cells_along_curve(const CoarseMesh &mesh)
    {
      constexpr int         bits = 20; // of each coordinate
      std::vector<Point<3>> centres;
      centres.reserve(mesh.cells.size());
      for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
        centres.push_back(cell_centre(mesh, cell));
      const auto places =
        Utilities::inverse_Hilbert_space_filling_curve(centres, bits);
      std::vector<std::pair<std::uint64_t, unsigned int>> along;
      along.reserve(places.size());
      for (unsigned int cell = 0; cell < places.size(); ++cell)
        along.emplace_back(Utilities::pack_integers<3>(places[cell], bits),
                           cell);
      std::sort(along.begin(), along.end());
      std::vector<unsigned int> order;
      order.reserve(along.size());
      for (const auto &item : along)
        order.push_back(item.second);
      return order;
    }


    // Divides the cells in their order into parts of equal costs.
    class Parts
    {
    public:
      Parts(const CoarseMesh                      &mesh,
            const std::vector<types::material_id> &tags,
            const std::vector<double>             &costs,
            const unsigned int                     n_ranks)
        : mesh(mesh)
        , tags(tags)
        , rank(ranks_along_curve(costs, n_ranks))
        , is_near(mesh.cells.size(), false)
        , begin_of_vertex(mesh.vertices.size() + 1, 0)
      {
        list_cells_of_vertices();
      }

      /** The cells of a rank and those around them, in their order; the
       *  communicator is not set. */
      TriangulationDescription::Description<3, 3>
      operator()(const types::subdomain_id of_rank)
      {
        TriangulationDescription::Description<3, 3> part;
        part.settings  = TriangulationDescription::default_setting;
        part.smoothing = Triangulation<3>::none;
        part.cell_infos.resize(1);
        std::unordered_map<unsigned int, unsigned int> number_of_vertex;
        for (const unsigned int cell : cells_near(of_rank))
          {
            CellData<3> data;
            data.material_id = tags[cell];
            for (unsigned int v = 0; v < 8; ++v)
              {
                const unsigned int vertex = mesh.cells[cell][v];
                const auto [number, is_new] =
                  number_of_vertex.emplace(vertex, number_of_vertex.size());
                if (is_new)
                  part.coarse_cell_vertices.push_back(mesh.vertices[vertex]);
                data.vertices[v] = number->second;
              }
            part.coarse_cells.push_back(data);
            part.coarse_cell_index_to_coarse_cell_id.push_back(cell);

            TriangulationDescription::CellData<3> info;
            info.id                 = CellId(cell, {}).to_binary<3>();
            info.subdomain_id       = rank[cell];
            info.level_subdomain_id = numbers::invalid_subdomain_id;
            info.manifold_id        = numbers::flat_manifold_id;
            info.manifold_line_ids.fill(numbers::flat_manifold_id);
            info.manifold_quad_ids.fill(numbers::flat_manifold_id);
            part.cell_infos[0].push_back(info);
          }
        return part;
      }

    private:
      void
      list_cells_of_vertices()
      {
        for (const auto &vertices : mesh.cells)
          for (const unsigned int v : vertices)
            ++begin_of_vertex[v];
        std::partial_sum(begin_of_vertex.begin(),
                         begin_of_vertex.end(),
                         begin_of_vertex.begin());
        cells_of_vertices.resize(begin_of_vertex.back());
        // until here the ends of the lists, which are filled backwards
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          for (const unsigned int v : mesh.cells[cell])
            cells_of_vertices[--begin_of_vertex[v]] = cell;
      }

      // The cells of a rank and those around them.
      std::vector<unsigned int>
      cells_near(const types::subdomain_id of_rank)
      {
        const auto own = std::equal_range(rank.begin(), rank.end(), of_rank);
        std::vector<unsigned int> cells;
        for (auto it = own.first; it != own.second; ++it)
          for (const unsigned int v : mesh.cells[it - rank.begin()])
            for (auto i = begin_of_vertex[v]; i < begin_of_vertex[v + 1]; ++i)
              if (const unsigned int cell = cells_of_vertices[i];
                  !is_near[cell])
                {
                  is_near[cell] = true;
                  cells.push_back(cell);
                }
        for (const unsigned int cell : cells)
          is_near[cell] = false;
        std::sort(cells.begin(), cells.end());
        return cells;
      }

      const CoarseMesh                      &mesh;
      const std::vector<types::material_id> &tags;

      const std::vector<types::subdomain_id> rank;    // of each cell, ascending
      std::vector<bool>                      is_near; // false between calls

      std::vector<std::size_t>  begin_of_vertex; // in cells_of_vertices
      std::vector<unsigned int> cells_of_vertices;
    };
  } // namespace


  void
  order_along_curve(CoarseMesh &mesh)
  {
    if (mesh.cells.empty())
      return;
    const std::vector<unsigned int> order = cells_along_curve(mesh);
    std::vector<unsigned int>       number(order.size());
    auto                            cells = mesh.cells;
    for (unsigned int i = 0; i < order.size(); ++i)
      {
        number[order[i]] = i;
        mesh.cells[i]    = cells[order[i]];
      }
    for (auto &set : mesh.cell_sets)
      for (unsigned int &cell : set.second)
        cell = number[cell];
    const auto renumber = [&](std::vector<CoarseMesh::Face> &faces) {
      for (CoarseMesh::Face &face : faces)
        face.cell = number[face.cell];
    };
    for (auto &set : mesh.face_sets)
      renumber(set.second);
    for (CoarseMesh::Chart::Surface &surface : mesh.chart.surfaces)
      renumber(surface.faces);
  }


  std::vector<types::subdomain_id>
  ranks_along_curve(const std::vector<double> &costs,
                    const unsigned int         n_ranks)
  {
    const double total  = std::accumulate(costs.begin(), costs.end(), 0.);
    double       before = 0.;
    std::vector<types::subdomain_id> rank;
    rank.reserve(costs.size());
    for (const double cost : costs)
      {
        rank.push_back(std::min<types::subdomain_id>(
          n_ranks * ((before + 0.5 * cost) / total), n_ranks - 1));
        before += cost;
      }
    return rank;
  }


  TriangulationDescription::Description<3, 3>
  part_along_curve(const CoarseMesh                      &mesh,
                   const std::vector<types::material_id> &tags,
                   const std::vector<double>             &costs,
                   const MPI_Comm                         communicator)
  {
    const RanksOfMachine   machine(communicator);
    const auto             numbers = machine.numbers();
    std::unique_ptr<Parts> parts;
    if (Utilities::MPI::this_mpi_process(machine.communicator) == 0)
      parts = std::make_unique<Parts>(
        mesh, tags, costs, Utilities::MPI::n_mpi_processes(communicator));
    auto part =
      made_on_first_rank(machine.communicator, [&](const unsigned int rank) {
        return (*parts)(numbers[rank]);
      });
    part.comm = communicator;
    return part;
  }
} // namespace Voussoir
