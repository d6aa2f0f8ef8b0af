#include <voussoir/grid/curve_partition.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // The cells in the order in which the curve passes their centres.
    std::vector<unsigned int>
    order_along_curve(const CoarseMesh &mesh)
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


    // The rank of each cell: of equal costs, cut in the order of the curve.
    std::vector<types::subdomain_id>
    deal_cells(const std::vector<unsigned int> &order,
               const std::vector<double>       &costs,
               const unsigned int               n_ranks)
    {
      const double total  = std::accumulate(costs.begin(), costs.end(), 0.);
      double       before = 0.;
      std::vector<types::subdomain_id> rank(order.size());
      for (const unsigned int cell : order)
        {
          rank[cell] = std::min<types::subdomain_id>(
            n_ranks * ((before + 0.5 * costs[cell]) / total), n_ranks - 1);
          before += costs[cell];
        }
      return rank;
    }
  } // namespace


  TriangulationDescription::Description<3, 3>
  part_along_curve(const CoarseMesh                      &mesh,
                   const std::vector<types::material_id> &tags,
                   const std::vector<double>             &costs,
                   const MPI_Comm                         communicator)
  {
    const auto order = order_along_curve(mesh);
    const auto rank =
      deal_cells(order, costs, Utilities::MPI::n_mpi_processes(communicator));
    const types::subdomain_id mine =
      Utilities::MPI::this_mpi_process(communicator);

    std::vector<bool> is_near(mesh.vertices.size(), false);
    for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
      if (rank[cell] == mine)
        for (const unsigned int v : mesh.cells[cell])
          is_near[v] = true;

    TriangulationDescription::Description<3, 3> part;
    part.comm      = communicator;
    part.settings  = TriangulationDescription::default_setting;
    part.smoothing = Triangulation<3>::none;
    part.cell_infos.resize(1);
    std::vector<unsigned int> number_of_vertex(mesh.vertices.size(), none);
    for (const unsigned int cell : order)
      {
        const auto &vertices = mesh.cells[cell];
        if (std::none_of(vertices.begin(),
                         vertices.end(),
                         [&](const unsigned int v) { return is_near[v]; }))
          continue;
        CellData<3> data;
        data.material_id = tags[cell];
        for (unsigned int i = 0; i < 8; ++i)
          {
            unsigned int &number = number_of_vertex[vertices[i]];
            if (number == none)
              {
                number = part.coarse_cell_vertices.size();
                part.coarse_cell_vertices.push_back(mesh.vertices[vertices[i]]);
              }
            data.vertices[i] = number;
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
} // namespace Voussoir
