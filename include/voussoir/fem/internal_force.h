#ifndef voussoir_fem_internal_force_h
#define voussoir_fem_internal_force_h

#include <voussoir/fem/discretization.h>

#include <functional>
#include <memory>

namespace Voussoir
{
  /**
   * What a material does with a run of cell batches that are all of that
   * material: the only virtual call of the cell loop.
   */
  class CellKernel
  {
  public:
    virtual ~CellKernel() = default;

    using MatrixFree = Discretization::MatrixFree;

    /**
     * Adds the internal force of the batches [begin, end) to @p force [N],
     *   f = sum B^T sigma( B (u + s w) ),
     * with the displacement u [m], the damping memory w [m] (null: none) and
     * the damping factor s of this material.
     */
    virtual void
    add_force(const MatrixFree  &matrix_free,
              Vector            &force,
              const Vector      &displacement,
              const Vector      *memory,
              const unsigned int begin,
              const unsigned int end) const = 0;

    /**
     * Adds the force that a free expansion needs to be held back [N],
     *   f = sum B^T sigma(alpha T I),
     * with the temperature T [K] of each node in all three components.
     */
    virtual void
    add_thermal_force(const MatrixFree  &matrix_free,
                      Vector            &force,
                      const Vector      &temperature,
                      const unsigned int begin,
                      const unsigned int end) const = 0;

    /** Integral of sigma(u) : epsilon(v) over the batches [begin, end) [J]. */
    virtual double
    work(const MatrixFree  &matrix_free,
         const Vector      &u,
         const Vector      &v,
         const unsigned int begin,
         const unsigned int end) const = 0;

    /**
     * Largest eigenvalue of M^-1 K of each cell of a batch by itself [1/s2].
     * @param masses lumped mass of the cell's nodes [kg], in the order of the
     *   dof values of one component
     */
    virtual Lanes
    element_eigenvalues(const MatrixFree                   &matrix_free,
                        const unsigned int                  batch,
                        const dealii::AlignedVector<Lanes> &masses) const = 0;

    /** Factor s on the damping memory, relative to the damping model. */
    virtual double
    damping_factor() const = 0;
  };

  /**
   * The internal force f(u) of all materials in one matrix-free sweep, with
   * vector updates fused into it: the hot loop.
   */
  class InternalForce
  {
  public:
    /** @param kernels one per material index of the discretization */
    InternalForce(const Discretization                  &discretization,
                  const std::vector<const CellKernel *> &kernels);

    /** Whether all materials have the same damping factor, so that u + s w can
     *  be formed once per node instead of once per cell. */
    bool
    uniform_damping() const;

    /** The common damping factor. */
    double
    damping_factor() const;

    /** Work on a range of owned vector entries. */
    using RangeWork =
      std::function<void(const unsigned int, const unsigned int)>;

    /**
     * force = f(displacement + s memory) with @p before and @p after called
     * once for every owned entry: before it is first read, after its last
     * contribution has arrived (on one rank; across ranks the library orders
     * the exchange accordingly). @p before may still change the source vectors.
     */
    void
    sweep(Vector          &force,
          const Vector    &displacement,
          const Vector    *memory,
          const RangeWork &before,
          const RangeWork &after) const;

    /** force = f(displacement). */
    void
    apply(Vector &force, const Vector &displacement) const;

    /** force += what holds back the free expansion at this temperature (in all
     *  three components of each node) [N]. */
    void
    add_thermal_force(Vector &force, const Vector &temperature) const;

    /**
     * The stored work u^T K v [J]; with @p with_damping_factors each material
     * counts times its damping factor.
     */
    double
    work(const Vector &u,
         const Vector &v,
         const bool    with_damping_factors = false) const;

  private:
    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
  };
} // namespace Voussoir

#endif
