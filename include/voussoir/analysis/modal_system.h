#ifndef voussoir_analysis_modal_system_h
#define voussoir_analysis_modal_system_h

#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/modal_model.h>
#include <voussoir/analysis/modal_water.h>

namespace Voussoir
{
  /**
   * Stiffness and mass of the natural modes, K phi = omega^2 (M + M_a) phi. A
   * motion is a list of numbers: the displacements of the owned nodes and, with
   * compressible water, the unknowns of its pressure (see ModalWater). Entries
   * that are fixed or follow others are zero.
   */
  class ModalSystem
  {
  public:
    using Motion = std::vector<double>;

    /** Called on all ranks, as all functions below. */
    ModalSystem(const ModalModel &model, const ModeParameters &parameters);

    /** Makes the preconditioner and all data of the products with the matrices
     * except the masses. */
    void
    set_up();

    /** Entries of this rank. */
    std::size_t
    size() const;

    /** Unknowns with mass of all ranks. */
    dealii::types::global_dof_index
    n_with_mass() const;

    /** Points of the interfaces, and those among them that are tied. */
    struct TiedPoints
    {
      unsigned int all = 0, tied = 0;
      bool         bars = false; // across some of those that are open
    };
    const TiedPoints &
    tied_points() const;

    bool
    has_added_mass() const;

    void
    stiffness(double *force, const double *motion) const;

    void
    mass(double *momentum, const double *motion) const;

    /** An approximation of K^-1. */
    void
    precondition(double *motion, const double *force) const;

    /**
     * Motions under forces that are sine waves of arbitrary direction in space:
     * smooth, without symmetry, the same on any number of ranks.
     */
    std::vector<Motion>
    start(const unsigned int number) const;

    /** M r: the forces on the free unknowns under unit acceleration of all in
     *  one direction. Fixed nodes move, too, as the ground does, and push the
     *  water. */
    Motion
    rigid_momentum(const unsigned int direction) const;

    /** M^-1 times such forces, by conjugate gradients; exact without cells of
     *  water. */
    Motion
    divided_by_mass(const Motion &momentum) const;

    /** Sum over all ranks. */
    double
    product(const Motion &a, const Motion &b) const;

    /** The forces on the solid among all forces. */
    Vector
    solid_part(const Motion &force) const;

    /** The displacements of a motion, of all nodes. */
    Vector
    displacement(const Motion &motion) const;

  private:
    /** Finds the mass of the structure; zero where it cannot move. */
    void
    find_structural_mass();

    void
    tie();

    const ModalModel                 &model;
    const ModeParameters             &parameters;
    const InternalForce               moduli_as_given;
    dealii::AffineConstraints<double> constraints;
    TiedPoints                        points;
    std::optional<TiedNodes>          ties;
    Vector                            structure; // mass
    std::optional<ElasticSolver>      solver;
    std::optional<ModalWater>         water;
    mutable Vector                    from, to; // of the solid
  };
} // namespace Voussoir

#endif
