#include <voussoir/base/time_factor.h>
#include <voussoir/constraints/projection.h>
#include <voussoir/fem/named_sets.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** u = d g(t) on the nodes of face sets. */
    class PrescribedMotion : public Projection
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets", face_sets, "Face sets that move so.");
        prm.add_parameter("Displacement",
                          displacement,
                          "Displacement at factor 1, x, y, z [m].");
        factor.declare(prm, "Time function", "Factor on the displacement.");
      }

      void
      prepare(const Discretization &discretization,
              const LumpedMass     &lumped_mass,
              const ParameterFile &,
              const std::string &place) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        mass               = &lumped_mass;
        const auto &scalar = discretization.fe.base_element(0);
        std::set<types::global_dof_index> face_nodes;
        for_each_face(discretization,
                      split_list(face_sets),
                      "\"Face sets\" in section \"" + place + "\"",
                      [&](const auto &cell, const unsigned int face) {
                        const auto cell_nodes = discretization.cell_nodes(
                          discretization.dof_cell(cell));
                        for (unsigned int j = 0; j < cell_nodes.size(); ++j)
                          if (scalar.has_support_on_face(j, face))
                            face_nodes.insert(cell_nodes[j]);
                      });
        moved_nodes = owned_carriers(discretization, face_nodes);
      }

      const std::vector<unsigned int> &
      nodes() const override
      {
        return moved_nodes;
      }

      bool
      prescribes() const override
      {
        return true;
      }

      Result
      project(State &state, const double time_step) override
      {
        Result             result;
        const Tensor<1, 3> target = factor(state.time) * displacement;
        // of the half step before, by the same rule, or at rest
        const double       before = state.time - time_step;
        const Tensor<1, 3> last_velocity =
          before < 0.5 * time_step ?
            Tensor<1, 3>() :
            (factor(before) - factor(before - time_step)) / time_step *
              displacement;
        for (const unsigned int node : moved_nodes)
          for (unsigned int d = 0; d < 3; ++d)
            {
              const unsigned int entry = 3 * node + d;
              double            &u = state.displacement.local_element(entry);
              double            &v = state.velocity.local_element(entry);
              const double       wanted = v + (target[d] - u) / time_step;
              const double       impulse =
                mass->mass.local_element(entry) * (wanted - v);
              result.impulse[d] += impulse;
              result.work += impulse * 0.5 * (wanted + last_velocity[d]);
              u = target[d];
              v = wanted;
            }
        return result;
      }

    private:
      std::string  face_sets;
      Tensor<1, 3> displacement;
      TimeFactor   factor;

      const LumpedMass         *mass = nullptr;
      std::vector<unsigned int> moved_nodes;
    };

    const Registry<Projection>::Add<PrescribedMotion>
      registered("prescribed motion",
                 "Nodes of face sets follow a given displacement over time.");
  } // namespace
} // namespace Voussoir
