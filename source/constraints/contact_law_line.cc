#include <voussoir/constraints/contact_law_line.h>

#include <algorithm>
#include <limits>

namespace Voussoir
{
  namespace
  {
    /** The line from closed to open.
     *  @param stiffness by which a gap counts as z */
    std::vector<ContactSegment>
    make_segments(const ContactLimits &limits, const double stiffness)
    {
      const double lowest   = limits.opening_force(),
                   friction = limits.locked ? 0. : limits.with_pressure(),
                   cohesion = limits.locked ? 0. : limits.without_pressure();
      std::vector<ContactSegment> segments;
      if (friction > 0.)
        segments.push_back({0., 0., 0., 1., 0., 0., cohesion, friction, false});
      if (friction == 0. || lowest < 0.)
        segments.push_back({lowest, 0., 0., 1., 0., 0., cohesion, 0., false});
      double z = lowest, gap = 0.;
      if (cohesion > 0.)
        {
          segments.push_back(
            {z - cohesion, z, lowest, 0., 0., 0., cohesion, 1., false});
          z -= cohesion;
        }
      if (limits.opening > 0. && limits.tension > 0.)
        {
          // the secant of an opened bond
          const double secant = limits.tension / limits.opening,
                       slope  = 1. / (stiffness + secant);
          gap                 = limits.opening;
          segments.push_back(
            {z - gap / slope, z, 0., secant * slope, 0., -slope, 0., 0., true});
          z -= gap / slope;
        }
      segments.push_back({-std::numeric_limits<double>::infinity(),
                          z,
                          -limits.tension,
                          0.,
                          gap,
                          -1. / stiffness,
                          0.,
                          0.,
                          true});
      return segments;
    }
  } // namespace


  ContactLawPoint::ContactLawPoint(const ContactLimits &given,
                                   const double         delassus,
                                   const double         cap)
    : stiffness(delassus > 0. ? 1. / delassus : 1.)
    , bond(std::min(given.bond, cap))
    , locked(given.locked)
    , tension_capped(given.tension > cap)
    , bond_capped(given.bond > cap)
    , cohesion_capped(given.cohesion > cap)
  {
    ContactLimits limits = given;
    limits.cohesion      = std::min(given.cohesion, cap);
    if (tension_capped)
      {
        limits.tension = cap;
        limits.opening *= cap / given.tension;
      }
    segments = make_segments(limits, stiffness);
    segment  = segments.size() - 1;
    slips    = !locked;
  }
} // namespace Voussoir
