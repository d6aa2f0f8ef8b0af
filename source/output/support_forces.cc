#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/fem/nodal_values.h>
#include <voussoir/output/table_observer.h>
#include <voussoir/time/central_difference.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string supports_entry =
      "\"Face sets\" in section \"Output/support forces\"";

    /**
     * Forces of supports and prescribed motions on the model, by face set. At a
     * fixed node the force is the residual of its equation of motion,
     *   R = M a_base + f(u) - F(t) ,
     * and the reaction of the static stages; at a prescribed node it is the
     * impulse of a step over its length.
     */
    class SupportForces : public TableObserver
    {
    public:
      SupportForces()
        : TableObserver("support_forces.csv", 0.01)
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Face sets",
          face_sets,
          "Faces that a support of section \"Boundaries\" or a prescribed "
          "motion constrains; for each of them support_forces.csv has the "
          "force of the support on the model, x, y, z [MN]; static state, "
          "loads and inertia of its nodes included. An edge of several sets "
          "counts for the first of them.");
        declare_interval(prm,
                         "Time between two lines of support_forces.csv [s].");
      }

      double
      record_interval() const override
      {
        return interval;
      }

      void
      check(const ObservedModel &model) const override
      {
        nodes_of_sets(model);
      }

      void
      observe(const State &state) override
      {
        // forces belong to the beginning of the step that ends with the state
        const bool is_first = !has_step;
        has_step            = true;
        if (is_first)
          return;
        const unsigned long long step = state.step - 1;
        if (!is_due(step))
          return;
        const double       time         = state.time - run().time_step;
        const Tensor<1, 3> acceleration = run().base.acceleration(time);
        std::vector<Sum>   forces       = no_sums(3 * supports.size());
        auto               force        = forces.begin();
        for (const Support &support : supports)
          {
            Tensor<1, 3> sum = support.at_rest;
            for (unsigned int d = 0; d < 3; ++d)
              sum[d] += support.fixed_mass[d] * acceleration[d];
            for (const unsigned int node : support.nodes)
              sum += run().scheme.support_force(state, node);
            for (unsigned int d = 0; d < 3; ++d)
              *force++ += 1e-6 * sum[d];
          }
        take({time, has_line(step), forces, {}});
      }

    private:
      struct Support
      {
        std::string               name;
        std::vector<unsigned int> nodes;      // of this rank
        Tensor<1, 3>              at_rest;    // of the static stages [N]
        Tensor<1, 3>              fixed_mass; // to which a rigid base gives
                                              // inertial force [kg]
      };

      void
      prepare() override
      {
        supports.clear();
        has_step                        = false;
        const auto                nodes = nodes_of_sets(run());
        const std::vector<double> mass  = driven_mass();
        std::vector<std::string>  columns;
        for (const auto &[name, list] : nodes)
          {
            Support support{name, list, {}, {}};
            for (const unsigned int node : list)
              for (unsigned int d = 0; d < 3; ++d)
                if (is_fixed(run().solid.discretization, node, d))
                  {
                    support.fixed_mass[d] += mass[node];
                    if (run().initial.reaction.size() > 0)
                      support.at_rest[d] +=
                        run().initial.reaction.local_element(3 * node + d);
                  }
            supports.push_back(support);
            for (unsigned int d = 0; d < 3; ++d)
              columns.push_back(name + ' ' + "xyz"[d] + " [MN]");
          }
        keep(extremes, columns.size());
        open_table(columns);
      }

      std::vector<double>
      line_of(const Sample &sample) override
      {
        extremes.take(sample.sums);
        return sample.sums;
      }

      void
      conclude(const State &, nlohmann::json &summary) override
      {
        const auto &[largest, smallest] = extremes;
        if (supports.empty() || largest[0] < smallest[0])
          return;
        auto &result = summary["support forces"];
        for (unsigned int i = 0; i < supports.size(); ++i)
          for (unsigned int d = 0; d < 3; ++d)
            {
              const std::string axis(1, "xyz"[d]);
              auto             &support             = result[supports[i].name];
              support["largest " + axis + " [MN]"]  = largest[3 * i + d];
              support["smallest " + axis + " [MN]"] = smallest[3 * i + d];
            }
      }

      static bool
      is_fixed(const Discretization &discretization,
               const unsigned int    node,
               const unsigned int    d)
      {
        return discretization.constraints.is_constrained(
          discretization.owned_dofs.nth_index_in_set(3 * node + d));
      }

      /** The owned nodes of each set, each node once. */
      std::vector<std::pair<std::string, std::vector<unsigned int>>>
      nodes_of_sets(const ObservedModel &model) const
      {
        const Discretization &discretization = model.solid.discretization;
        const MPI_Comm        communicator = discretization.grid.communicator();
        std::set<unsigned int> prescribed, of_interfaces, taken;
        for (const auto &[name, constraint] : model.constraints)
          prescribed.insert(constraint->nodes().begin(),
                            constraint->nodes().end());
        if (model.interfaces != nullptr)
          of_interfaces.insert(model.interfaces->nodes().begin(),
                               model.interfaces->nodes().end());
        std::vector<std::pair<std::string, std::vector<unsigned int>>> result;
        const auto sets = split_list(face_sets);
        if (sets.empty())
          throw UserError(supports_entry + " is empty; name a face set.");
        for (const std::string &set : sets)
          {
            bool                      is_free = false, meets_interface = false;
            std::vector<unsigned int> nodes;
            for (const unsigned int node : owned_carriers(
                   discretization,
                   nodes_of_faces(discretization, {set}, supports_entry)))
              {
                is_free = is_free || !(prescribed.count(node) > 0 ||
                                       is_fixed(discretization, node, 0) ||
                                       is_fixed(discretization, node, 1) ||
                                       is_fixed(discretization, node, 2));
                meets_interface =
                  meets_interface || of_interfaces.count(node) > 0;
                if (taken.insert(node).second)
                  nodes.push_back(node);
              }
            if (Utilities::MPI::logical_or(is_free, communicator))
              throw UserError(
                supports_entry + " names \"" + set +
                "\", on which neither a support of section "
                "\"Boundaries\" nor a prescribed motion constrains all nodes; "
                "name faces that are fixed.");
            if (Utilities::MPI::logical_or(meets_interface, communicator))
              throw UserError(supports_entry + " names \"" + set +
                              "\", whose nodes an interface touches, the "
                              "forces of which cannot be separated there; "
                              "name faces away from interfaces.");
            result.emplace_back(set, nodes);
          }
        return result;
      }

      /** Mass of each owned node, including fixed nodes; zero where a rigid
       *  base exerts no inertial force [kg]. */
      std::vector<double>
      driven_mass() const
      {
        const Solid          &solid          = run().solid;
        const Discretization &discretization = solid.discretization;
        std::vector<double>   mass(discretization.n_owned_nodes(), 0.);
        if (!run().base_moves)
          return mass;
        NodalVolumes nodal_volumes(discretization);
        std::vector<std::pair<types::global_dof_index, double>> records;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              const Material &material = solid.material_of(cell);
              if (material.inertia_factor < 1.)
                continue;
              const auto &volumes = nodal_volumes.of(cell);
              const auto  nodes   = discretization.cell_nodes(cell);
              for (unsigned int j = 0; j < nodes.size(); ++j)
                for (const auto &share : discretization.carriers(nodes[j]))
                  records.emplace_back(share.node,
                                       share.weight * material.density *
                                         volumes[j]);
            }
        for (const auto &[node, part] : discretization.send_to_owners(records))
          mass[node] += part;
        return mass;
      }

      std::string face_sets;

      bool                 has_step = false;
      std::vector<Support> supports;
      Extremes             extremes;
    };

    const Registry<Observer>::Add<SupportForces> registered_support_forces(
      "support forces",
      "Forces of supports and prescribed motions over time, in "
      "support_forces.csv.");
  } // namespace
} // namespace Voussoir
