#include <voussoir/base/usual_range.h>
#include <voussoir/constraints/projection.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/time_factor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** u = u(0) + d (g(t) - g(0)) in chosen components on the nodes of face
     *  sets. */
    class PrescribedMotion : public Projection
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets",
                          face_sets,
                          "Face sets of prescribed motion.");
        prm.add_parameter("Components",
                          components,
                          "Components that are prescribed, of x, y and z; the "
                          "others are free.",
                          Patterns::MultipleSelection("x|y|z"));
        prm.add_parameter("Displacement",
                          displacement,
                          "Displacement at factor 1, x, y, z [m], from the "
                          "positions at rest." +
                            usually(Usual::displacement));
        factor.declare(
          prm,
          "Time function",
          "Factor on the displacement; its value at t = 0 is subtracted.");
      }

      void
      prepare(const Discretization &discretization,
              const LumpedMass     &lumped_mass,
              const ParameterFile &,
              const std::string &place) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        mass       = &lumped_mass;
        exact_sums = discretization.reproducible;
        take_components(place);
        moved_nodes =
          owned_carriers(discretization,
                         nodes_of_faces(discretization,
                                        split_list(face_sets),
                                        "\"Face sets\" in section \"" + place +
                                          "\""));
        refuse_fixed(discretization.grid.communicator(), place);
      }

      const std::vector<unsigned int> &
      nodes() const override
      {
        return moved_nodes;
      }

      std::array<bool, 3>
      prescribed_components() const override
      {
        return prescribed;
      }

      void
      prepare_step(const InverseMass &inverse_mass, const double) override
      {
        // the impulse in these components, p = A_P dv_P, moves the others where
        // added mass or dashpots couple them: dv = H p
        unit_impulses.clear();
        responses.clear();
        for (const unsigned int node : moved_nodes)
          {
            const Tensor<2, 3> H = inverse_mass(node);
            Tensor<2, 3>       of_prescribed;
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int e = 0; e < 3; ++e)
                if (acts(H, d) && acts(H, e))
                  of_prescribed[d][e] = H[d][e];
                else
                  of_prescribed[d][e] = d == e;
            Tensor<2, 3> impulse = invert(of_prescribed);
            for (unsigned int d = 0; d < 3; ++d)
              if (!acts(H, d))
                impulse[d] = Tensor<1, 3>();
            unit_impulses.push_back(impulse);
            responses.push_back(H);
          }
      }

      Result
      project(State &state, const double time_step) override
      {
        Result result;
        result.work      = Sum(exact_sums);
        const double now = state.time, before = now - time_step;
        const auto   rate = [&](const double end) {
          return (factor(end) - factor(end - time_step)) / time_step;
        };
        const Tensor<1, 3> velocity = rate(now) * displacement;
        // velocity of the half step before, by the same rule, or at rest
        const Tensor<1, 3> last_velocity = before < 0.5 * time_step ?
                                             Tensor<1, 3>() :
                                             rate(before) * displacement;
        for (unsigned int i = 0; i < moved_nodes.size(); ++i)
          {
            const unsigned int first = 3 * moved_nodes[i];
            Tensor<1, 3>       change;
            for (unsigned int d = 0; d < 3; ++d)
              if (prescribed[d])
                change[d] =
                  velocity[d] - state.velocity.local_element(first + d);
            const Tensor<1, 3> impulse = unit_impulses[i] * change;
            change                     = responses[i] * impulse;
            for (unsigned int d = 0; d < 3; ++d)
              {
                state.velocity.local_element(first + d) += change[d];
                state.displacement.local_element(first + d) +=
                  time_step * change[d];
              }
            result.impulse += impulse;
            result.work += 0.5 * (impulse * (velocity + last_velocity));
          }
        return result;
      }

    private:
      bool
      acts(const Tensor<2, 3> &inverse_mass, const unsigned int d) const
      {
        return prescribed[d] && inverse_mass[d][d] > 0.;
      }

      void
      take_components(const std::string &place)
      {
        const auto list = split_list(components);
        if (list.empty())
          throw UserError("\"Components\" in section \"" + place +
                          "\" is empty, so that nothing is prescribed; name "
                          "some of x, y and z.");
        for (unsigned int d = 0; d < 3; ++d)
          {
            const std::string axis(1, "xyz"[d]);
            prescribed[d] =
              std::find(list.begin(), list.end(), axis) != list.end();
            if (!prescribed[d] && displacement[d] != 0.)
              throw UserError("\"Displacement\" in section \"" + place +
                              "\" moves the faces along " + axis +
                              ", which is not among the \"Components\"; add "
                              "it there, or give 0.");
          }
      }

      /** Nodes of a support cannot move. */
      void
      refuse_fixed(const MPI_Comm communicator, const std::string &place) const
      {
        std::array<unsigned int, 3> fixed{{0, 0, 0}};
        for (const unsigned int node : moved_nodes)
          for (unsigned int d = 0; d < 3; ++d)
            if (displacement[d] != 0. &&
                mass->mass.local_element(3 * node + d) == 0.)
              fixed[d] = 1;
        for (unsigned int d = 0; d < 3; ++d)
          if (Utilities::MPI::max(fixed[d], communicator) > 0)
            throw UserError("\"Displacement\" in section \"" + place +
                            "\" moves nodes along " + "xyz"[d] +
                            " that a support of section \"Boundaries\" fixes; "
                            "leave one of them out.");
      }

      std::string         face_sets, components = "x, y, z";
      Tensor<1, 3>        displacement;
      TimeFactor          factor;
      std::array<bool, 3> prescribed{};

      bool                      exact_sums = false; // of the work
      const LumpedMass         *mass       = nullptr;
      std::vector<unsigned int> moved_nodes;

      // of each node: impulse over change of velocity, and its inverse
      std::vector<Tensor<2, 3>> unit_impulses, responses;
    };

    const Registry<Projection>::Add<PrescribedMotion>
      registered_prescribed_motion(
        "prescribed motion",
        "Nodes of face sets follow a given displacement over time, in "
        "all components or some.");
  } // namespace
} // namespace Voussoir
