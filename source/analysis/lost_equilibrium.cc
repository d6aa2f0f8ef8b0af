#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/nodal_values.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The sets of the first cell of this rank with this node. */
    std::vector<std::string>
    sets_at(const Discretization         &discretization,
            const types::global_dof_index node)
    {
      for (const auto &cell :
           discretization.dof_handler.active_cell_iterators())
        {
          if (!cell->is_locally_owned())
            continue;
          const auto nodes = discretization.cell_nodes(cell);
          if (std::find(nodes.begin(), nodes.end(), node) != nodes.end())
            return discretization.grid.sets_of(cell);
        }
      return {};
    }


    /** Where the amount is largest, and in which sets. */
    std::string
    place_of_largest(const Discretization &discretization, const Vector &vector)
    {
      const unsigned int n_nodes = vector.locally_owned_size() / 3;
      unsigned int       place   = 0;
      double             largest = -1.;
      for (unsigned int node = 0; node < n_nodes; ++node)
        if (const double amount = node_value(vector, node).norm();
            amount > largest)
          {
            largest = amount;
            place   = node;
          }
      std::ostringstream text;
      if (n_nodes > 0)
        text << std::setprecision(4) << "("
             << discretization.node_positions[place] << ") m in "
             << join(sets_at(discretization,
                             discretization.owned_dofs.nth_index_in_set(3 *
                                                                        place) /
                               3),
                     ", ");
      const auto all =
        Utilities::MPI::all_gather(discretization.grid.communicator(),
                                   std::make_pair(largest, text.str()));
      return std::max_element(all.begin(), all.end())->second;
    }


    /** The surfaces none of whose points sticks. */
    std::vector<std::string>
    non_sticking_surfaces(const Contact &contact, const MPI_Comm communicator)
    {
      const unsigned int        n = contact.surface_names().size();
      std::vector<unsigned int> sticking(n);
      std::vector<double>       opening(n), slip(n);
      for (const ContactPoint &point : contact.points())
        {
          const unsigned int s = point.surface;
          sticking[s] +=
            !point.joined || point.status == ContactStatus::sticking;
          opening[s] = std::max(opening[s], point.gap[0]);
          slip[s] = std::max(slip[s], std::hypot(point.gap[1], point.gap[2]));
        }
      sticking = sum_over_ranks(sticking, communicator);
      Utilities::MPI::max(opening, communicator, opening);
      Utilities::MPI::max(slip, communicator, slip);
      std::vector<std::string> result;
      for (unsigned int s = 0; s < n; ++s)
        if (sticking[s] == 0)
          {
            std::ostringstream text;
            text << std::setprecision(3) << '"' << contact.surface_names()[s]
                 << "\" (open by up to " << opening[s] << " m, slipped by "
                 << slip[s] << " m)";
            result.push_back(text.str());
          }
      return result;
    }
  } // namespace


  LostEquilibrium::LostEquilibrium(const std::string &what,
                                   const Vector      &before,
                                   const Vector      &moved)
    : RunStopped(what)
    , before(before)
    , moved(moved)
  {}


  std::string
  description_of_motion(const Discretization &discretization,
                        const Contact        *contact,
                        const Vector         &before,
                        const Vector         &moved,
                        const bool            cracks)
  {
    Vector change = moved;
    change -= before;
    std::ostringstream text;
    text << std::setprecision(3) << "the point at "
         << place_of_largest(discretization, change) << " has moved by "
         << largest_amount(change) << " m";
    if (contact != nullptr)
      if (const auto sliding =
            non_sticking_surfaces(*contact, discretization.grid.communicator());
          !sliding.empty())
        text << ", nothing sticks on " << join(sliding, ", ");
    if (cracks)
      text << ", materials crack or yield";
    return text.str();
  }
} // namespace Voussoir
