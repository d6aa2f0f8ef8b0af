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


    // Shear per pressure with which a point that closes regains cohesion; and
    // the factor on the way from one multiplier to the next, of cohesion and of
    // openings.
    constexpr double cohesion_per_pressure = 10., over_relaxation = 10.;


    /** Excess of the force of a spring at the gap @p b over the force at which
     *  the point opens. */
    double
    closing_force(const ContactLimits &limits,
                  const Tensor<1, 3>  &b,
                  const double         spring)
    {
      return -spring * b[0] - limits.opening_force();
    }


    /**
     * Limits with the part of the cohesion c that acts. The full cohesion acts
     * under pressure, none across an opening, and any part between where a
     * point just touches. If the shear jumped by the full cohesion as a point
     * closes, there would be no equilibrium in which a part of the cohesion
     * keeps the point closed. That part is a multiplier k of its own, min(max(k
     * + 10 (p - r g), 0), c).
     */
    ContactLimits
    with_part_of_cohesion(const ContactLimits &limits,
                          const double         multiplier,
                          const double         closing)
    {
      ContactLimits result = limits;
      result.lasting       = 0.; // friction has followed the static pressure
      result.at_once       = 1.;
      result.cohesion = std::clamp(multiplier + cohesion_per_pressure * closing,
                                   0.,
                                   limits.cohesion);
      if (closing < 0.) // bonds act across any gap
        {
          result.bond += result.cohesion;
          result.cohesion = 0.;
        }
      return result;
    }


    /** Whether a limit has changed from one multiplier to the next. */
    bool
    differ(const double one, const double other)
    {
      return std::abs(one - other) > 1e-6 * std::max(one, other);
    }


    /** Minus the derivative of the force by the gap @p b for this spring, given
     *  the force of the law at this gap. */
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


  StaticContact::StaticContact(InterfacePoints &interfaces,
                               const Vector    &stiffness,
                               BondTips        *tips)
    : interfaces(interfaces)
    , tips(tips)
    , multiplier(interfaces.points.size())
    , last_change(multiplier.size())
    , cohesion(multiplier.size())
    , closing(multiplier.size())
    , tangent(multiplier.size())
    , at_nodes(interfaces.n_nodes())
    , forces(at_nodes.size())
    , at_owned(interfaces.exchange().owned_nodes().size())
    , fixed(at_nodes.size())
  {
    interfaces.exchange().to_clusters(stiffness, at_nodes);
    for (unsigned int i = 0; i < at_nodes.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        fixed[i][d] = at_nodes[i][d] == 0.;
    for (unsigned int k = 0; k < multiplier.size(); ++k)
      {
        const ContactPoint &point = interfaces.points[k];
        const double first   = at_nodes[point.first].norm() / std::sqrt(3.),
                     second  = at_nodes[point.second].norm() / std::sqrt(3.);
        const double stiffer = std::max(first, second);
        // with both sides fixed, forces do not depend on it
        spring.push_back(stiffer == 0.               ? 1. :
                         first == 0. || second == 0. ? stiffer :
                                                       std::min(first, second));
      }
  }


  void
  StaticContact::start_stage()
  {
    before = interfaces.points;
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        multiplier[k]  = before[k].force;
        last_change[k] = Tensor<1, 3>();
        cohesion[k]    = before[k].status == ContactStatus::open ?
                           0. :
                           before[k].limits.cohesion;
      }
  }


  void
  StaticContact::find_gaps(const Vector &displacement)
  {
    interfaces.exchange().to_clusters(displacement, at_nodes);
    interfaces.find_gaps(at_nodes);
  }


  void
  StaticContact::respond(Vector &force, const Vector &displacement)
  {
    find_gaps(displacement);
    std::fill(forces.begin(), forces.end(), Tensor<1, 3>());
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        ContactPoint &point = interfaces.points[k];
        if (!point.joined)
          {
            tangent[k] = Tensor<2, 3>();
            continue;
          }
        Tensor<1, 3> b = point.gap - multiplier[k] / spring[k];
        b[1] -= point.stick_point[0];
        b[2] -= point.stick_point[1];
        closing[k] = closing_force(point.limits, b, spring[k]);
        const ContactLimits limits =
          with_part_of_cohesion(point.limits, cohesion[k], closing[k]);
        const ContactForce found = solve_contact(b, 1. / spring[k], limits);
        point.force              = found.force;
        point.status             = found.status;
        if (limits.bond > point.limits.bond) // points that touch are not open
          point.status = spring[k] * std::hypot(b[1], b[2]) > limits.bond ?
                           ContactStatus::sliding :
                           ContactStatus::sticking;

        Tensor<2, 3> in_frame = tangent_of(found, b, limits, spring[k]);
        in_frame[0][0] +=
          point.area * interfaces.surfaces[point.surface].bar_stiffness;
        tangent[k] = in_global_axes(in_frame, point.frame);

        const Tensor<1, 3> total = ContactPoints::total_force(point);
        forces[point.second] += total;
        forces[point.first] -= total;
      }
    add_forces(force);
  }


  void
  StaticContact::stiffen(const double share)
  {
    for (unsigned int k = 0; k < spring.size(); ++k)
      if (interfaces.points[k].joined)
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
        const ContactPoint &point = interfaces.points[k];
        tangent[k]                = Tensor<2, 3>();
        if (interfaces.touches(point))
          tangent[k] = spring[k] * Tensor<2, 3>(unit_symmetric_tensor<3>());
      }
  }


  void
  StaticContact::add_tangent(Vector &force, const Vector &displacement) const
  {
    interfaces.exchange().to_clusters(displacement, at_nodes);
    std::fill(forces.begin(), forces.end(), Tensor<1, 3>());
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        const ContactPoint &point = interfaces.points[k];
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
    interfaces.exchange().to_owners(forces, at_owned);
    interfaces.exchange().add(force, 1., at_owned);
  }


  std::vector<StaticContact::Pair>
  StaticContact::pairs() const
  {
    std::vector<Pair> result;
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        const ContactPoint &point = interfaces.points[k];
        result.push_back({interfaces.cluster_nodes[point.first],
                          interfaces.cluster_nodes[point.second],
                          tangent[k],
                          fixed[point.first],
                          fixed[point.second]});
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
        ContactPoint &point = interfaces.points[k];
        changed += (point.force - multiplier[k]).norm_square();
        whole += point.force.norm_square();
        // multipliers that alternate are averaged; those of cohesion have a
        // relaxation of their own
        const Tensor<1, 3> way    = point.force - multiplier[k];
        const bool         swings = way * last_change[k] < 0.;
        const double share = swings && point.limits.cohesion == 0. ? 0.5 : 1.;
        last_change[k]     = share * way;
        multiplier[k] += last_change[k];
        cohesion[k] =
          std::clamp(cohesion[k] + cohesion_per_pressure * closing[k] *
                                     (closing[k] > 0. ? over_relaxation : 1.),
                     0.,
                     point.limits.cohesion);

        const ContactLimits limits = point.limits;
        if (limits.tension > 0. || limits.bond > 0.) // the law has a bond
          {
            // of this iterate alone; a crack that closes would follow its
            // stiff unloading line in small steps
            const double opening = point.history.opening;
            point.history        = history_at(k);
            const double closed  = opening - point.history.opening;
            if (closed > 0.)
              point.history.opening =
                std::max(before[k].history.opening,
                         opening - over_relaxation * closed);
          }
        const double bars   = point.bar_extension;
        point.bar_extension = before[k].bar_extension;
        interfaces.yield_bars(point);
        interfaces.update_limits(point);

        number[0] += std::abs(point.bar_extension - bars) >
                       1e-6 * std::abs(point.gap[0]) ||
                     differ(limits.bond, point.limits.bond) ||
                     differ(limits.tension, point.limits.tension) ||
                     differ(limits.cohesion, point.limits.cohesion) ||
                     limits.locked != point.limits.locked;
        number[1] += point.status == ContactStatus::open;
        number[2] += point.status == ContactStatus::sliding;
        number[3] += 1;
      }
    const MPI_Comm communicator = interfaces.communicator;
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


  InterfaceHistory
  StaticContact::history_at(const unsigned int k) const
  {
    const ContactPoint &point = interfaces.points[k];
    if (!point.joined)
      return point.history;
    const bool stays =
      point.status == ContactStatus::sticking || point.limits.locked;
    return point.history_since(before[k].history,
                               before[k].limits.bond > 0.,
                               stays ?
                                 0. :
                                 std::hypot(point.gap[1] - point.stick_point[0],
                                            point.gap[2] -
                                              point.stick_point[1]));
  }


  bool
  StaticContact::find_tips()
  {
    if (tips == nullptr)
      return false;
    std::vector<bool> cracked;
    for (unsigned int k = 0; k < spring.size(); ++k)
      cracked.push_back(interfaces.points[k].joined &&
                        history_at(k).is_cracked());
    return tips->weaken(cracked, interfaces);
  }


  void
  StaticContact::finish_stage()
  {
    for (unsigned int k = 0; k < spring.size(); ++k)
      {
        ContactPoint &point = interfaces.points[k];
        // the history of the last iterate alone
        point.history = history_at(k);
        if (point.status != ContactStatus::sticking && !point.limits.locked)
          {
            point.stick_point[0] = point.gap[1];
            point.stick_point[1] = point.gap[2];
            point.largest_slip =
              std::max(point.largest_slip,
                       std::hypot(point.gap[1], point.gap[2]));
          }
        interfaces.catch_up_with_pressure(point);
      }
  }


  void
  StaticContact::restore()
  {
    interfaces.points = before;
  }
} // namespace Voussoir
