#include <voussoir/output/face_mesh.h>
#include <voussoir/output/interface_faces.h>

#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_envelopes = 4;
    using PointEnvelopes               = std::array<double, n_envelopes>;


    PointEnvelopes
    envelopes_of(const ContactPoint &point, const InterfaceExtremes &extremes)
    {
      double state = 0.; // a place in ResultNames::interface_states()
      if (point.status == ContactStatus::sliding)
        state = 1.;
      if (point.status == ContactStatus::open)
        state = 2.;
      return {{1e3 * extremes[0],
               1e3 * extremes[1],
               1e3 * std::hypot(point.gap[1], point.gap[2]),
               state}};
    }
  } // namespace


  std::vector<NearestContactPoint>
  find_contact_points(const Contact                 &contact,
                      const std::vector<NamedPoint> &places,
                      const MPI_Comm                 communicator)
  {
    // distance, rounded to micrometres so that round-off does not decide,
    // position, surface, rank, number
    using Candidate         = std::tuple<double,
                                 double,
                                 double,
                                 double,
                                 unsigned int,
                                 unsigned int,
                                 unsigned int>;
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);

    std::vector<NearestContactPoint> result;
    for (const NamedPoint &place : places)
      {
        Candidate nearest(
          std::numeric_limits<double>::max(), 0., 0., 0., 0, rank, 0);
        for (unsigned int k = 0; k < contact.points().size(); ++k)
          {
            const Point<3> &x = contact.positions()[k];
            nearest =
              std::min(nearest,
                       Candidate(std::round(1e6 * x.distance(place.position)),
                                 x[0],
                                 x[1],
                                 x[2],
                                 contact.points()[k].surface,
                                 rank,
                                 k));
          }
        const auto candidates =
          Utilities::MPI::all_gather(communicator, nearest);
        const auto [distance, x, y, z, surface, owner, number] =
          *std::min_element(candidates.begin(), candidates.end());
        result.push_back(
          {place.name, {x, y, z}, surface, owner == rank, number});
      }
    return result;
  }


  void
  write_interface_envelopes(const ObservedRun                    &run,
                            const std::vector<InterfaceExtremes> &extremes,
                            const double                          time)
  {
    const Contact        &contact        = *run.contact;
    const Discretization &discretization = run.solid.discretization;
    const FaceMesh        mesh(discretization,
                        contact.surface_names(),
                        "\"Interfaces\"",
                        "interface",
                        run.names.interfaces);

    // from the ranks of the points to the owners of the nodes
    struct Record
    {
      unsigned int   surface;
      PointEnvelopes values;
    };
    std::vector<std::pair<types::global_dof_index, Record>> records;
    for (unsigned int k = 0; k < contact.points().size(); ++k)
      records.emplace_back(contact.first_nodes()[k],
                           Record{contact.points()[k].surface,
                                  envelopes_of(contact.points()[k],
                                               extremes[k])});
    const auto arrived = discretization.send_to_owners(records);

    // and from there to each rank with a face at the node
    const auto         &nodes = mesh.sets_and_nodes();
    std::vector<double> values(n_envelopes * nodes.size());
    Vector              known(discretization.owned_dofs,
                 discretization.relevant_dofs,
                 discretization.grid.communicator());
    for (unsigned int s = 0; s < contact.surface_names().size(); ++s)
      for (unsigned int e = 0; e < n_envelopes; ++e)
        {
          known.zero_out_ghost_values();
          known = 0.;
          for (const auto &[node, record] : arrived)
            if (record.surface == s)
              known.local_element(3 * node) =
                std::max(known.local_element(3 * node), record.values[e]);
          known.update_ghost_values();
          const bool is_state = e + 1 == n_envelopes;
          for (unsigned int i = 0; i < nodes.size(); ++i)
            if (nodes[i].first == s)
              for (const auto &[node, weight] :
                   discretization.carriers(nodes[i].second))
                {
                  double &value = values[n_envelopes * i + e];
                  value         = is_state ? std::max(value, known(3 * node)) :
                                             value + weight * known(3 * node);
                }
        }
    mesh.write(
      run,
      {"largest_opening_mm", "largest_slip_mm", "residual_slip_mm", "state"},
      values,
      "interface_envelopes",
      time,
      {{"state_names", ResultNames::interface_states()}});
  }
} // namespace Voussoir
