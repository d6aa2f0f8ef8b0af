#ifndef voussoir_fem_internal_force_h
#define voussoir_fem_internal_force_h

#include <voussoir/fem/cell_kernel.h>
#include <voussoir/fem/initial_state.h>

#include <functional>

namespace Voussoir
{
  /**
   * The internal force of all materials, with the moduli of one stage, in one
   * matrix-free sweep, with vector updates fused into it: the hot loop. A
   * factor k on the stress of each material makes these moduli: under damping,
   * the given moduli hold with this factor at the reference frequency; in the
   * static state it is the static factor. The class has no state: internal
   * variables are arguments of the functions that read or advance them.
   */
  class InternalForce
  {
  public:
    /**
     * @param kernels one per material index of the discretization
     * @param factors k of each material
     */
    InternalForce(const Discretization                  &discretization,
                  const std::vector<const CellKernel *> &kernels,
                  const std::vector<double>             &factors);

    /** The internal force of the same materials in another stage. */
    InternalForce
    with(const std::vector<double> &other_factors) const;

    /** k of a material. */
    double
    factor_of(const unsigned int material) const;

    /** Whether all materials have the same damping factor, so that u + s w can
     *  be formed once per node instead of once per cell. */
    bool
    uniform_damping() const;

    /** The common damping factor. */
    double
    damping_factor() const;

    /** Whether any law has internal variables. */
    bool
    has_memory() const;

    /** Internal variables of all materials at the beginning. */
    MaterialMemory
    new_memory() const;

    /** Work on a range of owned vector entries. */
    using RangeWork =
      std::function<void(const unsigned int, const unsigned int)>;

    /**
     * force = f(x + s w), with the symbols of SweepInput, by the laws of the
     * materials, whose internal variables @p memory advance by one step; with
     * empty @p memory, by the elastic moduli. For every owned entry, @p before
     * is called once before the entry is first read, and @p after once after
     * its last contribution has arrived (on one rank; across ranks deal.II
     * orders the exchange accordingly).
     * @p before may still change the vectors of the input.
     *
     * @param seconds if not null, the time that this rank takes for its cells
     *   is added, without the exchange with others
     * @return whether sums are exact and so reproducible: false if the strain
     * of a cell of this rank exceeds the bounds
     */
    bool
    sweep(Vector           &force,
          const SweepInput &input,
          MaterialMemory   &memory,
          const RangeWork  &before,
          const RangeWork  &after,
          double           *seconds = nullptr) const;

    /** force = K (x + s w) with the elastic moduli. */
    void
    apply(Vector &force, const SweepInput &input) const;

    /** force = K displacement with the elastic moduli. */
    void
    apply(Vector &force, const Vector &displacement) const;

    /** force = f(displacement) by the laws, whose internal variables are
     *  updated. */
    void
    respond(Vector         &force,
            const Vector   &displacement,
            MaterialMemory &memory) const;

    /** Sets the thermal strains of a load increment of the static state; see
     *  CellKernel::set_thermal_strain. */
    void
    set_thermal_strain(const Vector &temperature, MaterialMemory &memory) const;

    /** Converts the internal variables from the materials of the static state;
     *  see CellKernel::hand_over. */
    void
    hand_over(MaterialMemory &memory) const;

    /** Sets the strains of the static state; see CellKernel::set_static_state.
     *  Without a static stage the vectors are empty. */
    void
    set_static_state(const Vector   &displacement,
                     const Vector   &temperature,
                     MaterialMemory &memory) const;

    /** Energy of the elastic points in the part of this rank [J], whose
     *  imbalance the internal variables store. */
    ElasticEnergy
    elastic_energy(const DampedMotion &motion, MaterialMemory &memory) const;

    /** See CellKernel::stabilisation_energy. */
    Lanes
    stabilisation_energy(const unsigned int  batch,
                         const DampedMotion &motion,
                         const PointHistory &history) const;

    /** See CellKernel::elastic_stress. */
    SplitStress
    elastic_stress(const unsigned int  batch,
                   const Vector       &displacement,
                   const PointHistory *history) const;

    /** Energy since the static state @p initial of the points that have left
     *  the elastic range, in the part of this rank [J]. */
    InelasticEnergy
    inelastic_energy(const Vector         &displacement,
                     const MaterialMemory &memory,
                     const InitialState   &initial,
                     const Damping        &damping) const;

    /** force += the force that suppresses the free expansion at this
     *  temperature (in all three components of each node) [N]. */
    void
    add_thermal_force(Vector &force, const Vector &temperature) const;

    /**
     * Integral of k D epsilon(u) : epsilon(v) over all points that are elastic
     * [J].
     *
     * @param by_damping_factor whether each material is weighted by its damping
     *   factor
     */
    double
    elastic_work(const Vector         &u,
                 const Vector         &v,
                 const MaterialMemory &memory,
                 const bool            by_damping_factor) const;

    /** Largest eigenvalue of M^-1 K of each cell of a batch; see
     *  CellKernel::element_eigenvalues. */
    Lanes
    element_eigenvalues(const unsigned int                  batch,
                        const dealii::AlignedVector<Lanes> &masses) const;

  private:
    CellRange
    cells_of(const unsigned int batch) const;

    /** Upper bound of the force of a cell on a node [N], if relative
     *  displacements within the cell are at most this share of its longest
     *  edge. */
    double
    limit_of_forces(const double strain) const;

    /** The same bound for a sweep [N]. It depends on the motion alone, not on
     *  the partition. */
    double
    limit_of_sweep(const SweepInput &input) const;

    /** Calls work(kernel, cells, history) for the cells of all materials with
     *  internal variables. */
    template <typename Work>
    void
    for_each_history(MaterialMemory &memory, const Work &work) const;

    void
    make_static_strains(MaterialMemory &memory) const;

    /** Sum of @p evaluate over the runs of batches of one material,
     *  in the part of this rank. */
    template <typename Sum>
    Sum
    sum(const std::vector<const Vector *> &read,
        const std::function<Sum(const unsigned int, const CellRange &)>
          &evaluate) const;

    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
    std::vector<double>             factors;
  };
} // namespace Voussoir

#endif
