#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>
#include <voussoir/grid/grid.h>
#include <voussoir/mesh/mesh_check.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Index in the coarse mesh of the coarse cell that a cell lies in.
    unsigned int
    coarse_cell(const Grid::Cell &cell)
    {
      // p4est numbers the coarse cells in a way of its own, and a fully
      // distributed mesh holds some of them only
      if (dynamic_cast<const parallel::fullydistributed::Triangulation<3> *>(
            &cell->get_triangulation()) != nullptr)
        return cell->id().get_coarse_cell_id();
      Grid::Cell coarse = cell;
      while (coarse->level() > 0)
        coarse = coarse->parent();
      return coarse->index();
    }


    // The path of a refined cell below its coarse cell, one child number per
    // level, finest first.
    std::vector<unsigned int>
    children_upwards(const Grid::Cell &cell)
    {
      std::vector<unsigned int> path;
      for (Grid::Cell child = cell; child->level() > 0; child = child->parent())
        {
          const auto parent = child->parent();
          for (unsigned int i = 0; i < 8; ++i)
            if (parent->child(i) == child)
              path.push_back(i);
        }
      return path;
    }


    // Face 2d+s of a child lies on that face of its parent if the child sits on
    // that side, that is, if bit d of its number is s.
    bool
    lies_on_coarse_face(const std::vector<unsigned int> &path,
                        const unsigned int               face)
    {
      return std::all_of(path.begin(), path.end(), [&](const auto child) {
        return ((child >> (face / 2)) & 1) == face % 2;
      });
    }


    // One item of the entry "Local refinement".
    struct LocalRefinement
    {
      std::string  set; // empty: a box
      Point<3>     lower, upper;
      unsigned int levels;
    };

    std::vector<LocalRefinement>
    parse_local_refinement(const std::string &text)
    {
      std::vector<LocalRefinement> items;
      for (const std::string &item : split_list(text, ';'))
        {
          const auto        colon = item.rfind(':');
          const std::string place = "\"Local refinement\" in section \"Mesh\"";
          if (colon == std::string::npos)
            throw UserError(place + ": \"" + item +
                            "\" has no \": levels\"; write for example "
                            "\"dam: 1\" or \"box 0 0 0 10 10 10: 1\".");
          LocalRefinement    result;
          std::istringstream levels(item.substr(colon + 1));
          std::string        rest;
          if (!(levels >> result.levels) || result.levels > 4 ||
              (levels >> rest))
            throw UserError(place + ": \"" + item +
                            "\" must end in a number of levels from 0 to 4.");
          result.set = Utilities::trim(item.substr(0, colon));
          if (result.set.rfind("box ", 0) == 0)
            {
              const auto corners = parse_numbers(result.set.substr(4));
              if (!corners || corners->size() != 6)
                throw UserError(place + ": \"" + item +
                                "\" needs six coordinates [m] after \"box\".");
              for (unsigned int d = 0; d < 3; ++d)
                {
                  result.lower[d] = (*corners)[d];
                  result.upper[d] = (*corners)[3 + d];
                  if (result.lower[d] >= result.upper[d])
                    throw UserError(place + ": in \"" + item +
                                    "\" the second corner must lie above the "
                                    "first in " +
                                    "xyz"[d] + "; exchange the two.");
                }
              result.set.clear();
            }
          items.push_back(result);
        }
      return items;
    }
  } // namespace


  void
  GridParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Global refinement",
                      global_refinement,
                      "How many times each cell is cut into eight.",
                      Patterns::Integer(0, 6));
    prm.add_parameter(
      "Local refinement",
      local_refinement,
      "Further refinement where it is wanted, items separated by \";\": "
      "\"set: levels\" for a cell set, or \"box x0 y0 z0 x1 y1 z1: levels\" "
      "[m] for the cells whose centre lies in the box. Hanging nodes result.");
    prm.add_parameter(
      "Nodes per wavelength",
      nodes_per_wavelength,
      "Cells are refined, material by material, until the S waves of \"Highest "
      "frequency\" have so many nodes on their length; 8 are enough where "
      "amplitudes count, none leave the mesh as it is. Hanging nodes result, "
      "so that far rock may be given in cells as large as these waves allow.",
      Patterns::Double(0., 100.));
    prm.add_parameter("Highest frequency",
                      highest_frequency,
                      "The one that \"Nodes per wavelength\" is for [Hz].",
                      Patterns::Double(0.01, 1000.));
    add_option(prm,
               "Partition",
               partition,
               "How the cells are dealt to the ranks; the results are "
               "the same.");
  }


  double
  GridParameters::longest_edge(const double       s_wave_speed,
                               const unsigned int degree) const
  {
    return nodes_per_wavelength > 0. ?
             s_wave_speed * degree /
               (nodes_per_wavelength * highest_frequency) :
             std::numeric_limits<double>::infinity();
  }


  double
  longest_edge(const Triangulation<3>::cell_iterator &cell)
  {
    double longest = 0.;
    for (unsigned int line = 0; line < 12; ++line)
      longest = std::max(longest, cell->line(line)->diameter());
    return longest;
  }


  Grid::Grid(const CoarseMesh     &coarse,
             const GridParameters &parameters,
             const Materials      &materials,
             const MPI_Comm        communicator)
    : mpi_communicator(communicator)
    , faces_of_set(coarse.face_sets.size() + 1)
  {
    for (const auto &set : coarse.face_sets)
      face_sets.push_back(set.first);
    const auto cells = tagged_cells(coarse, materials.of_cell);
    if (parameters.partition == Partition::metis)
      create_metis(coarse, cells, parameters, materials);
    else
      create_p4est(coarse, cells, parameters, materials);
    find_faces(coarse);
  }


  Grid::Grid(const CoarseMesh     &coarse,
             const GridParameters &parameters,
             const MPI_Comm        communicator)
    : Grid(coarse,
           parameters,
           {std::vector<unsigned int>(coarse.cells.size(), 0),
            {1.},
            {std::numeric_limits<double>::infinity()}},
           communicator)
  {}


  std::vector<CellData<3>>
  Grid::tagged_cells(const CoarseMesh                &coarse,
                     const std::vector<unsigned int> &materials)
  {
    std::vector<std::vector<unsigned int>> sets_of_cell(coarse.cells.size());
    for (const auto &[name, cells] : coarse.cell_sets)
      {
        for (const unsigned int cell : cells)
          sets_of_cell[cell].push_back(cell_sets.size());
        cell_sets.push_back(name);
      }

    std::map<std::pair<unsigned int, std::vector<unsigned int>>, unsigned int>
                             number_of_tag;
    std::vector<CellData<3>> result(coarse.cells.size());
    for (std::size_t c = 0; c < result.size(); ++c)
      {
        const auto [tag, is_new] =
          number_of_tag.emplace(std::make_pair(materials[c], sets_of_cell[c]),
                                all_tags.size());
        if (is_new)
          all_tags.push_back({materials[c], sets_of_cell[c]});
        result[c].vertices.assign(coarse.cells[c].begin(),
                                  coarse.cells[c].end());
        result[c].material_id = tag->second;
      }
    return result;
  }


  void
  Grid::create_p4est(const CoarseMesh               &coarse,
                     const std::vector<CellData<3>> &cells,
                     const GridParameters           &parameters,
                     const Materials                &materials)
  {
    using Distributed = parallel::distributed::Triangulation<3>;
    auto triangulation =
      std::make_unique<Distributed>(mpi_communicator,
                                    dealii::Triangulation<3>::none,
                                    Distributed::no_automatic_repartitioning);
    triangulation->signals.weight.connect([&](const auto &cell,
                                              const auto) -> unsigned int {
      return static_cast<unsigned int>(1000. * materials.costs[material(cell)]);
    });
    triangulation->create_triangulation(coarse.vertices, cells, SubCellData());
    refine(*triangulation, parameters, materials);
    triangulation->repartition();
    triangulation->signals.weight.disconnect_all_slots();
    mesh = std::move(triangulation);
  }


  void
  Grid::create_metis(const CoarseMesh               &coarse,
                     const std::vector<CellData<3>> &cells,
                     const GridParameters           &parameters,
                     const Materials                &materials)
  {
    dealii::Triangulation<3> serial(
      dealii::Triangulation<3>::limit_level_difference_at_vertices);
    serial.create_triangulation(coarse.vertices, cells, SubCellData());
    refine(serial, parameters, materials);

    std::vector<unsigned int> weights;
    for (const auto &cell : serial.active_cell_iterators())
      weights.push_back(
        static_cast<unsigned int>(100. * materials.costs[material(cell)]));
    GridTools::partition_triangulation(Utilities::MPI::n_mpi_processes(
                                         mpi_communicator),
                                       weights,
                                       serial,
                                       SparsityTools::Partitioner::metis);
    const auto description = TriangulationDescription::Utilities::
      create_description_from_triangulation(serial, mpi_communicator);

    auto triangulation =
      std::make_unique<parallel::fullydistributed::Triangulation<3>>(
        mpi_communicator);
    triangulation->create_triangulation(description);
    mesh = std::move(triangulation);
  }


  void
  Grid::find_faces(const CoarseMesh &coarse)
  {
    // by coarse cell and face, the sets
    std::vector<std::array<std::vector<unsigned int>, 6>> sets(
      coarse.cells.size());
    unsigned int number = 0;
    for (const auto &set : coarse.face_sets)
      {
        for (const CoarseMesh::Face &face : set.second)
          if (auto &list = sets[face.cell][face.face];
              list.empty() || list.back() != number)
            list.push_back(number);
        ++number;
      }
    for (const auto &cell : mesh->active_cell_iterators())
      if (!cell->is_artificial())
        {
          const auto &sets_of_faces = sets[coarse_cell(cell)];
          const auto  path          = children_upwards(cell);
          for (const unsigned int face : cell->face_indices())
            if (!sets_of_faces[face].empty() && lies_on_coarse_face(path, face))
              for (const unsigned int set : sets_of_faces[face])
                faces_of_set[set].push_back({cell, face});
        }
  }


  void
  Grid::refine(dealii::Triangulation<3> &triangulation,
               const GridParameters     &parameters,
               const Materials          &materials) const
  {
    check_size(triangulation.n_cells(0) *
                 std::pow(8., parameters.global_refinement),
               1,
               "\"Global refinement\" in section \"Mesh\"",
               mpi_communicator);
    triangulation.refine_global(parameters.global_refinement);
    for (const LocalRefinement &item :
         parse_local_refinement(parameters.local_refinement))
      {
        if (!item.set.empty())
          check_cell_set(item.set, "\"Local refinement\" in section \"Mesh\"");
        const std::vector<bool> tagged = tags_in({item.set});
        for (unsigned int level = 0; level < item.levels; ++level)
          {
            for (const auto &cell : triangulation.active_cell_iterators())
              if (cell->is_locally_owned())
                {
                  bool inside = true;
                  if (!item.set.empty())
                    inside = tagged[cell->material_id()];
                  else
                    for (unsigned int d = 0; d < 3; ++d)
                      inside = inside && cell->center()[d] >= item.lower[d] &&
                               cell->center()[d] <= item.upper[d];
                  if (inside)
                    cell->set_refine_flag();
                }
            triangulation.execute_coarsening_and_refinement();
          }
      }
    while (refine_for_waves(triangulation, materials))
      {}
  }


  bool
  Grid::refine_for_waves(dealii::Triangulation<3> &triangulation,
                         const Materials          &materials) const
  {
    unsigned int flagged = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() &&
          longest_edge(cell) > materials.longest_edges[material(cell)])
        {
          cell->set_refine_flag();
          ++flagged;
        }
    // a serial triangulation is the same on all ranks
    if (dynamic_cast<const Triangulation *>(&triangulation) != nullptr)
      flagged = Utilities::MPI::sum(flagged, mpi_communicator);
    if (flagged == 0)
      return false;
    check_size(triangulation.n_global_active_cells() + 7. * flagged,
               1,
               "\"Nodes per wavelength\" in section \"Mesh\"",
               mpi_communicator);
    triangulation.execute_coarsening_and_refinement();
    return true;
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
    // the level keeps apart a cell and its own first child
    return (key << 4) + path.size();
  }
} // namespace Voussoir
