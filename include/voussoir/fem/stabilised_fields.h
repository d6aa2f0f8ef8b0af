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
