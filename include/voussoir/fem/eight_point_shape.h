#ifndef voussoir_fem_eight_point_shape_h
#define voussoir_fem_eight_point_shape_h

#include <voussoir/fem/discretization.h>

#include <array>

namespace Voussoir
{
  /**
   * Trilinear cells with two integration points in each direction, whose
   * weights are one. Stresses must be submitted in the order of the points.
   *
   * With the edges a_k = dx/dxi_k at a point and their cofactors
   * c_k = a_l x a_m the gradient is G = sum_k du/dxi_k (x) c_k / det , and
   * sigma c_k is the force on du/dxi_k . Derivatives along xi_k are the same at
   * two points that differ in this coordinate only.
   */
  template <typename Number>
  class EightPointShape
  {
  public:
    /** @param matrix_free with the quadrature of these points */
    explicit EightPointShape(const Discretization::MatrixFree &matrix_free)
      : coordinate(2. * matrix_free.quadrature.point(7)[0] - 1.)
    {}

    /** Component by component, in the order of the nodes: component d of node v
     *  is entry 8 d + v. */
    using Values = std::array<Number, 24>;

    /** Finds the shape of the cells with these corners [m]. */
    void
    reinit(const Values &corners);

    /** Evaluates the gradients of these values. */
    void
    evaluate_gradients(const Number *values);

    /** Evaluates values at the points, and overwrites those of the nodes. */
    void
    evaluate_values(Number *values);

    dealii::std_cxx20::ranges::iota_view<unsigned int, unsigned int>
    quadrature_point_indices() const
    {
      return {0U, 8U};
    }

    using Strain = SymmetricTensor3<Number>;

    // Calls of this function and the next took a fifth of the step.
    DEAL_II_ALWAYS_INLINE Strain
    get_symmetric_gradient(const unsigned int q)
    {
      go_to(q);
      dealii::Tensor<2, 3, Number> gradient;
      for (unsigned int k = 0; k < 3; ++k)
        {
          const Vector3 &u = displacements[k][pair(q, k)];
          for (unsigned int d = 0; d < 3; ++d)
            gradient[d] += u[d] * cofactors[k];
        }
      return dealii::symmetrize(gradient) * (Number(1.) / volume);
    }

    dealii::Tensor<1, 3, Number>
    get_value(const unsigned int q) const
    {
      return values_at_points[q];
    }

    const Number &
    JxW(const unsigned int q)
    {
      go_to(q);
      return volume;
    }

    DEAL_II_ALWAYS_INLINE void
    submit_symmetric_gradient(const SymmetricTensor3<Number> &stress,
                              const unsigned int              q)
    {
      go_to(q);
      for (unsigned int k = 0; k < 3; ++k)
        if ((q >> k & 1) == 0)
          forces[k][pair(q, k)] = stress * cofactors[k];
        else
          forces[k][pair(q, k)] += stress * cofactors[k];
    }

    /** Forces of the submitted stresses at the nodes [N]. */
    void
    integrate_gradients(Number *forces_of_nodes);

  private:
    using Vector3 = dealii::Tensor<1, 3, Number>;

    /** Derivatives along each xi_k of a function, at the pairs of points that
     *  differ in this coordinate only. */
    using Derivatives = std::array<std::array<Vector3, 4>, 3>;

    /** The pair of point q along xi_k: bits of the two other coordinates. */
    static constexpr unsigned int
    pair(const unsigned int q, const unsigned int k)
    {
      return k == 0 ? q >> 1 : k == 1 ? (q & 1) | (q >> 2 << 1) : q & 3;
    }

    /** Computes the cofactors of a point. */
    DEAL_II_ALWAYS_INLINE void
    go_to(const unsigned int q)
    {
      if (q == point)
        return;
      point = q;
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int l = (k + 1) % 3, m = (k + 2) % 3;
          cofactors[k] = dealii::cross_product_3d(edges[l][pair(q, l)],
                                                  edges[m][pair(q, m)]);
        }
      volume = edges[0][pair(q, 0)] * cofactors[0];
    }

    void
    find_derivatives(const Number *values, Derivatives &derivatives) const;

    const double           coordinate; // of the points, positive [1]
    Derivatives            edges, displacements, forces;
    std::array<Vector3, 8> values_at_points;

    unsigned int           point = 8; // where these are
    std::array<Vector3, 3> cofactors;
    Number                 volume; // det
  };
} // namespace Voussoir

#endif
