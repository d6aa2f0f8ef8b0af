#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Internal forces in single precision against those in double precision,
     * relative to the largest: under a smooth displacement, elastic and far
     * beyond the strength; with a translation a million times as large added;
     * and with the damping memory of two materials.
     */
    class SinglePrecision : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string quadrature :
             {"Gauss", "Gauss-Lobatto", "one point", "one point where elastic"})
          {
            const auto parameters =
              make_case(file.with({"Discretization/Quadrature=" + quadrature}));
            const auto simulation = make_simulation(*parameters, communicator);
            const Vector small    = displacement(*simulation, 1e-6, 0.),
                         large    = displacement(*simulation, 1e-3, 0.),
                         moved    = displacement(*simulation, 1e-6, 1.),
                         slow     = displacement(*simulation, 3e-7, 0.);
            // some cells must be in single precision, otherwise the comparison
            // is empty
            verdicts.above(quadrature + ": elastic, not the same arithmetic",
                           difference(*simulation, small),
                           1e-9);
            verdicts.below(quadrature + ": elastic",
                           difference(*simulation, small),
                           1e-6);
            verdicts.below(quadrature + ": elastic, with a translation",
                           difference(*simulation, moved),
                           1e-6);
            verdicts.below(quadrature + ": elastic, damped",
                           difference(*simulation, small, &slow),
                           1e-6);
            verdicts.below(quadrature + ": beyond the strength",
                           difference(*simulation, large),
                           1e-6);
          }
      }

    private:
      static Vector
      displacement(const Simulation &simulation,
                   const double      size,
                   const double      translation)
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        Vector u = discretization.create_vector();
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3>    &p = discretization.node_positions[node];
            const Tensor<1, 3> value(
              {translation + size * std::sin(3. * p[0]) * std::cos(2. * p[1]),
               size * p[0] * p[2],
               size * p[2] * p[2] + 0.5 * size * p[1]});
            for (unsigned int d = 0; d < 3; ++d)
              u.local_element(3 * node + d) = value[d];
          }
        return u;
      }

      static double
      difference(const Simulation &simulation,
                 const Vector     &u,
                 const Vector     *damping_memory = nullptr)
      {
        Vector       force = response(simulation, u, damping_memory, false);
        const double size  = largest_entry(force);
        force -= response(simulation, u, damping_memory, true);
        return largest_entry(force) / size;
      }

      static Vector
      response(const Simulation &simulation,
               const Vector     &u,
               const Vector     *damping_memory,
               const bool        single_precision)
      {
        const InternalForce &internal_force =
          simulation.run.equation.internal_force;
        Vector force = simulation.model.solid.discretization.create_vector();
        SweepInput input =
          damping_memory == nullptr ?
            SweepInput::undamped(u) :
            SweepInput{u, u, SweepInput::Damping::by_material, damping_memory};
        input.single_precision = single_precision;
        MaterialMemory memory  = internal_force.new_memory();
        internal_force.sweep(
          force,
          input,
          memory,
          [&](const unsigned int begin, const unsigned int end) {
            std::fill(force.begin() + begin, force.begin() + end, 0.);
          },
          {});
        return force;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<SinglePrecision>
      registered("single precision",
                 "Internal forces in single and in double precision.");
  } // namespace
} // namespace Voussoir
