#ifndef voussoir_analysis_pressure_solver_h
#define voussoir_analysis_pressure_solver_h

#include <voussoir/analysis/multigrid.h>
#include <voussoir/fem/acoustic_space.h>

#include <optional>

namespace Voussoir
{
  /**
   * Solves H p = q for the pressure Laplacian of the water, H_ij = integral of
   * grad N_i . grad N_j, with zero pressure at some nodes, by conjugate
   * gradients with multigrid as in ElasticSolver.
   */
  class PressureSolver
  {
  public:
    /** @param constrained owned unknowns with zero pressure */
    PressureSolver(const AcousticSpace             &space,
                   const std::vector<unsigned int> &constrained);

    /** Solves until the residual is @p tolerance times @p flux, which is zero
     *  where the pressure is constrained. Throws UserError if that takes more
     * than 1000 iterations. */
    void
    solve(Vector &pressure, const Vector &flux, const double tolerance) const;

  private:
    dealii::AffineConstraints<double>
    make_constraints() const;

    void
    visit_cells(const dealii::AffineConstraints<double> &constraints,
                const ContributionVisit                 &visit) const;

    void
    apply(Vector &flux, const Vector &pressure) const;

    const AcousticSpace            &space;
    const std::vector<unsigned int> constrained;

    std::optional<Multigrid> multigrid;
  };
} // namespace Voussoir

#endif
