#include <voussoir/analysis/point_stresses.h>
#include <voussoir/base/mpi.h>
#include <voussoir/materials/principal_stress.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  PointStresses::PointStresses(const Discretization          &discretization,
                               const std::vector<NamedPoint> &points,
                               const std::vector<const FaceMesh *> &faces)
    : points(points)
    , found(points.size())
  {
    std::vector<unsigned int> mine;
    for (const FaceMesh *face : faces)
      for (const StressPoints::Place &place : face->places())
        mine.push_back(discretization.grid.material(place.cell));
    std::sort(mine.begin(), mine.end());
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    const auto all = join_over_ranks(mine, discretization.grid.communicator());
    find_places(discretization, {all.begin(), all.end()});
    find_directions(faces);
  }


  void
  PointStresses::find_places(const Discretization         &discretization,
                             const std::set<unsigned int> &materials_of_faces)
  {
    // 1 if the material has no faces, else 0; and the material
    using Rank = std::array<unsigned int, 2>;
    struct Candidate
    {
      unsigned int        point;
      StressPoints::Place place;
      Rank                rank;
    };
    const MPI_Comm         communicator = discretization.grid.communicator();
    const Rank             none{{1, numbers::invalid_unsigned_int}};
    std::vector<Candidate> candidates;
    std::vector<Rank>      best(points.size(), none);
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int p = 0; p < points.size(); ++p)
          if (const auto unit =
                unit_place(discretization, cell, points[p].position))
            {
              const unsigned int material = discretization.grid.material(cell);
              const Rank         rank{
                {materials_of_faces.count(material) == 0, material}};
              candidates.push_back({p, {cell, *unit}, rank});
              best[p] = std::min(best[p], rank);
            }
    for (const auto &others : Utilities::MPI::all_gather(communicator, best))
      for (unsigned int p = 0; p < points.size(); ++p)
        best[p] = std::min(best[p], others[p]);

    std::vector<double> n_places(points.size());
    for (const Candidate &candidate : candidates)
      if (candidate.rank == best[candidate.point])
        {
          places.push_back(candidate.place);
          point_of_place.push_back(candidate.point);
          n_places[candidate.point] += 1.;
        }
    n_places = sum_over_ranks(n_places, communicator);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        found[p].n_places       = n_places[p];
        found[p].has_directions = best[p][0] == 0;
      }
  }


  void
  PointStresses::find_directions(const std::vector<const FaceMesh *> &faces)
  {
    if (faces.empty())
      return;
    // distance, arch and cantilever of the nearest node
    using Nearest = std::array<double, 7>;
    std::vector<Nearest> nearest(points.size(),
                                 Nearest{{std::numeric_limits<double>::max()}});
    for (const FaceMesh *face : faces)
      for (unsigned int node = 0; node < face->n_nodes(); ++node)
        for (unsigned int p = 0; p < points.size(); ++p)
          if (const double distance =
                points[p].position.distance(face->position(node));
              distance < nearest[p][0])
            {
              const auto [arch, cantilever] = face->arch_and_cantilever(node);
              nearest[p]                    = {{distance,
                                                arch[0],
                                                arch[1],
                                                arch[2],
                                                cantilever[0],
                                                cantilever[1],
                                                cantilever[2]}};
            }
    for (const auto &others :
         Utilities::MPI::all_gather(faces[0]->communicator(), nearest))
      for (unsigned int p = 0; p < points.size(); ++p)
        nearest[p] = std::min(nearest[p], others[p]);
    for (unsigned int p = 0; p < points.size(); ++p)
      for (unsigned int d = 0; d < 3; ++d)
        {
          found[p].arch[d]       = nearest[p][1 + d];
          found[p].cantilever[d] = nearest[p][4 + d];
        }
  }


  void
  PointStresses::describe(const StressModel &model,
                          nlohmann::json    &report) const
  {
    State state;
    state.displacement = model.initial.displacement;
    state.velocity.reinit(state.displacement);
    StressPoints sums(model, places, point_of_place, points.size());

    std::vector<double> components;
    for (const SymmetricTensor<2, 3> &sum : sums.evaluate(state))
      for (unsigned int c = 0; c < 6; ++c)
        components.push_back(sum.access_raw_entry(c));
    components =
      sum_over_ranks(components, model.discretization.grid.communicator());
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        SymmetricTensor<2, 3> stress; // [MPa]
        for (unsigned int c = 0; c < 6; ++c)
          stress.access_raw_entry(c) =
            1e-6 * components[6 * p + c] / found[p].n_places;
        nlohmann::json &point          = report[points[p].name];
        const auto [largest, smallest] = largest_and_smallest_principal(stress);
        point["largest principal stress [MPa]"]  = largest;
        point["smallest principal stress [MPa]"] = smallest;
        if (found[p].has_directions)
          {
            const auto &[n, has, arch, cantilever] = found[p];
            point["arch stress [MPa]"]             = arch * (stress * arch);
            point["cantilever stress [MPa]"] =
              cantilever * (stress * cantilever);
          }
      }
  }
} // namespace Voussoir
