#include <voussoir/base/mpi.h>
#include <voussoir/constraints/static_contact.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Tensor<2, 3>
    in_global_axes(const Tensor<2, 3> &in_frame, const Tensor<2, 3> &frame)
    {
      return transpose(frame) * in_frame * frame;
    }


    /**
     * Limits whose cohesion grows from none with the pressure of a spring on
     * the gap @p b. A shear that jumps by all of it as a point closes leaves no
     * equilibrium where a part of it holds the point closed; within the law,
     * which allows more shear, this finds one.
     */
    ContactLimits
    without_jump(const ContactLimits &limits,
                 const Tensor<1, 3>  &b,
                 const double         spring)
    {
      constexpr double cohesion_per_pressure = 10.;

      ContactLimits result   = limits;
      const double  pressure = -spring * b[0];
      result.cohesion =
        std::min(limits.cohesion,
                 cohesion_per_pressure *
                   std::max(pressure - limits.opening_force(), 0.));
      return result;
    }


    /** Minus the derivative of the force by the gap @p b, under which the force
     *  of the law has been found, for this spring. */
    Tensor<2, 3>
    tangent_of(const ContactForce  &found,
               const Tensor<1, 3>  &b,
               const ContactLimits &limits,
               const double         spring)
    {
      const bool   open = found.status == ContactStatus::open;
      Tensor<2, 3> tangent;
      if (!open)
        tangent[0][0] = spring;
      else if (found.force[0] < 0. && limits.opening > 0. &&
               found.force[0] > -limits.tension) // an opened bond
        tangent[0][0] = 1. / (limits.opening / limits.tension + 1. / spring);

      const double slip  = std::sqrt(b[1] * b[1] + b[2] * b[2]),
                   limit = limits.shear(open, found.force[0]);
      if (spring * slip <= limit)
        {
          if (limit > 0.)
            tangent[1][1] = tangent[2][2] = spring;
        }
      else
        for (unsigned int d = 1; d < 3; ++d)
          for (unsigned int e = 1; e < 3; ++e)
            tangent[d][e] =
              limit / slip * ((d == e ? 1. : 0.) - b[d] * b[e] / (slip * slip));
      return tangent;
    }
  } // namespace


  StaticContact::StaticContact(Contact &contact, const Vector &stiffness)
    : contact(contact)
    , multiplier(contact.points().size())
    , tangent(multiplier.size())
    , path(multiplier.size())
    , at_nodes(contact.solver->n_nodes())
    , forces(at_nodes.size())
    , at_owned(contact.nodes().size())
    , held(at_nodes.size())
  {
    contact.exchange->to_clusters(stiffness, at_nodes);
    for (unsigned int i = 0; i < at_nodes.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        held[i][d] = at_nodes[i][d] == 0.;
    for (unsigned int k = 0; k < multiplier.size(); ++k)
      {
        const ContactPoint &point = contact.points()[k];
        const double first   = at_nodes[point.first].norm() / std::sqrt(3.),
                     second  = at_nodes[point.second].norm() / std::sqrt(3.);
        const double stiffer = std::max(first, second);
        // held on both sides nothing depends on it
        spring.push_back(stiffer == 0.               ? 1. :
                         first == 0. || second == 0. ? stiffer :
                                                       std::min(first, second));
      }
  }


  void
  StaticContact::start_stage()
  {
    before = contact.points();
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        multiplier[k] = before[k].force;
        path[k]       = before[k].history.slip;
      }
  }


  void
  StaticContact::find_gaps(const Vector &displacement)
  {
    contact.exchange->to_clusters(displacement, at_nodes);
    contact.solver->find_gaps(at_nodes);
  }


  void
  StaticContact::respond(Vector &force, const Vector &displacement)
  {
    find_gaps(displacement);
    std::fill(forces.begin(), forces.end(), Tensor<1, 3>());
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        ContactPoint &point = contact.solver->points[k];
        Tensor<1, 3>  b     = point.gap - multiplier[k] / spring[k];
        b[1] -= point.stick_point[0];
        b[2] -= point.stick_point[1];
        const ContactLimits limits = without_jump(point.limits, b, spring[k]);
        const ContactForce  found  = solve_contact(b, 1. / spring[k], limits);
        point.force                = found.force;
        point.status               = found.status;

        Tensor<2, 3> in_frame = tangent_of(found, b, limits, spring[k]);
        in_frame[0][0] +=
          point.area * contact.solver->surfaces[point.surface].bar_stiffness;
        tangent[k] = in_global_axes(in_frame, point.frame);

        const Tensor<1, 3> total = ContactSolver::total_force(point);
        forces[point.second] += total;
        forces[point.first] -= total;
      }
    add_forces(force);
  }


  void
  StaticContact::stiffen(const double share)
  {
    for (unsigned int k = 0; k < spring.size(); ++k)
      if (contact.is_joined(contact.points()[k]))
        tangent[k] =
          (1. - share) * tangent[k] +
          share * spring[k] * Tensor<2, 3>(unit_symmetric_tensor<3>());
  }


  void
  StaticContact::tie(const Vector &displacement)
  {
    find_gaps(displacement);
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        const ContactPoint &point = contact.points()[k];
        tangent[k]                = Tensor<2, 3>();
        if (contact.touches(point))
          tangent[k] = spring[k] * Tensor<2, 3>(unit_symmetric_tensor<3>());
      }
  }


  void
  StaticContact::add_tangent(Vector &force, const Vector &displacement) const
  {
    contact.exchange->to_clusters(displacement, at_nodes);
    std::fill(forces.begin(), forces.end(), Tensor<1, 3>());
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        const ContactPoint &point = contact.points()[k];
        const Tensor<1, 3>  f =
          tangent[k] * (at_nodes[point.second] - at_nodes[point.first]);
        forces[point.second] += f;
        forces[point.first] -= f;
      }
    add_forces(force);
  }


  void
  StaticContact::add_forces(Vector &force) const
  {
    contact.exchange->to_owners(forces, at_owned);
    contact.exchange->add(force, 1., at_owned);
  }


  std::vector<StaticContact::Pair>
  StaticContact::pairs() const
  {
    std::vector<Pair> result;
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        const ContactPoint &point = contact.points()[k];
        result.push_back({contact.global_nodes[point.first],
                          contact.global_nodes[point.second],
                          tangent[k],
                          held[point.first],
                          held[point.second]});
      }
    return result;
  }


  StaticContact::Change
  StaticContact::update()
  {
    Change                    change;
    double                    changed = 0., whole = 0.;
    std::vector<unsigned int> number(4);
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        ContactPoint &point = contact.solver->points[k];
        changed += (point.force - multiplier[k]).norm_square();
        whole += point.force.norm_square();
        multiplier[k] = point.force;

        const bool          open   = point.status == ContactStatus::open;
        const ContactLimits limits = point.limits;
        const Tensor<1, 2>  slip({point.gap[1] - point.stick_point[0],
                                  point.gap[2] - point.stick_point[1]});
        if (open)
          point.history.opening = std::max(point.history.opening, point.gap[0]);
        if (point.status != ContactStatus::sticking && !limits.locked &&
            (!open || limits.bond > 0.))
          point.history.slip =
            std::max(point.history.slip, path[k] + slip.norm());
        contact.solver->yield_bars(point);
        contact.solver->update_limits(point);

        number[0] += limits.bond != point.limits.bond ||
                     limits.tension != point.limits.tension ||
                     limits.cohesion != point.limits.cohesion ||
                     limits.locked != point.limits.locked;
        number[1] += open;
        number[2] += point.status == ContactStatus::sliding;
        number[3] += 1;
      }
    const MPI_Comm communicator = contact.communicator;
    const auto     sums =
      sum_over_ranks(std::vector<double>{changed, whole}, communicator);
    change.force  = sums[1] > 0. ? std::sqrt(sums[0] / sums[1]) : 0.;
    number        = sum_over_ranks(number, communicator);
    change.broken = number[0];
    change.open   = number[1];
    change.slide  = number[2];
    change.all    = number[3];
    return change;
  }


  void
  StaticContact::finish_stage()
  {
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        ContactPoint &point = contact.solver->points[k];
        if (point.status != ContactStatus::sticking && !point.limits.locked)
          {
            point.stick_point[0] = point.gap[1];
            point.stick_point[1] = point.gap[2];
          }
      }
  }


  void
  StaticContact::restore()
  {
    contact.solver->points = before;
  }
} // namespace Voussoir
