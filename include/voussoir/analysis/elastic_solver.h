#ifndef voussoir_analysis_elastic_solver_h
#define voussoir_analysis_elastic_solver_h

#include <voussoir/analysis/multigrid.h>
#include <voussoir/analysis/tied_nodes.h>
#include <voussoir/base/error.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/constraints/static_contact.h>
#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/nodal_terms.h>
#include <voussoir/materials/material.h>

#include <optional>

namespace Voussoir
{
  /** Linear equations that do not converge. */
  class NotSolved : public UserError
  {
  public:
    using UserError::UserError;
  };

  /**
   * Solves K u = f for the elastic stiffness of the materials, with the factors
   * of the internal force, by conjugate gradients with multigrid: its
   * matrix-free operator, and coarser levels by smoothed aggregation with the
   * six rigid-body modes, made from trilinear cells between neighbouring
   * Gauss-Lobatto nodes (for degree 1 the cells themselves). Such a low-order
   * matrix is spectrally equivalent to that of any degree (Orszag 1980).
   */
  class ElasticSolver
  {
  public:
    /** Contributions to the stiffness beside that of the cells. */
    struct Additions
    {
      /** Springs of an absorbing boundary that is not fixed. */
      const NodalTerms *springs = nullptr;

      /** Contact between parts of the model, which are tied where they touch at
       *  this displacement until `tangent_contact` changes that. */
      Contact      *contact      = nullptr;
      const Vector *displacement = nullptr;

      /** Ties that the constraints contain. */
      const TiedNodes *ties = nullptr;
    };

    /**
     * @param constraints of hanging and fixed nodes, see
     *   Discretization::make_constraints(), and nodes that follow others
     */
    ElasticSolver(const Discretization                    &discretization,
                  const InternalForce                     &internal_force,
                  const std::vector<const Material *>     &materials,
                  const dealii::AffineConstraints<double> &constraints,
                  const Additions                         &additions);

    /** The contact whose tangent is part of the stiffness, or null. */
    StaticContact *
    tangent_contact();

    /** Sets constrained entries to zero. */
    void
    clear_constrained(Vector &vector) const;

    /** force = K displacement, reactions of supports included. */
    void
    apply(Vector &force, const Vector &displacement) const;

    /** An approximation of K^-1, zero on constrained entries. */
    void
    precondition(Vector &displacement, const Vector &force) const;

    /**
     * Solves for the displacement, which is also the first guess, until the
     * residual is @p tolerance times the force. Throws NotSolved if that takes
     * more than 1000 iterations.
     *
     * @return the number of iterations
     */
    unsigned int
    solve(Vector       &displacement,
          const Vector &force,
          const double  tolerance) const;

  private:
    /** Visits the contributions of cells and springs. */
    void
    visit_body(const std::vector<const Material *> &materials,
               const ContributionVisit             &visit) const;

    /** Visits those of the tangent of the contact. */
    void
    visit_contact(const ContributionVisit &visit) const;

    /** `apply` without polling for a request to stop. */
    void
    multiply(Vector       &force,
             const Vector &displacement,
             const bool    single_precision) const;

    const Discretization &discretization;
    const InternalForce  &internal_force;
    // of the smoother
    const std::shared_ptr<const Discretization::MatrixFree::SingleCorners>
                                             single_corners;
    const NodalTerms                        *springs;
    const dealii::AffineConstraints<double> &constraints;
    const TiedNodes                         *ties;
    mutable Vector                           tied; // the tied displacement
    std::vector<unsigned int>                constrained; // owned entries
    std::optional<StaticContact>             static_contact;
    std::optional<Multigrid>                 multigrid;
  };
} // namespace Voussoir

#endif
