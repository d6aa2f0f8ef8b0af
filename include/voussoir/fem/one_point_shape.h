#ifndef voussoir_fem_one_point_shape_h
#define voussoir_fem_one_point_shape_h

#include <voussoir/fem/discretization.h>
#include <voussoir/fem/stabilised_fields.h>

namespace Voussoir
{
  /**
   * Trilinear cells with one integration point and physical stabilisation.
   *
   * With the unit coordinates xi_k from -1 to 1 the displacement of a cell is
   *
   *   u = u_0 + sum_k u_k xi_k + sum_k v_k xi_l xi_m + v_3 xi_0 xi_1 xi_2 ,
   *
   * where l and m are the directions beside k. The strain at the point is that
   * of the mean gradient G over the cell, exact in cells of any shape, so that
   * the patch test is passed (Flanagan and Belytschko 1981). The rest is the
   * hourglass motion without its part in G, q_k = v_k - G x_k, with the
   * corresponding parts x_k of the cell's shape. Of its strain, the part that a
   * single layer of cells needs in bending is kept (Belytschko and Bindeman
   * 1993, Puso 2000):
   *
   * - In the plane of the edges l and m, the strain that varies along xi_k,
   *   with the stress of a plate, which is zero across the plane. That is the
   *   plane's exact stiffness against bending and twisting; no shear across it
   *   and no change of volume go with the bending, so that thin layers do not
   *   lock, nor do cells with a Poisson's ratio near 1/2.
   * - For q_3, the strain along each edge, with the stress of a bar.
   *
   * These six fields leave a cell no motion without energy but the rigid ones;
   * in parallelepipeds they are orthogonal to each other and to the mean
   * strain.
   *
   * Their stiffness is that of an isotropic elastic material. So the
   * stabilisation neither generates nor dissipates energy, and a cracked cell
   * keeps its shape; but it also keeps its own resistance to bending, 1/n^2 of
   * that of a wall of n cells, unless it is released (see CrackPlanes). A wall
   * of one cell cannot crack in bending anyway, as bending causes no strain at
   * its point.
   */
  template <typename Number>
  class OnePointShape
  {
  public:
    explicit OnePointShape(const Discretization::MatrixFree &)
    {}

    using Fields = StabilisedFields<Number>;

    /** Component by component, in the order of the nodes: component d of node v
     *  is entry 8 d + v. */
    using Values = std::array<Number, 24>;

    /** Finds the shape of the cells with these corners [m]. */
    void
    reinit(const Values &corners);

    /** Evaluates the gradient of these values, which are overwritten. */
    void
    evaluate_gradients(Number *values);

    /** Evaluates the values in the centre, and overwrites those of the nodes.
     */
    void
    evaluate_values(Number *values);

    dealii::std_cxx20::ranges::iota_view<unsigned int, unsigned int>
    quadrature_point_indices() const
    {
      return {0U, 1U};
    }

    const SymmetricTensor3<Number> &
    get_symmetric_gradient(const unsigned int) const
    {
      return mean_strain;
    }

    const dealii::Tensor<1, 3, Number> &
    get_value(const unsigned int) const
    {
      return mean_value;
    }

    const Number &
    JxW(const unsigned int) const
    {
      return volume;
    }

    void
    submit_symmetric_gradient(const SymmetricTensor3<Number> &stress,
                              const unsigned int)
    {
      mean_stress = stress;
    }

    /** The stabilising stress of these elastic constants, for `integrate`. */
    void
    submit_stabilisation(const double young_modulus,
                         const double poisson_ratio);

    /** Multiplies the submitted stress. */
    void
    scale_stabilisation(const Number &factor);

    /** Adds a multiple of the stress of another stabilised strain. */
    void
    add_stabilisation(const Number &factor,
                      const Fields &of_strain,
                      const double  young_modulus,
                      const double  poisson_ratio);

    const Fields &
    stabilised_strain() const
    {
      return strain;
    }

    /** Stabilising stress of a stabilised strain of these cells, times their
     *  volume. */
    Fields
    stabilising_stress(const Fields &of_strain,
                       const double  young_modulus,
                       const double  poisson_ratio) const;

    /** Replaces the stabilised strain by the thermal strain of the temperature,
     *  whose values must have been evaluated. */
    void
    expand(const double expansion);

    /** Work of the submitted stabilising stress on the strain of another
     *  evaluation of the same cells [J]. */
    Number
    stabilisation_work(const OnePointShape &other) const
    {
      return work(stress, other.strain);
    }

    /** Work of a stabilising stress on a stabilised strain [J]. */
    static Number
    work(const Fields &stress, const Fields &strain);

    /** Forces of the submitted stresses at the nodes [N]. */
    void
    integrate_gradients(Number *forces);

  private:
    using Vector3 = dealii::Tensor<1, 3, Number>;

    void
    find_stress(Fields       &result,
                const Fields &of_strain,
                const double  young_modulus,
                const double  poisson_ratio) const;

    // the cells' shape
    std::array<Vector3, 3>                edges; // half the mean edges
    std::array<Vector3, 4>                warps; // x_k
    std::array<Vector3, 3>                b_linear, b_hourglass; // of 8 G
    std::array<typename Fields::Plane, 3> inverse_metric;
    std::array<Number, 3>                 inverse_length_square;
    Number                                volume;

    // their state
    SymmetricTensor3<Number> mean_strain, mean_stress;
    Vector3                  mean_value, value_gradient;
    Fields                   strain, stress;
  };
} // namespace Voussoir

#endif
