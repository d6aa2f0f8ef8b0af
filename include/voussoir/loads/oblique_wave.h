#ifndef voussoir_loads_oblique_wave_h
#define voussoir_loads_oblique_wave_h

#include <voussoir/loads/free_field.h>
#include <voussoir/materials/material.h>
#include <voussoir/signals/signal.h>

namespace Voussoir
{
  /**
   * A plane P, SV or SH wave that meets the horizontal surface of a homogeneous
   * half-space at an angle, with its reflections, in closed form.
   */
  class ObliqueWave
  {
  public:
    enum class Type
    {
      P,
      SV,
      SH
    };

    /**
     * @param angle    between the direction of travel and the vertical [rad];
     *                 for SV below the critical angle asin(cs/cp)
     * @param azimuth  of the horizontal direction of travel, from x to y [rad]
     * @param origin   point of the surface that the wave reaches after @p delay
     */
    ObliqueWave(const Type              type,
                const double            angle,
                const double            azimuth,
                const ElasticConstants &rock,
                const dealii::Point<3> &origin,
                const double            delay);

    /** Time at which the incident front passes a point [s]. */
    double
    arrival(const dealii::Point<3> &point) const;

    dealii::Tensor<1, 3>
    displacement(const Signal           &motion,
                 const dealii::Point<3> &point,
                 const double            time) const;

    dealii::Tensor<1, 3>
    velocity(const Signal           &motion,
             const dealii::Point<3> &point,
             const double            time) const;

    dealii::SymmetricTensor<2, 3>
    stress(const Signal           &motion,
           const dealii::Point<3> &point,
           const double            time) const;

    /** Displacement of the surface per unit of incident displacement. */
    dealii::Tensor<1, 3>
    surface_factor() const;

  private:
    struct PlaneWave
    {
      dealii::Tensor<1, 3>          slowness;     // direction over speed [s/m]
      dealii::Tensor<1, 3>          polarisation; // with amplitude
      dealii::SymmetricTensor<2, 3> stress; // per unit of velocity [Pa s/m]
    };
    std::vector<PlaneWave> waves; // incident first
    dealii::Point<3>       origin;
    double                 delay;
  };

  /** The wave as free field of a model. */
  class ObliqueField : public FreeField
  {
  public:
    ObliqueField(const ObliqueWave        &wave,
                 std::unique_ptr<Signal> &&motion,
                 const BoundaryGeometry   &geometry);

    void
    advance(const double time) override;

  private:
    ObliqueWave             wave;
    std::unique_ptr<Signal> motion;

    std::vector<dealii::Point<3>> nodes, points;
    struct Share
    {
      unsigned int         node, point;
      dealii::Tensor<1, 3> area;
    };
    std::vector<Share> shares;
  };
} // namespace Voussoir

#endif
