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

    /** The class that a material is of, from one; 0: of all. */
    unsigned int part = 0;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether a material is to be parted into classes. */
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
   * partition matter.
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

  /** The class of a value of the field, from zero: all classes are as
   *  likely. */
  unsigned int
  random_class(const double value, const unsigned int n_classes);

  /**
   * Mean in a class of a lognormal factor of mean 1, which is the exponential
   * of the field. So the mean over all classes is 1.
   *
   * @param variation coefficient of variation of the factor
   */
  double
  factor_of_class(const unsigned int random_class,
                  const unsigned int n_classes,
                  const double       variation);
} // namespace Voussoir

#endif
