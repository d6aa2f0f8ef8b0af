#include <voussoir/fem/nodal_values.h>

#include <deal.II/base/quadrature_lib.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The vectorised operator against cell matrices assembled point by point
     * without vectorisation, and the patch test: a linear displacement gives no
     * force inside.
     */
    class Operator : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const Discretization &discretization =
          simulation->model.solid.discretization;

        Vector u = discretization.create_vector(), wide(u);
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          for (unsigned int d = 0; d < 3; ++d)
            if (simulation->model.solid.mass.inverse.local_element(3 * node +
                                                                   d) > 0.)
              {
                const Point<3> &p = discretization.node_positions[node];
                u.local_element(3 * node + d) =
                  std::sin(3. * p[0] + d) * std::cos(2. * p[1]) + p[2] * p[2];
              }
        simulation->run.equation.internal_force.apply(wide, u);
        Vector       narrow = reference(*simulation, u);
        const double size   = largest_entry(narrow);
        narrow -= wide;
        verdicts.below("vectorised against plain operator, relative",
                       largest_entry(narrow) / size,
                       1e-12);

        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &p             = discretization.node_positions[node];
            u.local_element(3 * node)     = 0.3 * p[0] + 0.2 * p[1];
            u.local_element(3 * node + 1) = 0.1 * p[2] - 0.4 * p[0];
            u.local_element(3 * node + 2) = 0.7 * p[1] + 0.5 * p[2];
          }
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          if (simulation->model.solid.mass.inverse.local_element(i) == 0.)
            u.local_element(i) = 0.; // hanging: the operator interpolates
        simulation->run.equation.internal_force.apply(wide, u);
        double inside = 0.;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &p     = discretization.node_positions[node];
            bool            inner = true;
            for (unsigned int d = 0; d < 3; ++d)
              inner = inner && p[d] > 1e-6 && p[d] < 1. - 1e-6;
            if (inner)
              for (unsigned int d = 0; d < 3; ++d)
                keep_largest(inside,
                             std::abs(wide.local_element(3 * node + d)));
          }
        verdicts.below("patch test: force inside over force on the surface",
                       Utilities::MPI::max(inside, communicator) /
                         largest_entry(wide),
                       1e-12);
      }

    private:
      Vector
      reference(const Simulation &simulation, const Vector &u) const
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const auto  &fe     = discretization.fe;
        const Vector source = with_ghosts(discretization, u);
        Vector       result(discretization.owned_dofs,
                      discretization.relevant_dofs,
                      discretization.grid.communicator());

        FEValues<3>                          values(discretization.mapping,
                           fe,
                           QGauss<3>(discretization.degree + 1),
                           update_gradients | update_JxW_values);
        const FEValuesExtractors::Vector     displacement(0);
        std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
        dealii::Vector<double>               force(fe.n_dofs_per_cell());
        std::vector<SymmetricTensor<2, 3>> strains(values.n_quadrature_points);
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const unsigned int number =
                simulation.model.solid.grid().material(cell);
              const Material &material =
                *simulation.model.solid.materials[number];
              const double factor =
                simulation.run.equation.internal_force.factor_of(number);
              values.reinit(cell);
              values[displacement].get_function_symmetric_gradients(source,
                                                                    strains);
              force = 0.;
              for (const unsigned int q : values.quadrature_point_indices())
                {
                  const auto stress = factor * material.stress(strains[q]);
                  for (const unsigned int i : values.dof_indices())
                    force(i) += stress *
                                values[displacement].symmetric_gradient(i, q) *
                                values.JxW(q);
                }
              cell->get_dof_indices(dofs);
              discretization.hanging_nodes.distribute_local_to_global(force,
                                                                      dofs,
                                                                      result);
            }
        result.compress(VectorOperation::add);
        Vector sorted = discretization.create_vector();
        sorted.copy_locally_owned_data_from(result);
        return sorted;
      }
    };

    // Reference: other program
    const Registry<Check>::Add<Operator>
      registered("operator", "Vectorised operator against a plain one.");
  } // namespace
} // namespace Voussoir
