#ifndef voussoir_output_filtered_displacement_h
#define voussoir_output_filtered_displacement_h

#include <voussoir/fem/leap_frog.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * Data for the elastic stress of the equation of motion, sigma = k D : B (u +
   * s w) , with the displacement u [m], the damping memory w [m] and the
   * damping factor s of each material, at the time of a state. The branches of
   * w, which the state holds for the step before, are advanced to its time; the
   * velocity of stiffness-proportional damping and of the mesh viscosity is
   * that of the half step before, as in the step.
   */
  class FilteredDisplacement
  {
  public:
    /** The data at all nodes, in vectors of the discretization. */
    explicit FilteredDisplacement(const StressModel &model);

    /** @param needed entries, of whole nodes; other entries are left at zero */
    FilteredDisplacement(const StressModel      &model,
                         const dealii::IndexSet &needed);

    /** The same in vectors of the discretization, for cell evaluations. */
    static FilteredDisplacement
    for_cells(const StressModel &model, const dealii::IndexSet &needed);

    /** All ranks must call this together. */
    void
    update(const State &state);

    /** u, plus s w if all materials have the same s; with ghosts. */
    const Vector &
    displacement() const;

    /** w if the materials have different s, with ghosts; else null. */
    const Vector *
    memory() const;

    /** Local number of an entry that is needed. */
    unsigned int
    entry(const dealii::types::global_dof_index global) const;

    /** The needed entries of another vector, with ghosts. */
    Vector
    entries_of(const Vector &vector) const;

  private:
    FilteredDisplacement(const StressModel      &model,
                         Vector                &&layout,
                         const dealii::IndexSet &needed);

    /** Adds the owned entries of this range. */
    void
    add_range(const unsigned int begin, const unsigned int end);

    // owned entries that are needed, in parts that stay in the cache
    std::vector<std::pair<unsigned int, unsigned int>> ranges;

    const Damping    &damping;
    const MaxwellStep maxwell;
    const bool        uniform; // damping factors
    const double      factor;  // s if it is the same for all materials
    Vector            u, w;
  };
} // namespace Voussoir

#endif
