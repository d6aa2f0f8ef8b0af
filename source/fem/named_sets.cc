#include <voussoir/base/error.h>
#include <voussoir/fem/named_sets.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  for_each_face(
    const Discretization                          &discretization,
    const std::vector<std::string>                &sets,
    const std::string                             &place,
    const std::function<void(const Triangulation<3>::active_cell_iterator &,
                             const unsigned int)> &visit)
  {
    if (sets.empty())
      throw UserError(place + " is empty; name the face sets it acts on.");
    for (const std::string &set : sets)
      check_outer_face_set(discretization.grid, set, place);
    for (const std::string &set : sets)
      discretization.grid.for_each_face(set, visit);
  }


  void
  check_outer_face_set(const Grid        &grid,
                       const std::string &set,
                       const std::string &place)
  {
    grid.check_face_set(set, place);
    unsigned int n_inner = 0;
    Point<3>     inner;
    grid.for_each_face(set, [&](const auto &cell, const unsigned int face) {
      if (!cell->at_boundary(face))
        {
          ++n_inner;
          inner = cell->face(face)->center();
        }
    });
    for (const auto &[n, point] :
         Utilities::MPI::all_gather(grid.communicator(),
                                    std::make_tuple(n_inner, inner)))
      if (n > 0)
        {
          std::ostringstream text;
          text
            << place << " names the face set \"" << set
            << "\", which has faces with cells on both sides, one at ("
            << point[0] << ", " << point[1] << ", " << point[2]
            << ") m; name faces of the surface, or make the set an interface "
               "in section \"Interfaces\".";
          throw UserError(text.str());
        }
  }


  void
  for_each_cell(const Discretization           &discretization,
                const std::vector<std::string> &sets,
                const std::string              &place,
                const std::function<void(const Discretization::Cell &)> &visit)
  {
    const Grid &grid = discretization.grid;
    for (const std::string &set : sets)
      grid.check_cell_set(set, place);
    const std::vector<bool> tagged = grid.tags_in(sets);
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() &&
          (sets.empty() || tagged[cell->material_id()]))
        visit(cell);
  }


  std::set<types::global_dof_index>
  nodes_of_faces(const Discretization           &discretization,
                 const std::vector<std::string> &sets,
                 const std::string              &place)
  {
    const auto &scalar = discretization.fe.base_element(0);
    std::set<types::global_dof_index> nodes;
    for_each_face(discretization,
                  sets,
                  place,
                  [&](const auto &cell, const unsigned int face) {
                    const auto cell_nodes =
                      discretization.cell_nodes(discretization.dof_cell(cell));
                    for (unsigned int j = 0; j < cell_nodes.size(); ++j)
                      if (scalar.has_support_on_face(j, face))
                        nodes.insert(cell_nodes[j]);
                  });
    return nodes;
  }


  std::vector<unsigned int>
  owned_carriers(const Discretization                    &discretization,
                 const std::set<types::global_dof_index> &nodes)
  {
    struct Nothing
    {};
    std::set<types::global_dof_index> carriers;
    for (const types::global_dof_index node : nodes)
      for (const auto &share : discretization.carriers(node))
        carriers.insert(share.node);
    std::vector<std::pair<types::global_dof_index, Nothing>> records;
    for (const types::global_dof_index node : carriers)
      records.emplace_back(node, Nothing());
    std::set<unsigned int> owned;
    for (const auto &record : discretization.send_to_owners(records))
      owned.insert(record.first);
    return {owned.begin(), owned.end()};
  }
} // namespace Voussoir
