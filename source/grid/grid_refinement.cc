#include <voussoir/base/box_of_ranks.h>
#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/grid/chart_vertices.h>
#include <voussoir/grid/coarse_faces.h>
#include <voussoir/grid/refine_where.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Places = std::vector<Point<3>>; // of the vertices


    // A serial triangulation is on one rank.
    MPI_Comm
    communicator_of(const Triangulation<3> &triangulation)
    {
      const auto *distributed =
        dynamic_cast<const Grid::Triangulation *>(&triangulation);
      return distributed == nullptr ? MPI_COMM_SELF :
                                      distributed->get_communicator();
    }


    CellFrame
    frame_of(const Grid::ActiveCell &cell, const Places &places)
    {
      return Voussoir::frame_of(
        [&](const unsigned int v) { return places[cell->vertex_index(v)]; });
    }


    double
    longest_edge(const Grid::ActiveCell &cell, const Places &places)
    {
      double longest = 0.;
      for (const unsigned int line : cell->line_indices())
        longest = std::max(longest,
                           places[cell->line(line)->vertex_index(0)].distance(
                             places[cell->line(line)->vertex_index(1)]));
      return longest;
    }


    /** A face by its centre. */
    struct FacePlace
    {
      FacePlace(const Grid::Cell  &cell,
                const unsigned int face,
                const Places      &places)
      {
        std::array<Point<3>, 4> corners;
        for (unsigned int i = 0; i < 4; ++i)
          {
            corners[i] = places[cell->vertex_index(
              GeometryInfo<3>::face_to_cell_vertices(face, i))];
            centre += 0.25 * corners[i];
          }
        size = corners[0].distance(corners[3]);
      }

      Point<3> centre;
      double   size = 0.;
    };


    /** The faces of a mesh on interfaces, from both sides. */
    CoarseFaces
    faces_on_interfaces(const CoarseMesh &coarse)
    {
      CoarseFaces faces;
      for (const auto &[name, set] : coarse.face_sets)
        if (const auto other = coarse.face_sets.find(name + other_side);
            other != coarse.face_sets.end())
          for (const auto *side : {&set, &other->second})
            for (const CoarseMesh::Face &face : *side)
              faces.add(face, 0);
      return faces;
    }


    /** Places on all ranks. */
    class PlacesOfRanks
    {
    public:
      PlacesOfRanks(const Places &own, const MPI_Comm communicator)
      {
        std::vector<std::array<double, 3>> numbers;
        for (const Point<3> &x : own)
          numbers.push_back({{x[0], x[1], x[2]}});
        Places all;
        for (const auto &x : join_over_ranks(numbers, communicator))
          all.emplace_back(x[0], x[1], x[2]);
        tree = pack_rtree(all);
      }

      /** Whether @p place is one of them, but for round-off.
       *  @param size of the face or edge there */
      bool
      contain(const Point<3> &place, const double size) const
      {
        Places nearest;
        tree.query(boost::geometry::index::nearest(place, 1),
                   std::back_inserter(nearest));
        return !nearest.empty() && nearest[0].distance(place) < 1e-6 * size;
      }

    private:
      RTree<Point<3>> tree;
    };


    /** Flags own cells whose face on an interface has been refined on its other
     *  side; returns whether there are any. */
    bool
    flag_partners(Triangulation<3>  &triangulation,
                  const Places      &places,
                  const CoarseFaces &on_interfaces)
    {
      const MPI_Comm communicator = communicator_of(triangulation);
      std::vector<std::pair<Grid::ActiveCell, FacePlace>> whole;
      Places                                              refined;
      on_interfaces.for_each(
        triangulation,
        [&](const Grid::ActiveCell &cell,
            const unsigned int      face,
            const unsigned int) {
          if (!cell->is_locally_owned())
            return;
          whole.emplace_back(cell, FacePlace(cell, face, places));
          if (cell->level() > 0)
            refined.push_back(FacePlace(cell->parent(), face, places).centre);
        });
      const PlacesOfRanks all_refined(refined, communicator);
      unsigned int        flagged = 0;
      for (const auto &[cell, face] : whole)
        if (all_refined.contain(face.centre, face.size))
          {
            cell->set_refine_flag();
            ++flagged;
          }
      return Utilities::MPI::sum(flagged, communicator) > 0;
    }


    /** Flags own cells that have an undivided edge on an interface all of whose
     *  cells on another side are refined, so that its middle would hang on one
     *  side only: coarse rock beside the foot of a refined dam, for example.
     *  Returns whether there are any. */
    bool
    flag_one_sided_edges(Triangulation<3>  &triangulation,
                         const Places      &places,
                         const CoarseFaces &on_interfaces)
    {
      const MPI_Comm communicator = communicator_of(triangulation);
      const auto     middle       = [&](const auto &line) {
        return places[line->vertex_index(0)] +
               0.5 * (places[line->vertex_index(1)] -
                      places[line->vertex_index(0)]);
      };
      // each side has its own vertices, and so its own edges
      std::set<unsigned int> undivided;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int line : cell->line_indices())
            if (cell->line(line)->has_children())
              undivided.insert(cell->line_index(line));

      Places divided;
      on_interfaces.for_each(
        triangulation,
        [&](const Grid::ActiveCell &cell,
            const unsigned int      face,
            const unsigned int) {
          if (!cell->is_locally_owned() || cell->level() == 0)
            return;
          const auto         parent = cell->parent();
          const unsigned int corner =
            parent->vertex_index(children_upwards(cell).front());
          for (const unsigned int i : parent->face(face)->line_indices())
            if (const auto line = parent->face(face)->line(i);
                (line->vertex_index(0) == corner ||
                 line->vertex_index(1) == corner) &&
                undivided.count(line->index()) == 0)
              divided.push_back(middle(line));
        });
      const PlacesOfRanks all_divided(divided, communicator);
      unsigned int        flagged = 0;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int i : cell->line_indices())
            if (const auto line = cell->line(i);
                line->has_children() &&
                all_divided.contain(middle(line), line->diameter()))
              {
                cell->set_refine_flag();
                ++flagged;
                break;
              }
      return Utilities::MPI::sum(flagged, communicator) > 0;
    }


    /** Flags own cells that must follow the refinement of others, so that both
     *  sides of an interface have the same faces and hanging nodes; returns
     *  whether there are any. */
    bool
    flag_followers(Triangulation<3>        &triangulation,
                   const CoarseMesh::Chart &chart,
                   const CoarseFaces       &on_interfaces)
    {
      if (on_interfaces.empty())
        return false;
      const Places places = positions(triangulation, chart);
      return flag_partners(triangulation, places, on_interfaces) ||
             flag_one_sided_edges(triangulation, places, on_interfaces);
    }
  } // namespace


  RefinementSummary
  Grid::refine(dealii::Triangulation<3> &triangulation,
               const CoarseMesh         &coarse,
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
    const std::string place = "\"Local refinement\" in section \"Mesh\"";
    for (const LocalRefinement &item : parameters.local_refinements())
      {
        const std::vector<bool> tagged = tags_in({item.set});
        for (unsigned int level = 0; level < item.levels; ++level)
          {
            const Places places    = item.set.empty() ?
                                       positions(triangulation, coarse.chart) :
                                       Places();
            const auto   is_inside = [&](const ActiveCell &cell) {
              if (!item.set.empty())
                return bool(tagged[cell->material_id()]);
              return BoundingBox<3>({item.lower, item.upper})
                .point_inside(frame_of(cell, places).centre);
            };
            if (!refine_cells(
                  triangulation, coarse, is_inside, place, machines))
              throw UserError(place +
                              " names a box in which no cell has its centre; "
                              "make it larger, or leave it out.");
          }
      }
    while (refine_for_waves(triangulation, coarse, materials, machines))
      {}
    return parameters.refine_where.wanted() ?
             refine_where(triangulation,
                          coarse,
                          parameters.refine_where,
                          materials,
                          machines) :
             RefinementSummary();
  }


  bool
  Grid::refine_cells(dealii::Triangulation<3> &triangulation,
                     const CoarseMesh         &coarse,
                     const ActiveCells        &are_wanted,
                     const std::string        &place,
                     const double              machines) const
  {
    unsigned int flagged = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && are_wanted(cell))
        {
          cell->set_refine_flag();
          ++flagged;
        }
    flagged = Utilities::MPI::sum(flagged, communicator_of(triangulation));
    if (flagged == 0)
      return false;
    check_size(triangulation.n_global_active_cells() + 7. * flagged,
               1,
               place,
               machines);
    const CoarseFaces on_interfaces = faces_on_interfaces(coarse);
    do
      triangulation.execute_coarsening_and_refinement();
    while (flag_followers(triangulation, coarse.chart, on_interfaces));
    return true;
  }


  bool
  Grid::refine_for_waves(dealii::Triangulation<3> &triangulation,
                         const CoarseMesh         &coarse,
                         const Materials          &materials,
                         const double              machines) const
  {
    if (std::all_of(materials.longest_edges.begin(),
                    materials.longest_edges.end(),
                    [](const double edge) { return std::isinf(edge); }))
      return false;
    const Places places = positions(triangulation, coarse.chart);
    return refine_cells(
      triangulation,
      coarse,
      [&](const ActiveCell &cell) {
        return longest_edge(cell, places) >
               materials.longest_edges[material(cell)];
      },
      "\"Nodes per wavelength\" in section \"Mesh\"",
      machines);
  }


  RefinementSummary
  Grid::refine_where(dealii::Triangulation<3>    &triangulation,
                     const CoarseMesh            &coarse,
                     const RefineWhereParameters &parameters,
                     const Materials             &materials,
                     const double                 machines) const
  {
    const MPI_Comm          communicator = communicator_of(triangulation);
    const auto              sets         = split_list(parameters.cell_sets);
    const std::vector<bool> tagged       = tags_in(sets);
    const auto              is_named     = parameters.place();

    // of the current cells
    Places     places;
    const auto is_in_place = [&](const ActiveCell &cell) {
      return (sets.empty() || tagged[cell->material_id()]) &&
             is_named(frame_of(cell, places).centre);
    };
    const auto may_crack = [&](const ActiveCell &cell) {
      return !std::isinf(materials.crack_edges[material(cell)]) &&
             is_in_place(cell) &&
             (!materials.stressed ||
              materials.stressed->reach(frame_of(cell, places)));
    };
    const auto is_too_long = [&](const ActiveCell &cell) {
      return longest_edge(cell, places) > materials.crack_edges[material(cell)];
    };

    RefinementSummary summary;
    BoxOfRanks        box;
    summary.before       = triangulation.n_global_active_cells();
    places               = positions(triangulation, coarse.chart);
    unsigned int n_named = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          n_named += is_in_place(cell) ? 1 : 0;
          if (!may_crack(cell))
            continue;
          ++summary.chosen;
          for (const unsigned int v : cell->vertex_indices())
            box.add(places[cell->vertex_index(v)]);
        }
    if (Utilities::MPI::sum(n_named, communicator) == 0)
      throw UserError("\"Expression\" in section \"Mesh/Refine where\" is \"" +
                      parameters.expression +
                      "\", which is positive at the centre of no cell" +
                      (sets.empty() ? "" : " of its \"Cell sets\"") +
                      "; correct it, or leave it out.");
    summary.chosen = Utilities::MPI::sum(summary.chosen, communicator);
    box.join(communicator);
    summary.lower = box.lower;
    summary.upper = box.upper;

    for (unsigned int level = 0;
         level < parameters.levels && refine_cells(
                                        triangulation,
                                        coarse,
                                        [&](const ActiveCell &cell) {
                                          return is_too_long(cell) &&
                                                 may_crack(cell);
                                        },
                                        "Section \"Mesh/Refine where\"",
                                        machines);
         ++level)
      places = positions(triangulation, coarse.chart);

    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && may_crack(cell))
        {
          ++summary.fine;
          summary.too_long += is_too_long(cell) ? 1 : 0;
          summary.longest =
            std::max(summary.longest, longest_edge(cell, places));
        }
    summary.fine     = Utilities::MPI::sum(summary.fine, communicator);
    summary.too_long = Utilities::MPI::sum(summary.too_long, communicator);
    summary.longest  = Utilities::MPI::max(summary.longest, communicator);
    summary.after    = triangulation.n_global_active_cells();
    return summary;
  }
} // namespace Voussoir
