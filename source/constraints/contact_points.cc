#include <voussoir/constraints/contact_points.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;


  ContactPoints::ContactPoints(const std::vector<ContactSurface> &surfaces)
    : surfaces(surfaces)
  {}


  void
  ContactPoints::add_cluster(const unsigned int               n_nodes,
                             const std::vector<ContactPoint> &added)
  {
    const unsigned int first_point = points.size();
    for (ContactPoint point : added)
      {
        point.first += number_of_nodes;
        point.second += number_of_nodes;
        point.history.opening =
          std::max(point.history.opening, point.initial_gap[0]);
        if (!point.joined || point.initial_gap[0] > 0.)
          point.status = ContactStatus::open;
        update_limits(point);
        points.push_back(point);
      }
    if (added.size() == 1)
      {
        Assert(clusters_of_several.empty(),
               ExcMessage("Clusters of one point first"));
        ++number_of_single;
      }
    else
      {
        const unsigned int n_points = added.size();
        clusters_of_several.push_back(
          {number_of_nodes, n_nodes, first_point, n_points});
      }
    number_of_nodes += n_nodes;
  }


  unsigned int
  ContactPoints::n_nodes() const
  {
    return number_of_nodes;
  }


  unsigned int
  ContactPoints::n_single() const
  {
    return number_of_single;
  }


  const std::vector<ContactPoints::Cluster> &
  ContactPoints::clusters() const
  {
    return clusters_of_several;
  }


  void
  ContactPoints::find_gaps(const std::vector<Tensor<1, 3>> &displacement)
  {
    for (ContactPoint &point : points)
      {
        point.gap = point.frame *
                      (displacement[point.second] - displacement[point.first]) +
                    point.initial_gap;
        update_limits(point);
      }
  }


  void
  ContactPoints::start(const std::vector<Tensor<1, 3>> &displacement,
                       const std::vector<Tensor<1, 3>> &velocity)
  {
    find_gaps(displacement);
    for (ContactPoint &point : points)
      point.velocity =
        point.frame * (velocity[point.second] - velocity[point.first]);
  }


  void
  ContactPoints::update_limits(ContactPoint &point) const
  {
    constexpr double beyond_all_stresses = 1e12; // [Pa]

    const ContactSurface &surface = surfaces[point.surface];
    if (surface.tied)
      {
        point.limits         = {};
        point.limits.tension = beyond_all_stresses * point.area;
        point.limits.locked  = true;
        point.given_force    = point.uplift * point.area;
        return;
      }
    const InterfaceStrength strength = surface.law->strength(point.history);
    point.limits                     = {strength.tension * point.area,
                                        strength.bond * point.area,
                                        strength.cohesion * point.area,
                                        strength.friction,
                                        point.history.opening,
                                        surface.key_depth > 0. && point.gap[0] < surface.key_depth,
                                        point.lasting_friction(strength.friction),
                                        point.at_once};
    double bars                      = 0.;
    if (surface.bar_stiffness > 0.)
      bars = surface.bar_stiffness *
             (point.gap[0] - point.initial_gap[0] - point.bar_extension);
    point.given_force = (point.uplift - bars) * point.area;
  }


  void
  ContactPoints::catch_up_with_pressure(ContactPoint &point) const
  {
    point.mean_pressure = std::max(point.force[0], 0.);
    update_limits(point);
  }


  void
  ContactPoints::yield_bars(ContactPoint &point) const
  {
    const ContactSurface &surface = surfaces[point.surface];
    if (surface.bar_stiffness == 0.)
      return;
    const double extension = point.gap[0] - point.initial_gap[0],
                 elastic   = surface.bar_strength / surface.bar_stiffness;
    point.bar_extension =
      std::max(extension - elastic,
               std::min(extension + elastic, point.bar_extension));
  }


  Tensor<1, 3>
  ContactPoints::total_force(const ContactPoint &point)
  {
    Tensor<1, 3> force = point.force;
    force[0] += point.given_force;
    return force * point.frame;
  }
} // namespace Voussoir
