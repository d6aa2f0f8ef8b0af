#include <voussoir/analysis/pressure_solver.h>
#include <voussoir/analysis/trilinear_cells.h>
#include <voussoir/base/error.h>
#include <voussoir/base/interruption.h>

#include <deal.II/lac/solver_cg.h>

namespace Voussoir
{
  using namespace dealii;

  PressureSolver::PressureSolver(const AcousticSpace             &space,
                                 const std::vector<unsigned int> &constrained)
    : space(space)
    , constrained(constrained)
  {
    const auto          constraints = make_constraints();
    const Contributions laplacian   = [&](const ContributionVisit &visit) {
      visit_cells(constraints, visit);
    };
    const auto layout   = space.create_ghosted_vector().get_partitioner();
    Vector     diagonal = space.create_vector();
    add_diagonal(diagonal, laplacian, layout);
    multigrid.emplace(
      [this](Vector &flux, const Vector &pressure) { apply(flux, pressure); },
      diagonal,
      this->constrained,
      std::make_unique<Aggregates>(laplacian,
                                   layout,
                                   this->constrained,
                                   1,
                                   1,
                                   [](const unsigned int,
                                      FullMatrix<double> &constant) {
                                     constant = 1.;
                                   }));
  }


  AffineConstraints<double>
  PressureSolver::make_constraints() const
  {
    Vector is_constrained = space.create_ghosted_vector();
    for (const unsigned int i : constrained)
      is_constrained.local_element(i) = 1.;
    is_constrained.update_ghost_values();
    AffineConstraints<double> constraints(space.relevant_dofs);
    for (const auto dof : space.relevant_dofs)
      if (is_constrained(dof) > 0.)
        constraints.add_line(dof);
    constraints.close();
    return constraints;
  }


  void
  PressureSolver::visit_cells(const AffineConstraints<double> &constraints,
                              const ContributionVisit         &visit) const
  {
    const TrilinearCell                  trilinear;
    Condensation                         condense(constraints);
    FullMatrix<double>                   of_cell(8);
    std::vector<types::global_dof_index> dofs(8);
    for_each_trilinear_cell(
      space.dof_handler,
      space.fe,
      space.mapping,
      [&](const auto &cell) {
        std::vector<types::global_dof_index> nodes(space.fe.n_dofs_per_cell());
        cell->get_dof_indices(nodes);
        return nodes;
      },
      [&](const auto &, const auto &corners, const auto &nodes) {
        dofs.assign(nodes.begin(), nodes.end());
        condense(
          dofs,
          [&]() -> const FullMatrix<double> & {
            of_cell = 0.;
            trilinear.for_each_point(
              corners, [&](const double volume, const auto &gradient) {
                for (unsigned int i = 0; i < 8; ++i)
                  for (unsigned int j = 0; j < 8; ++j)
                    of_cell(i, j) += volume * (gradient[i] * gradient[j]);
              });
            return of_cell;
          },
          visit);
      });
  }


  void
  PressureSolver::apply(Vector &flux, const Vector &pressure) const
  {
    flux = 0.;
    space.sweep(flux, pressure, {}, {});
    for (const unsigned int i : constrained)
      flux.local_element(i) = 0.;
  }


  void
  PressureSolver::solve(Vector       &pressure,
                        const Vector &flux,
                        const double  tolerance) const
  {
    stop_if_requested(space.grid.communicator());
    struct Operator
    {
      const PressureSolver &solver;
      void
      vmult(Vector &dst, const Vector &src) const
      {
        solver.apply(dst, src);
      }
    };
    pressure          = 0.;
    const double size = flux.l2_norm();
    if (size == 0.)
      return;
    SolverControl    control(1000, tolerance * size);
    SolverCG<Vector> solver(control);
    try
      {
        solver.solve(Operator{*this}, pressure, flux, *multigrid);
      }
    catch (const SolverControl::NoConvergence &)
      {
        throw UserError(
          "The pressure of the water does not converge within 1000 iterations, "
          "which happens where its cells are very flat; make them no more than "
          "about five times as long as thick, or set \"Water = none\" in "
          "section \"Modes\".");
      }
  }
} // namespace Voussoir
