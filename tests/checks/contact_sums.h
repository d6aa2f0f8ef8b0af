#ifndef voussoir_tests_contact_sums_h
#define voussoir_tests_contact_sums_h

#include <voussoir/analysis/lost_equilibrium.h>
#include <voussoir/base/mpi.h>
#include <voussoir/output/interface_sums.h>

#include "check.h"

namespace Voussoir
{
  /** Resultant of the contact forces of a surface. */
  struct ContactSums
  {
    dealii::Tensor<1, 3> force;              // contact on the second side [N]
    double               pressure      = 0.; // sum of normal forces [N]
    double               given         = 0.; // of uplift and bars, apart [N]
    double               area          = 0.; // [m2]
    double               opening       = 0.; // mean [m]
    double               slip          = 0.; // mean of its size [m]
    double               bond_work     = 0.; // lost in the bond [J]
    double               friction_work = 0.; // lost in friction [J]
  };

  inline ContactSums
  contact_sums(const Simulation &simulation, const unsigned int surface)
  {
    const Contact      &contact = *simulation.run.contact;
    std::vector<double> sums(10);
    for (const ContactPoint &point : contact.points())
      if (point.surface == surface)
        {
          const dealii::Tensor<1, 3> force = point.force * point.frame;
          for (unsigned int d = 0; d < 3; ++d)
            sums[d] += force[d];
          sums[3] += point.force[0];
          sums[4] += point.given_force;
          sums[5] += point.area;
          sums[6] += point.area * point.gap[0];
          sums[7] += point.area * std::hypot(point.gap[1], point.gap[2]);
        }
    sums[8] = contact.surfaces()[surface].energy.bond;
    sums[9] = contact.surfaces()[surface].energy.friction;
    sums    = sum_over_ranks(sums, simulation.model.grid.communicator());
    return {dealii::Tensor<1, 3>({sums[0], sums[1], sums[2]}),
            sums[3],
            sums[4],
            sums[5],
            sums[6] / sums[5],
            sums[7] / sums[5],
            sums[8],
            sums[9]};
  }

  /** Displacement since the static state of the centre of all that moves. */
  inline dealii::Tensor<1, 3>
  mean_motion(const Simulation &simulation)
  {
    std::vector<double> sums(4);
    for (unsigned int node = 0;
         node < simulation.model.solid.discretization.n_owned_nodes();
         ++node)
      for (unsigned int d = 0; d < 3; ++d)
        {
          const unsigned int i = 3 * node + d;
          if (simulation.model.solid.mass.inverse.local_element(i) == 0.)
            continue;
          const double m = simulation.model.solid.mass.mass.local_element(i);
          double motion  = simulation.run.state.displacement.local_element(i);
          if (simulation.static_state.initial.displacement.size() > 0)
            motion -=
              simulation.static_state.initial.displacement.local_element(i);
          sums[d] += m * motion;
          sums[3] += m / 3.;
        }
    sums = sum_over_ranks(sums, simulation.model.grid.communicator());
    return dealii::Tensor<1, 3>(
      {sums[0] / sums[3], sums[1] / sums[3], sums[2] / sums[3]});
  }

  /** Whether a case has a static state. */
  inline bool
  stands(const ParameterFile &file, const MPI_Comm communicator)
  {
    const auto parameters = make_case(file);
    try
      {
        make_simulation(*parameters, communicator);
      }
    catch (const LostEquilibrium &)
      {
        return false;
      }
    return true;
  }

  /** Safety of a block in its static state, as the observer "interfaces"
   *  reports it; @p block as its entry has it. */
  inline double
  block_safety(const Simulation &simulation, const std::string &block)
  {
    const Contact &contact = *simulation.run.contact;
    const auto     blocks =
      find_sliding_blocks(block, "\"Blocks\"", simulation.model.solid, contact);
    std::vector<double> sums(InterfaceSum::n_quantities *
                             contact.surfaces().size()),
      areas(contact.surfaces().size());
    for (const ContactPoint &point : contact.points())
      {
        add_to_sums(point, &sums[InterfaceSum::n_quantities * point.surface]);
        areas[point.surface] += point.area;
      }
    const MPI_Comm communicator = simulation.model.grid.communicator();
    sums                        = sum_over_ranks(sums, communicator);
    areas                       = sum_over_ranks(areas, communicator);
    return safety_from_sums(blocks[0], sums.data(), areas, {});
  }

  /** The number that a file gives for an entry. */
  inline double
  number_in(const ParameterFile &file, const std::string &path)
  {
    return std::stod(file.given(path));
  }

  /** An entry with a vector. */
  inline std::string
  vector_entry(const std::string &name, const dealii::Tensor<1, 3> &value)
  {
    std::ostringstream text;
    text.precision(17);
    text << name << '=' << value[0] << ", " << value[1] << ", " << value[2];
    return text.str();
  }
} // namespace Voussoir

#endif
