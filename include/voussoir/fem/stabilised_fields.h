#ifndef voussoir_fem_stabilised_fields_h
#define voussoir_fem_stabilised_fields_h

#include <array>

namespace Voussoir
{
  /** Strain or stress that stabilises a cell with one integration point: in the
   *  planes of two edges and along the edges, in components of the edges; see
   *  OnePointShape. */
  template <typename Number>
  struct StabilisedFields
  {
    struct Plane
    {
      Number ll, mm, lm;
    };
    std::array<Plane, 3>  planes;
    std::array<Number, 3> bars;

    /** Calls visit(number) for each number. */
    template <typename Visitor>
    void
    for_each_number(const Visitor &visit)
    {
      for (Plane &plane : planes)
        for (Number *number : {&plane.ll, &plane.mm, &plane.lm})
          visit(*number);
      for (Number &bar : bars)
        visit(bar);
    }

    /** Takes one lane of other fields. */
    void
    set_lane(const unsigned int lane, const StabilisedFields &other)
    {
      for (unsigned int k = 0; k < 3; ++k)
        {
          planes[k].ll[lane] = other.planes[k].ll[lane];
          planes[k].mm[lane] = other.planes[k].mm[lane];
          planes[k].lm[lane] = other.planes[k].lm[lane];
          bars[k][lane]      = other.bars[k][lane];
        }
    }

    /** Adds a multiple of other fields. */
    void
    add(const Number &factor, const StabilisedFields &other)
    {
      for (unsigned int k = 0; k < 3; ++k)
        {
          planes[k].ll += factor * other.planes[k].ll;
          planes[k].mm += factor * other.planes[k].mm;
          planes[k].lm += factor * other.planes[k].lm;
          bars[k] += factor * other.bars[k];
        }
    }
  };
} // namespace Voussoir

#endif
