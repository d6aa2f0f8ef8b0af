#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A material that cracks on an elastic one, both with the same moduli. With
     * one point where elastic, nodes inside each material have the same forces
     * as if all cells were of its kind, and a constant strain gives no force
     * inside, nor between the two.
     */
    class MixedPoints : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Level",
          level,
          "Between the materials; nodes within 0.1 m are left out [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto with = [&](const std::string &quadrature) {
          return make_case(
            file.with({"Discretization/Quadrature=" + quadrature}));
        };
        const auto mixed     = with("one point where elastic");
        const auto one_point = with("one point"), gauss = with("Gauss");
        const auto of_mixed     = make_simulation(*mixed, communicator);
        const auto of_one_point = make_simulation(*one_point, communicator);
        const auto of_gauss     = make_simulation(*gauss, communicator);

        const Discretization &discretization =
          of_mixed->model.solid.discretization;
        const Vector force   = response(*of_mixed, bent);
        const Vector elastic = response(*of_one_point, bent);
        const Vector cracked = response(*of_gauss, bent);
        const double size    = largest_entry(force);
        double       below = 0., above = 0., kinds = 0.;
        for_each_entry(
          discretization, [&](const Point<3> &p, const unsigned int i) {
            const double f = force.local_element(i);
            if (p[2] < level - 0.1)
              keep_largest(below, std::abs(f - elastic.local_element(i)));
            if (p[2] > level + 0.1)
              keep_largest(above, std::abs(f - cracked.local_element(i)));
            keep_largest(kinds,
                         std::abs(elastic.local_element(i) -
                                  cracked.local_element(i)));
          });
        verdicts.below("elastic part against one point everywhere, relative",
                       below / size,
                       1e-12);
        verdicts.below("cracked part against eight points everywhere, relative",
                       above / size,
                       1e-12);
        verdicts.above("one point against eight, relative", kinds / size, 0.01);

        const auto constant = response(*of_mixed, stretched);
        double     inside   = 0.;
        for_each_entry(discretization,
                       [&](const Point<3> &p, const unsigned int i) {
                         bool inner = true;
                         for (unsigned int d = 0; d < 3; ++d)
                           inner = inner && p[d] > 1e-6 && p[d] < 1. - 1e-6;
                         if (inner)
                           keep_largest(inside,
                                        std::abs(constant.local_element(i)));
                       });
        verdicts.below(
          "constant strain: force inside over force on the surface",
          inside / largest_entry(constant),
          1e-12);
      }

    private:
      double level = 0.5;

      /** Far beyond the strength, displacement [m]. */
      static Tensor<1, 3>
      bent(const Point<3> &p)
      {
        return Tensor<1, 3>({1e-3 * std::sin(3. * p[0]) * std::cos(2. * p[1]),
                             1e-3 * p[0] * p[2],
                             1e-3 * p[2] * p[2] + 5e-4 * p[1]});
      }

      /** Far below the strength. */
      static Tensor<1, 3>
      stretched(const Point<3> &p)
      {
        return Tensor<1, 3>({3e-7 * p[0] + 2e-7 * p[1],
                             1e-7 * p[2] - 4e-7 * p[0],
                             7e-7 * p[1] + 5e-7 * p[2]});
      }

      template <typename Visit>
      static void
      for_each_entry(const Discretization &discretization, const Visit &visit)
      {
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          for (unsigned int d = 0; d < 3; ++d)
            visit(discretization.node_positions[node], 3 * node + d);
      }

      /** Force [N] of the laws from initial internal variables. */
      static Vector
      response(
        const Simulation                                    &simulation,
        const std::function<Tensor<1, 3>(const Point<3> &)> &displacement)
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        Vector u = discretization.create_vector(), force(u);
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Tensor<1, 3> value =
              displacement(discretization.node_positions[node]);
            for (unsigned int d = 0; d < 3; ++d)
              u.local_element(3 * node + d) = value[d];
          }
        MaterialMemory memory =
          simulation.run.equation.internal_force.new_memory();
        simulation.run.equation.internal_force.respond(force, u, memory);
        return force;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<MixedPoints>
      registered("mixed points",
                 "One integration point where elastic, eight elsewhere.");
  } // namespace
} // namespace Voussoir
