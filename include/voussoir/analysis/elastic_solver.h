#ifndef voussoir_analysis_elastic_solver_h
#define voussoir_analysis_elastic_solver_h

#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/materials/material.h>

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

namespace Voussoir
{
  /**
   * Solves K u = f for the elastic stiffness of the materials, with the factors
   * of the internal force, by conjugate gradients: its matrix-free operator,
   * preconditioned by Trilinos' smoothed aggregation with the six
   * rigid-body modes, on trilinear cells between neighbouring Gauss-Lobatto
   * nodes (for degree 1 the cells themselves). Such a low-order matrix is
   * spectrally equivalent to that of any degree (Orszag 1980).
   */
  class ElasticSolver
  {
  public:
    /**
     * @param constraints hanging nodes and all that is held, see
     *   Discretization::make_constraints()
     * @param springs     of the absorbing boundary, or null if it is held
     */
    ElasticSolver(
      const Discretization                                  &discretization,
      const InternalForce                                   &internal_force,
      const std::vector<const Material *>                   &materials,
      const std::function<unsigned int(const Grid::Cell &)> &material_of_cell,
      const dealii::AffineConstraints<double>               &constraints,
      const NodalTerms                                      *springs);

    /** Zero on entries that are held. */
    void
    clear_held(Vector &vector) const;

    /** force = K displacement, reactions of what is held included. */
    void
    apply(Vector &force, const Vector &displacement) const;

    /** An approximation of K^-1, zero on what is held. */
    void
    precondition(Vector &displacement, const Vector &force) const;

    /**
     * Solves for the displacement, which is also the first guess, until the
     * residual is @p tolerance times the force. Throws UserError if that takes
     * more than 1000 iterations.
     *
     * @return the number of iterations
     */
    unsigned int
    solve(Vector       &displacement,
          const Vector &force,
          const double  tolerance) const;

  private:
    void
    assemble(
      const std::vector<const Material *>                   &materials,
      const std::function<unsigned int(const Grid::Cell &)> &material_of_cell);

    void
    set_up_multigrid();

    const Discretization                     &discretization;
    const InternalForce                      &internal_force;
    const NodalTerms                         *springs;
    const dealii::AffineConstraints<double>  &constraints;
    std::vector<unsigned int>                 held; // owned entries
    dealii::TrilinosWrappers::SparseMatrix    matrix;
    dealii::TrilinosWrappers::PreconditionAMG multigrid;
  };
} // namespace Voussoir

#endif
