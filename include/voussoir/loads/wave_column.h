#ifndef voussoir_loads_wave_column_h
#define voussoir_loads_wave_column_h

#include <voussoir/fem/damping.h>
#include <voussoir/fem/discretization.h>
#include <voussoir/fem/leap_frog.h>
#include <voussoir/loads/free_field.h>
#include <voussoir/materials/material.h>

#include <deal.II/base/polynomial.h>

namespace Voussoir
{
  /**
   * Vertically travelling S waves (x, y) and P wave (z) in horizontal layers: a
   * column of one-dimensional elements, integrated with the scheme, the degree,
   * the quadrature, the damping and the time step of the model, on the levels
   * of its side faces. A model with regular sides then moves as the column,
   * to round-off.
   *
   * The traction on the base is rho c (2 v_incident - v); the top is free.
   */
  class WaveColumn
  {
  public:
    struct Layer
    {
      double           lower, upper; // [m]
      ElasticConstants constants;    // at the reference frequency
      double           damping_factor;
    };

    WaveColumn(const std::vector<Layer> &layers,
               const unsigned int        degree,
               const QuadratureRule      quadrature,
               const Damping            &damping,
               const LeapFrog           &leap_frog);

    /** Sets displacement, velocity and stress of this step and prepares the
     *  next; @p incident_velocity is that of the upgoing wave at the base. */
    void
    advance(const dealii::Tensor<1, 3> &incident_velocity);

    /** The motion, from which the next step continues. */
    std::vector<double>
    save() const;

    void
    load(const std::vector<double> &numbers);

    /** Place of a level: interpolation weights of the nodes around it. */
    struct Interpolation
    {
      unsigned int        first_node;
      std::vector<double> weights;
    };
    Interpolation
    interpolation(const double z) const;

    dealii::Tensor<1, 3>
    displacement(const Interpolation &at) const;

    dealii::Tensor<1, 3>
    velocity(const Interpolation &at) const;

    /** A level inside an element, for the stress there. */
    struct StressPoint
    {
      unsigned int        element;
      std::vector<double> gradients;
    };
    /** At @p z, in the element on the side of the height @p middle: between
     *  two elements the stress may jump. */
    StressPoint
    stress_point(const double z, const double middle) const;

    /** Whether all points of an element have the same stress. */
    bool
    has_uniform_stress() const
    {
      return degree == 1;
    }

    /** sigma_xz, sigma_yz, sigma_zz [Pa]. */
    dealii::Tensor<1, 3>
    stress(const StressPoint &at) const;

    /** nu/(1-nu): lateral over vertical stress of the P wave. */
    double
    lateral_ratio(const StressPoint &at) const;

    /** Traction on the base (x, y, z) [Pa]. */
    dealii::Tensor<1, 3>
    base_traction() const;

    dealii::Tensor<1, 3>
    surface_velocity() const;

    double
    bottom() const;

    double
    top() const;

    /** Time an S wave takes from base to surface [s]. */
    double
    travel_time() const;

  private:
    unsigned int
    element_at(const double z) const;

    struct Element
    {
      double               lower, height;
      dealii::Tensor<1, 3> modulus; // G, G, lambda + 2 G, scaled [Pa]
      double               damping_factor;
      double               lateral_ratio;
      double               s_wave_speed;
    };

    const unsigned int degree;
    const LeapFrog     leap_frog;
    const MaxwellStep  maxwell;
    // derivatives of the shape functions at the quadrature points, weights
    std::vector<std::vector<double>>                     gradients;
    std::vector<double>                                  weights;
    std::vector<dealii::Polynomials::Polynomial<double>> shapes;
    std::vector<Element>                                 elements;
    std::vector<double>                                  mass; // [kg/m2]
    dealii::Tensor<1, 3>                                 impedance;
    double                                               mass_coefficient;
    double stiffness_coefficient, mesh_viscosity;

    // motion of the step (u_n and the velocity in the middle of its two half
    // steps) and initial values of the next one
    std::vector<dealii::Tensor<1, 3>> u, middle_velocity, next_u, v, effective;
    std::vector<std::vector<dealii::Tensor<1, 3>>> memory;
    dealii::Tensor<1, 3>                           base;
  };
} // namespace Voussoir

#endif
