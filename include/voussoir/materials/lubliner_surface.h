#ifndef voussoir_materials_lubliner_surface_h
#define voussoir_materials_lubliner_surface_h

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  /**
   * Surface of Lubliner et al. (1989), by the equivalent uniaxial compression
   * of a stress with the largest principal value s_max,
   *   [alpha I1 + sqrt(3 J2) + beta <s_max> - gamma <-s_max>] / (1 - alpha) .
   */
  struct LublinerSurface
  {
    double biaxial_ratio = 1.16;
    double alpha         = 0.;

    void
    declare_parameters(dealii::ParameterHandler &prm);

    /** Finds alpha. */
    void
    check();

    /**
     * @param first      I1
     * @param equivalent sqrt(3 J2), the equivalent stress of von Mises
     * @param of_largest the term of s_max, whose coefficients depend on the law
     */
    template <typename Number>
    Number
    equivalent_compression(const Number &first,
                           const Number &equivalent,
                           const Number &of_largest) const
    {
      return 1. / (1. - alpha) * (alpha * first + equivalent + of_largest);
    }
  };
} // namespace Voussoir

#endif
