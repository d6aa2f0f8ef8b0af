#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/trilinear_cells.h>
#include <voussoir/base/interruption.h>

#include <deal.II/lac/solver_cg.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Stress of the six unit strains: xx, yy, zz, xy, xz, yz with the tensor
    // component 1/2 in the last three, as a unit displacement gradient has it.
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
          for (unsigned int j = 0; j < 8; ++j)
            for (unsigned int e = 0; e < 3; ++e)
              {
                SymmetricTensor<2, 3> stress;
                for (unsigned int k = 0; k < 3; ++k)
                  stress += (volume * gradient[j][k]) *
                            elasticity[SymmetricTensor<2, 3>::
                                         component_to_unrolled_index({e, k})];
                for (unsigned int i = j; i < 8; ++i)
                  {
                    const Tensor<1, 3> force = stress * gradient[i];
                    for (unsigned int d = 0; d < 3; ++d)
                      matrix(3 * i + d, 3 * j + e) += force[d];
                  }
              }
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


    /** Visits a matrix between some unknowns, without the fixed ones. */
    template <typename IsFixed, typename Entry>
    void
    visit_free(const std::vector<types::global_dof_index> &unknowns,
               const IsFixed                              &is_fixed,
               const Entry                                &entry,
               const ContributionVisit                    &visit)
    {
      std::vector<unsigned int>            left;
      std::vector<types::global_dof_index> free;
      for (unsigned int i = 0; i < unknowns.size(); ++i)
        if (!is_fixed(i))
          {
            left.push_back(i);
            free.push_back(unknowns[i]);
          }
      FullMatrix<double> matrix(left.size());
      for (unsigned int i = 0; i < left.size(); ++i)
        for (unsigned int j = 0; j < left.size(); ++j)
          matrix(i, j) = entry(left[i], left[j]);
      if (!free.empty())
        visit({free, [&]() -> const FullMatrix<double> & { return matrix; }});
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

    IndexSet with_ghosts = discretization.relevant_dofs;
    with_ghosts.add_indices(constraints.get_local_lines()); // nodes that lead
    if (additions.contact != nullptr)
      for (const auto node : additions.contact->cluster_nodes())
        with_ghosts.add_range(3 * node, 3 * node + 3);
    const auto layout = std::make_shared<const Utilities::MPI::Partitioner>(
      discretization.owned_dofs,
      with_ghosts,
      discretization.grid.communicator());

    const Contributions body = [&](const ContributionVisit &visit) {
      visit_body(materials, visit);
    };
    const Contributions contact = [&](const ContributionVisit &visit) {
      visit_contact(visit);
    };
    Vector stiffness = discretization.create_vector();
    add_diagonal(stiffness, body, layout);
    if (additions.contact != nullptr)
      {
        static_contact.emplace(additions.contact->points_of_interfaces(),
                               stiffness,
                               additions.contact->bond_tips());
        static_contact->tie(*additions.displacement);
        add_diagonal(stiffness, contact, layout);
      }
    multigrid.emplace(
      [this](Vector &force, const Vector &displacement) {
        multiply(force, displacement, true);
        clear_constrained(force);
      },
      stiffness,
      constrained,
      std::make_unique<Aggregates>(
        [&](const ContributionVisit &visit) {
          body(visit);
          contact(visit);
        },
        layout,
        constrained,
        3,
        6,
        [&](const unsigned int node, FullMatrix<double> &rigid_modes) {
          // translations, and rotations about the origin
          const Point<3> &x = discretization.node_positions[node];
          rigid_modes       = 0.;
          for (unsigned int d = 0; d < 3; ++d)
            {
              const unsigned int e = (d + 1) % 3, f = (d + 2) % 3;
              rigid_modes(d, d)     = 1.;
              rigid_modes(e, 3 + d) = -x[f];
              rigid_modes(f, 3 + d) = x[e];
            }
        }));
  }


  void
  ElasticSolver::visit_body(const std::vector<const Material *> &materials,
                            const ContributionVisit             &visit) const
  {
    std::vector<Elasticity> elasticities;
    for (unsigned int m = 0; m < materials.size(); ++m)
      elasticities.push_back(
        elasticity_of(*materials[m], internal_force.factor_of(m)));
    const TrilinearCell trilinear;
    Condensation        condense(constraints);
    FullMatrix<double>  of_cell(24);
    for_each_trilinear_cell(
      discretization,
      [&](const auto &cell, const auto &corners, const auto &dofs) {
        condense(
          dofs,
          [&]() -> const FullMatrix<double> & {
            find_stiffness(trilinear,
                           corners,
                           elasticities[discretization.grid.material(cell)],
                           of_cell);
            return of_cell;
          },
          visit);
      });
    if (springs != nullptr)
      for (unsigned int slot = 0; slot < springs->nodes.size(); ++slot)
        {
          const auto first = discretization.owned_dofs.nth_index_in_set(
            3 * springs->nodes[slot]);
          visit_free(
            {first, first + 1, first + 2},
            [&](const unsigned int d) {
              return constraints.is_constrained(first + d);
            },
            [&](const unsigned int d, const unsigned int e) {
              return springs->springs[slot][d][e];
            },
            visit);
        }
  }


  void
  ElasticSolver::visit_contact(const ContributionVisit &visit) const
  {
    if (!static_contact)
      return;
    for (const StaticContact::Pair &p : static_contact->pairs())
      {
        const auto a = 3 * p.first, b = 3 * p.second;
        visit_free(
          {a, a + 1, a + 2, b, b + 1, b + 2},
          [&](const unsigned int i) {
            return i < 3 ? p.first_fixed[i] : p.second_fixed[i - 3];
          },
          [&](const unsigned int i, const unsigned int j) {
            return (i / 3 == j / 3 ? 1. : -1.) * p.tangent[i % 3][j % 3];
          },
          visit);
      }
  }


  StaticContact *
  ElasticSolver::tangent_contact()
  {
    return static_contact ? &*static_contact : nullptr;
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
