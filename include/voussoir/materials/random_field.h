#ifndef voussoir_materials_random_field_h
#define voussoir_materials_random_field_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <vector>

namespace Voussoir
{
  /** Entries of the section "Random field" of a material. */
  struct RandomFieldParameters
  {
    double              modulus_variation = 0., strength_variation = 0.;
    std::vector<double> lengths{20., 20., 20.}; // of correlation [m]
    unsigned int        seed = 1, n_classes = 16;

    /** The class of a material, counted from one; 0: all classes. */
    unsigned int part = 0;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether a material is to be divided into classes. */
    bool
    wanted() const;
  };

  /**
   * A Gaussian random field of mean 0 and variance 1, whose correlation is
   * exp(-|s|^2) at two points with the distance s in correlation lengths.
   *
   * It is a sum of cosines whose wave vectors are drawn from the spectral
   * density of that correlation (Shinozuka and Deodatis 1991, with random wave
   * vectors), and so a function of the point alone: neither the mesh nor its
   * partition matters.
   */
  class RandomField
  {
  public:
    /** @param lengths of correlation in x, y, z [m] */
    RandomField(const std::vector<double> &lengths, const unsigned int seed);

    double
    operator()(const dealii::Point<3> &point) const;

  private:
    struct Wave
    {
      dealii::Tensor<1, 3> vector; // [1/m]
      double               phase;
    };
    std::vector<Wave> waves;
  };

  /** The class of a value of the field, counted from zero; all classes are
   *  equally likely. */
  unsigned int
  random_class(const double value, const unsigned int n_classes);

  /**
   * Mean over a class of a lognormal factor, the exponential of the scaled
   * field. The mean over all classes is 1.
   *
   * @param variation coefficient of variation of the factor
   */
  double
  factor_of_class(const unsigned int random_class,
                  const unsigned int n_classes,
                  const double       variation);
} // namespace Voussoir

#endif
