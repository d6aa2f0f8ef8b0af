#include <voussoir/base/error.h>
#include <voussoir/base/gravity.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/forces_over_time.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** rho g at the nodes, lumped like the mass. */
    class Gravity : public ForcesOverTime
    {
    public:
      Gravity()
        : ForcesOverTime("")
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Cell sets",
          cell_sets,
          "Cell sets that have weight; empty for all cells. "
          "Usually the dam alone, as the settlement of the rock is long past.");
        prm.add_parameter("Acceleration",
                          acceleration,
                          "Acceleration of gravity, x, y, z [m/s2]." +
                            usually(Usual::acceleration));
        factor.declare(
          prm,
          "Time function",
          "Factor on the acceleration, for weight that belongs to no static "
          "stage but is applied over time; empty: the load belongs to a "
          "static stage.");
      }

      bool
      steady() const override
      {
        return !factor.given();
      }

      bool
      over_time() const override
      {
        return factor.given();
      }

      void
      prepare(const Solid &solid,
              const ParameterFile &,
              const std::string &place,
              Log               &log) override
      {
        check(place, log);
        if (factor.given())
          factor.prepare("\"Time function\" in section \"" + place + "\"");
        const Discretization &discretization = solid.discretization;
        NodalVolumes          nodal_volumes(discretization);
        double                mass_of_cells = 0.;
        std::vector<std::pair<types::global_dof_index, double>> records;
        for_each_cell(discretization,
                      split_list(cell_sets),
                      "\"Cell sets\" in section \"" + place + "\"",
                      [&](const Discretization::Cell &cell) {
                        const double density = solid.material_of(cell).density;
                        mass_of_cells += density * cell->measure();
                        const auto &volumes = nodal_volumes.of(cell);
                        const auto  nodes   = discretization.cell_nodes(cell);
                        for (unsigned int j = 0; j < nodes.size(); ++j)
                          for (const auto &share :
                               discretization.carriers(nodes[j]))
                            records.emplace_back(share.node,
                                                 share.weight * density *
                                                   volumes[j]);
                      });
        weight =
          Utilities::MPI::sum(mass_of_cells, solid.grid().communicator()) *
          acceleration;
        mass.assign(discretization.n_owned_nodes(), 0.);
        for (const auto &[node, part] : discretization.send_to_owners(records))
          mass[node] += part;
        if (!factor.given())
          return;
        for (unsigned int node = 0; node < mass.size(); ++node)
          if (mass[node] > 0.)
            nodal_forces.emplace_back(node, mass[node] * acceleration);
      }

      void
      add_steady_force(Vector &force) const override
      {
        if (factor.given())
          return;
        for (unsigned int node = 0; node < mass.size(); ++node)
          for (unsigned int d = 0; d < 3; ++d)
            force.local_element(3 * node + d) += mass[node] * acceleration[d];
      }

      std::optional<Tensor<1, 3>>
      resultant_of_geometry() const override
      {
        return weight;
      }

    private:
      void
      check(const std::string &place, Log &log) const
      {
        const std::string entry =
          "\"Acceleration\" in section \"" + place + "\" is ";
        if (acceleration.norm() == 0.)
          throw UserError(entry +
                          "zero, so that there is no weight; give that of "
                          "gravity, 0, 0, -9.81, or leave the load "
                          "out.");
        // gravity may be inclined, or above 1 g as for a pseudo-static
        // earthquake
        if (acceleration.norm() < 5. || acceleration.norm() > 20.)
          log.warn(entry,
                   acceleration,
                   " m/s2, but gravity on earth is 0 0 -9.81 m/s2");
        else if (-acceleration[2] < 0.5 * acceleration.norm())
          log.warn(entry,
                   acceleration,
                   " m/s2, which does not point downwards; z is upwards, so "
                   "that gravity is 0 0 -9.81 m/s2");
      }

      std::string         cell_sets;
      Tensor<1, 3>        acceleration{{0., 0., -standard_gravity}};
      Tensor<1, 3>        weight; // by volume [N]
      std::vector<double> mass;   // of each owned node [kg]
    };

    const Registry<Load>::Add<Gravity>
      registered_gravity("gravity", "Weight of the material.");
  } // namespace
} // namespace Voussoir
