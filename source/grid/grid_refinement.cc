#include <voussoir/base/error.h>
#include <voussoir/grid/chart_vertices.h>
#include <voussoir/grid/grid.h>
#include <voussoir/mesh/mesh_check.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A serial triangulation is on one rank.
    unsigned int
    sum_of_ranks(const Triangulation<3> &triangulation, const unsigned int mine)
    {
      const auto *distributed =
        dynamic_cast<const Grid::Triangulation *>(&triangulation);
      return distributed == nullptr ?
               mine :
               Utilities::MPI::sum(mine, distributed->get_communicator());
    }
  } // namespace


  void
  Grid::refine(dealii::Triangulation<3> &triangulation,
               const CoarseMesh::Chart  &chart,
               const GridParameters     &parameters,
               const Materials          &materials,
               const double              machines) const
  {
    check_size(triangulation.n_cells(0) *
                 std::pow(8., parameters.global_refinement),
               1,
               "\"Global refinement\" in section \"Mesh\"",
               machines);
    triangulation.refine_global(parameters.global_refinement);
    for (const LocalRefinement &item : parameters.local_refinements())
      {
        const std::vector<bool> tagged = tags_in({item.set});
        for (unsigned int level = 0; level < item.levels; ++level)
          {
            const auto   places  = item.set.empty() ?
                                     positions(triangulation, chart) :
                                     std::vector<Point<3>>();
            unsigned int flagged = 0;
            for (const auto &cell : triangulation.active_cell_iterators())
              if (cell->is_locally_owned())
                {
                  bool inside = true;
                  if (!item.set.empty())
                    inside = tagged[cell->material_id()];
                  else
                    {
                      Point<3> centre;
                      for (const unsigned int v : cell->vertex_indices())
                        centre += 0.125 * places[cell->vertex_index(v)];
                      for (unsigned int d = 0; d < 3; ++d)
                        inside = inside && centre[d] >= item.lower[d] &&
                                 centre[d] <= item.upper[d];
                    }
                  if (inside)
                    {
                      cell->set_refine_flag();
                      ++flagged;
                    }
                }
            if (sum_of_ranks(triangulation, flagged) == 0)
              throw UserError(
                "\"Local refinement\" in section \"Mesh\" names a box in which "
                "no cell has its centre; make it larger, or leave it out.");
            triangulation.execute_coarsening_and_refinement();
          }
      }
    while (refine_for_waves(triangulation, chart, materials, machines))
      {}
  }


  bool
  Grid::refine_for_waves(dealii::Triangulation<3> &triangulation,
                         const CoarseMesh::Chart  &chart,
                         const Materials          &materials,
                         const double              machines) const
  {
    if (std::all_of(materials.longest_edges.begin(),
                    materials.longest_edges.end(),
                    [](const double edge) { return std::isinf(edge); }))
      return false;
    const auto places    = positions(triangulation, chart);
    const auto is_longer = [&](const auto &cell, const double edge) {
      for (const unsigned int line : cell->line_indices())
        if (places[cell->line(line)->vertex_index(0)].distance(
              places[cell->line(line)->vertex_index(1)]) > edge)
          return true;
      return false;
    };
    unsigned int flagged = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() &&
          is_longer(cell, materials.longest_edges[material(cell)]))
        {
          cell->set_refine_flag();
          ++flagged;
        }
    flagged = sum_of_ranks(triangulation, flagged);
    if (flagged == 0)
      return false;
    check_size(triangulation.n_global_active_cells() + 7. * flagged,
               1,
               "\"Nodes per wavelength\" in section \"Mesh\"",
               machines);
    triangulation.execute_coarsening_and_refinement();
    return true;
  }
} // namespace Voussoir
