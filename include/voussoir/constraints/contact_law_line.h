#ifndef voussoir_constraints_contact_law_line_h
#define voussoir_constraints_contact_law_line_h

#include <voussoir/constraints/contact_point.h>

#include <vector>

namespace Voussoir
{
  /** Segment of the line of a point's law from some z on, linear in z.
   */
  struct ContactSegment
  {
    double from;
    double at; // where force, gap and limit have these values
    double force, force_slope;
    double gap, gap_slope;
    double limit, limit_slope; // of shear, without the bond
    bool   open;
  };


  /** A point, and the segment of its law that it is on. */
  struct ContactLawPoint
  {
    /** @param delassus diagonal entry of the Delassus operator
     *  @param cap limit of strength in place of infinity */
    ContactLawPoint(const ContactLimits &limits,
                    const double         delassus,
                    const double         cap);

    const ContactSegment &
    now() const
    {
      return segments[segment];
    }

    /** Whether the unknown of the point is at the limit of strength in place of
     *  infinity.
     */
    bool
    at_cap() const
    {
      return (tension_capped && segment + 1 == segments.size()) ||
             (slips && (bond_capped || (cohesion_capped && !now().open)));
    }

    ContactStatus
    status() const
    {
      return now().open ? ContactStatus::open :
             slips      ? ContactStatus::sliding :
                          ContactStatus::sticking;
    }

    double stiffness, bond;
    bool   locked, tension_capped, bond_capped, cohesion_capped;
    std::vector<ContactSegment> segments;
    unsigned int                segment;
    bool                        slips;
  };
} // namespace Voussoir

#endif
