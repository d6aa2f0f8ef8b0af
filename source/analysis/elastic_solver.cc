#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/trilinear_cells.h>
#include <voussoir/base/interruption.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <Epetra_MultiVector.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Stress of the six unit strains: xx, yy, zz, xy, xz, yz with the tensor
    // component 1/2 in the last three.
    using Elasticity = std::array<SymmetricTensor<2, 3>, 6>;

    Elasticity
    elasticity_of(const Material &material, const double factor)
    {
      Elasticity result;
      for (unsigned int i = 0; i < 6; ++i)
        {
          SymmetricTensor<2, 3> strain;
          strain.access_raw_entry(i) = i < 3 ? 1. : 0.5;
          result[i]                  = factor * material.stress(strain);
        }
      return result;
    }


    /** Stiffness of one trilinear cell from the positions of its corners. */
    void
    find_stiffness(const TrilinearCell           &trilinear,
                   const std::array<Point<3>, 8> &corners,
                   const Elasticity              &elasticity,
                   FullMatrix<double>            &matrix)
    {
      matrix = 0.;
      trilinear.for_each_point(
        corners, [&](const double volume, const auto &gradient) {
          std::array<std::array<SymmetricTensor<2, 3>, 3>, 8> strain, stress;
          for (unsigned int i = 0; i < 8; ++i)
            for (unsigned int d = 0; d < 3; ++d)
              {
                Tensor<2, 3> displacement_gradient;
                displacement_gradient[d] = gradient[i];
                strain[i][d]             = symmetrize(displacement_gradient);
                for (unsigned int c = 0; c < 6; ++c)
                  stress[i][d] += (c < 3 ? 1. : 2.) * volume *
                                  strain[i][d].access_raw_entry(c) *
                                  elasticity[c];
              }
          for (unsigned int i = 0; i < 8; ++i)
            for (unsigned int j = 0; j <= i; ++j)
              for (unsigned int d = 0; d < 3; ++d)
                for (unsigned int e = 0; e < 3; ++e)
                  matrix(3 * i + d, 3 * j + e) += strain[i][d] * stress[j][e];
        });
      for (unsigned int i = 0; i < 24; ++i)
        for (unsigned int j = i / 3 * 3 + 3; j < 24; ++j)
          matrix(i, j) = matrix(j, i);
    }


    /** Calls visit(cell, corner positions, their degrees of freedom) for the
     *  trilinear cells between the nodes of each owned cell. */
    template <typename Visit>
    void
    for_each_trilinear_cell(const Discretization &discretization,
                            const Visit          &visit)
    {
      std::vector<types::global_dof_index> dofs(24);
      Voussoir::for_each_trilinear_cell(
        discretization.dof_handler,
        dynamic_cast<const FE_Q<3> &>(discretization.fe.base_element(0)),
        discretization.mapping,
        [&](const auto &cell) { return discretization.cell_nodes(cell); },
        [&](const auto &cell, const auto &corners, const auto &nodes) {
          for (unsigned int i = 0; i < 24; ++i)
            dofs[i] = 3 * nodes[i / 3] + i % 3;
          visit(cell, corners, dofs);
        });
    }
  } // namespace


  ElasticSolver::ElasticSolver(const Discretization &discretization,
                               const InternalForce  &internal_force,
                               const std::vector<const Material *> &materials,
                               const AffineConstraints<double>     &constraints,
                               const Additions                     &additions)
    : discretization(discretization)
    , internal_force(internal_force)
    , single_corners(discretization.single_corners())
    , springs(additions.springs)
    , constraints(constraints)
    , ties(additions.ties)
  {
    for (unsigned int i = 0; i < 3 * discretization.n_owned_nodes(); ++i)
      if (constraints.is_constrained(
            discretization.owned_dofs.nth_index_in_set(i)))
        constrained.push_back(i);
    assemble(materials, additions.contact);
    if (additions.contact != nullptr)
      tie(*additions.contact, *additions.displacement);
    set_up_multigrid();
  }


  void
  ElasticSolver::assemble(const std::vector<const Material *> &materials,
                          const Contact                       *contact)
  {
    IndexSet rows = discretization.relevant_dofs;
    rows.add_indices(constraints.get_local_lines()); // of nodes that lead
    if (contact != nullptr)
      for (const auto node : contact->cluster_nodes())
        rows.add_range(3 * node, 3 * node + 3);
    TrilinosWrappers::SparsityPattern pattern(
      discretization.owned_dofs,
      discretization.owned_dofs,
      rows,
      discretization.grid.communicator(),
      81);
    for_each_trilinear_cell(
      discretization, [&](const auto &, const auto &, const auto &dofs) {
        constraints.add_entries_local_to_global(dofs, pattern, true);
      });
    if (contact != nullptr)
      for (const ContactPoint &point : contact->points())
        for (const unsigned int a : {point.first, point.second})
          for (const unsigned int b : {point.first, point.second})
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int e = 0; e < 3; ++e)
                pattern.add(3 * contact->cluster_nodes()[a] + d,
                            3 * contact->cluster_nodes()[b] + e);
    pattern.compress();
    matrix.reinit(pattern);

    std::vector<Elasticity> elasticities;
    for (unsigned int m = 0; m < materials.size(); ++m)
      elasticities.push_back(
        elasticity_of(*materials[m], internal_force.factor_of(m)));
    const TrilinearCell trilinear;
    FullMatrix<double>  cell_matrix(24);
    for_each_trilinear_cell(
      discretization,
      [&](const auto &cell, const auto &corners, const auto &dofs) {
        find_stiffness(trilinear,
                       corners,
                       elasticities[discretization.grid.material(cell)],
                       cell_matrix);
        constraints.distribute_local_to_global(cell_matrix, dofs, matrix);
      });
    if (springs != nullptr)
      for (unsigned int slot = 0; slot < springs->nodes.size(); ++slot)
        {
          const auto first = discretization.owned_dofs.nth_index_in_set(
            3 * springs->nodes[slot]);
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int e = 0; e < 3; ++e)
              if (!constraints.is_constrained(first + d) &&
                  !constraints.is_constrained(first + e))
                matrix.add(first + d, first + e, springs->springs[slot][d][e]);
        }
    matrix.compress(VectorOperation::add);
  }


  void
  ElasticSolver::tie(Contact &contact, const Vector &displacement)
  {
    Vector stiffness = diagonal();
    clear_constrained(stiffness);
    static_contact.emplace(contact.points_of_interfaces(), stiffness);
    static_contact->tie(displacement);

    const auto add = [&](const auto          first,
                         const auto          second,
                         const auto         &first_fixed,
                         const auto         &second_fixed,
                         const Tensor<2, 3> &values) {
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int e = 0; e < 3; ++e)
          if (!first_fixed[d] && !second_fixed[e])
            matrix.add(3 * first + d, 3 * second + e, values[d][e]);
    };
    for (const StaticContact::Pair &p : static_contact->pairs())
      {
        add(p.first, p.first, p.first_fixed, p.first_fixed, p.tangent);
        add(p.second, p.second, p.second_fixed, p.second_fixed, p.tangent);
        add(p.first, p.second, p.first_fixed, p.second_fixed, -p.tangent);
        add(p.second, p.first, p.second_fixed, p.first_fixed, -p.tangent);
      }
    matrix.compress(VectorOperation::add);
  }


  StaticContact *
  ElasticSolver::tangent_contact()
  {
    return static_contact ? &*static_contact : nullptr;
  }


  void
  ElasticSolver::set_up_multigrid()
  {
    // translations, and rotations about the origin
    const auto        &map = matrix.trilinos_matrix().OperatorDomainMap();
    Epetra_MultiVector rigid_modes(map, 6);
    for (unsigned int node = 0; node < discretization.n_owned_nodes(); ++node)
      {
        const Point<3> &x = discretization.node_positions[node];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int e = (d + 1) % 3, f = (d + 2) % 3;
            rigid_modes[d][3 * node + d]     = 1.;
            rigid_modes[3 + d][3 * node + e] = -x[f];
            rigid_modes[3 + d][3 * node + f] = x[e];
          }
      }

    multigrid.emplace(
      [this](Vector &force, const Vector &displacement) {
        multiply(force, displacement, true);
        clear_constrained(force);
      },
      matrix,
      diagonal(),
      constrained,
      3,
      rigid_modes);
  }


  Vector
  ElasticSolver::diagonal() const
  {
    Vector result = discretization.create_vector();
    for (unsigned int i = 0; i < result.locally_owned_size(); ++i)
      result.local_element(i) =
        matrix.diag_element(discretization.owned_dofs.nth_index_in_set(i));
    return result;
  }


  void
  ElasticSolver::clear_constrained(Vector &vector) const
  {
    for (const unsigned int i : constrained)
      vector.local_element(i) = 0.;
  }


  void
  ElasticSolver::apply(Vector &force, const Vector &displacement) const
  {
    stop_if_requested(discretization.grid.communicator());
    multiply(force, displacement, false);
  }


  void
  ElasticSolver::multiply(Vector       &force,
                          const Vector &displacement,
                          const bool    single_precision) const
  {
    const auto respond = [&](const Vector &moved) {
      SweepInput input       = SweepInput::undamped(moved);
      input.single_precision = single_precision;
      internal_force.apply(force, input);
      if (springs != nullptr)
        springs->add_to(force, moved, 0.);
      if (static_contact)
        static_contact->add_tangent(force, moved);
    };
    if (ties == nullptr)
      {
        respond(displacement);
        return;
      }
    tied = displacement;
    ties->distribute(tied);
    respond(tied);
    ties->collect(force);
  }


  void
  ElasticSolver::precondition(Vector &displacement, const Vector &force) const
  {
    multigrid->vmult(displacement, force);
    clear_constrained(displacement);
  }


  unsigned int
  ElasticSolver::solve(Vector       &displacement,
                       const Vector &force,
                       const double  tolerance) const
  {
    struct Operator
    {
      const ElasticSolver &solver;
      void
      vmult(Vector &dst, const Vector &src) const
      {
        solver.apply(dst, src);
        solver.clear_constrained(dst);
      }
    };
    struct Preconditioner
    {
      const ElasticSolver &solver;
      void
      vmult(Vector &dst, const Vector &src) const
      {
        solver.precondition(dst, src);
      }
    };
    Vector right_side = force;
    clear_constrained(right_side);
    clear_constrained(displacement);
    const double size = right_side.l2_norm();
    if (size == 0.)
      {
        displacement = 0.;
        return 0;
      }
    SolverControl    control(1000, tolerance * size);
    SolverCG<Vector> solver(control);
    try
      {
        solver.solve(Operator{*this},
                     displacement,
                     right_side,
                     Preconditioner{*this});
      }
    catch (const SolverControl::NoConvergence &)
      {
        throw NotSolved(
          "The static equations do not converge within 1000 iterations. Either "
          "a part of the model can move freely: fix it with \"Fixed\" or "
          "\"Roller\" in section \"Boundaries\"; or its cells are very flat: "
          "make them no more than about five times as long as thick.");
      }
    return control.last_step();
  }
} // namespace Voussoir
