#ifndef voussoir_fem_internal_force_h
#define voussoir_fem_internal_force_h

#include <voussoir/fem/point_history.h>

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

    /** Numbers that each integration point remembers; 0 for a linear law. */
    virtual unsigned int
    n_history() const = 0;

    /**
     * Like add_force, but by the law with its memory, which goes one step on:
     *   f = sum B^T ( sigma(e) - D (e_0 - (k - m) e_s)
     *                 + b D (k B (u + s w - u_0)
     *                        + (k - m) (B u_0 - e_p - e_s)) ) ,
     *   e = m B u_0 + e_0 ,
     * with the displacement u_0 [m], @p undamped, of which u may differ by a
     * damping memory of its own, the stiffness scale k of the damping model,
     * the factor m on strains (one, but in the static stage), and the strain
     * offset e_0 and the static strain e_s of the history. The term with b is
     * the stress of damping alone, of which damage leaves the share b, and in
     * which the plastic strain e_p takes no part. While the law is elastic,
     * this is add_force.
     */
    virtual void
    add_response(const MatrixFree  &matrix_free,
                 Vector            &force,
                 const Vector      &displacement,
                 const Vector      *memory,
                 const Vector      &undamped,
                 const unsigned int begin,
                 const unsigned int end,
                 PointHistory      &history,
                 const double       time_step) const = 0;

    /**
     * Sets the strain offset e_0 of the history, for which the strain e under
     * the static displacement u_s [m] and the temperature T [K] of each node is
     * a (B u_s - alpha T I), with the static factor a of the material, and the
     * static strain e_s = B u_s less the plastic strain so far.
     */
    virtual void
    set_offset(const MatrixFree  &matrix_free,
               PointHistory      &history,
               const Vector      &displacement,
               const Vector      &temperature,
               const unsigned int begin,
               const unsigned int end) const = 0;

    /**
     * Energy stored at the points that have left the elastic range [J], less
     * what the forces of the static state @p u_static (or empty) do.
     */
    virtual double
    inelastic_energy(const MatrixFree   &matrix_free,
                     const PointHistory &history,
                     const Vector       &displacement,
                     const Vector       &u_static,
                     const unsigned int  begin,
                     const unsigned int  end) const = 0;

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

    /** How points that have left the elastic range count in an integral. */
    enum class Inelastic
    {
      not_at_all,
      by_damping_share
    };

    /** Integral of D epsilon(u) : epsilon(v) over the batches [begin, end) [J].
     */
    virtual double
    work(const MatrixFree   &matrix_free,
         const Vector       &u,
         const Vector       &v,
         const unsigned int  begin,
         const unsigned int  end,
         const PointHistory &history,
         const Inelastic     inelastic) const = 0;

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
   * The internal force of all materials in one matrix-free sweep, with vector
   * updates fused into it: the hot loop. The materials' memory lives here.
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
     * force = f(displacement + s memory) by the materials' laws, which see the
     * strain of @p undamped and whose memory goes on by @p time_step, with @p
     * before and @p after called once for every owned entry: before it is first
     * read, after its last contribution has arrived (on one rank; across ranks
     * the library orders the exchange accordingly). @p before may still change
     * the source vectors.
     */
    void
    sweep(Vector          &force,
          const Vector    &displacement,
          const Vector    *memory,
          const Vector    &undamped,
          const double     time_step,
          const RangeWork &before,
          const RangeWork &after);

    /** force = K (displacement + s memory) with the elastic moduli. */
    void
    apply(Vector       &force,
          const Vector &displacement,
          const Vector *memory = nullptr) const;

    /** force = f(displacement) by the laws; their memory takes it in. */
    void
    respond(Vector &force, const Vector &displacement);

    /** Whether any law has a memory. */
    bool
    has_memory() const;

    /** Whether `sweep` uses the laws with memory, or their elastic moduli. */
    bool uses_memory = true;

    /** Lets the laws know the static state; see CellKernel::set_offset. Without
     *  a static stage the vectors are empty. */
    void
    set_static_state(const Vector &displacement, const Vector &temperature);

    /** Energy stored in the materials by the motion since the static state
     *  @p u_static (or empty) [J]; @p moved and @p moved_before are that motion
     *  at the last two steps. */
    double
    stored_energy(const Vector &displacement,
                  const Vector &u_static,
                  const Vector &moved,
                  const Vector &moved_before) const;

    /** Energy lost to cracks and plastic flow, this rank's [J]. */
    double
    dissipated() const;

    /** One of each material. */
    std::vector<PointHistory> histories;

    /** force += what holds back the free expansion at this temperature (in all
     *  three components of each node) [N]. */
    void
    add_thermal_force(Vector &force, const Vector &temperature) const;

    /** Integral of the damping factor times D epsilon(u) : epsilon(v), of which
     *  damage leaves a share [J]. */
    double
    damping_work(const Vector &u, const Vector &v) const;

  private:
    /** Sum over all ranks of what @p evaluate gives for runs of batches of one
     *  material. */
    double
    sum(const std::vector<const Vector *>               &read,
        const std::function<double(const unsigned int,
                                   const unsigned int,
                                   const unsigned int)> &evaluate) const;

    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
  };
} // namespace Voussoir

#endif
