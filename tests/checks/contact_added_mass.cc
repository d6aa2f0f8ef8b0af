#include <voussoir/mesh_sources/generator.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A block on a base of the same size, of 2 x 2 cells each; the side at
     *  large y, "face", of the block leans outwards. */
    class Overhang : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Slope", slope, "Way outwards over the height.");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        CoarseMesh mesh;
        for (const double z : {0., 1., 2., 3.})
          for (const double y : {0., 1., 2.})
            for (const double x : {0., 1., 2.})
              mesh.vertices.emplace_back(
                x, y * (1. + 0.5 * slope * std::max(0., z - 1.)), z);
        for (unsigned int k = 0; k < 3; ++k)
          for (unsigned int j = 0; j < 2; ++j)
            for (unsigned int i = 0; i < 2; ++i)
              {
                const unsigned int          cell = mesh.cells.size();
                std::array<unsigned int, 8> corners;
                for (unsigned int v = 0; v < 8; ++v)
                  corners[v] =
                    i + (v & 1) + 3 * (j + ((v >> 1) & 1)) + 9 * (k + (v >> 2));
                mesh.cells.push_back(corners);
                mesh.cell_sets[k == 0 ? "base" : "block"].push_back(cell);
                if (k == 0)
                  mesh.face_sets["bottom"].push_back({cell, 4});
                else if (j == 1)
                  mesh.face_sets["face"].push_back({cell, 3});
              }
        return mesh;
      }

    private:
      double slope = 0.5;
    };

    const Registry<MeshGenerator>::Add<Overhang>
      registered_mesh("overhang", "A block with a leaning face, for tests.");


    /**
     * Contact where the mass of a node is no multiple of the identity, because
     * of the added mass of water on a slanted face. The step is compared with
     * equations (14) to (16) of the paper, C p = -g / dt^2 with C = R (M1^-1 +
     * M2^-1) R^T , from the dense masses and from the motion of the same blocks
     * without contact.
     */
    class AddedMassContact : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        // sticking by friction, sliding, without friction
        for (const auto &[name, friction] :
             std::vector<std::pair<std::string, double>>{{"sticking", 100.},
                                                         {"sliding", 0.3},
                                                         {"smooth", 0.}})
          {
            const auto with = [&](const double gap) {
              return file.with(
                {"Interfaces/plane/Initial gap=" + std::to_string(gap),
                 "Interfaces/plane/Friction coefficient=" +
                   std::to_string(friction)});
            };
            const auto meeting = make_case(with(0.));
            const auto apart   = make_case(with(10.));
            const auto joined  = make_simulation(*meeting, communicator);
            const auto free    = make_simulation(*apart, communicator);
            for (Simulation *simulation : {joined.get(), free.get()})
              {
                throw_down(*simulation);
                simulation->run.scheme.step(simulation->run.state);
              }
            compare(name, friction, *joined, *free, verdicts);
          }
      }

    private:
      /** Gives the block a velocity into the base and along it. */
      static void
      throw_down(Simulation &simulation)
      {
        const auto &discretization = simulation.model.solid.discretization;
        const Tensor<1, 3> v({0.2, -0.1, -1.});
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->center()[2] > 1.)
            for (const auto global : discretization.cell_nodes(cell))
              {
                const unsigned int node = discretization.owned_node(global);
                for (unsigned int d = 0; d < 3; ++d)
                  simulation.run.state.velocity.local_element(3 * node + d) =
                    v[d];
              }
        simulation.run.contact->start(simulation.run.state);
      }

      static Tensor<2, 3>
      inverse_mass(const Simulation &simulation, const unsigned int node)
      {
        Tensor<2, 3> mass;
        for (unsigned int d = 0; d < 3; ++d)
          mass[d][d] =
            simulation.model.solid.mass.mass.local_element(3 * node + d);
        const auto slot = simulation.model.terms.slot_at(node);
        if (slot)
          mass += Tensor<2, 3>(simulation.model.terms.added_mass[*slot]);
        return invert(mass);
      }

      /** The force of C p = -g / dt^2 with friction: the root of
       *  p = projection of p - r (g / dt^2 + C p), by iteration. */
      static Tensor<1, 3>
      dense_force(const Tensor<2, 3> &C,
                  const Tensor<1, 3> &gap,
                  const double        friction)
      {
        Tensor<1, 3> p;
        const double r = 1. / trace(C);
        for (unsigned int i = 0; i < 10000; ++i)
          {
            p -= r * (gap + C * p);
            keep_largest(p[0], 0.);
            const double shear = std::hypot(p[1], p[2]),
                         limit = friction * p[0];
            if (shear > limit)
              for (const unsigned int d : {1, 2})
                p[d] *= limit / shear;
          }
        return p;
      }

      static void
      compare(const std::string &name,
              const double       friction,
              const Simulation  &joined,
              const Simulation  &free,
              Verdicts          &verdicts)
      {
        const double dt              = joined.run.time_step.length;
        const auto  &contact         = *joined.run.contact;
        const auto  &discretization  = joined.model.solid.discretization;
        const auto   displacement_at = [](const Simulation  &simulation,
                                        const unsigned int node) {
          Tensor<1, 3> u;
          for (unsigned int d = 0; d < 3; ++d)
            u[d] =
              simulation.run.state.displacement.local_element(3 * node + d);
          return u;
        };
        double force_error = 0., largest_force = 0., motion_error = 0.,
               largest_motion = 0., coupling = 0.;
        unsigned int with_water = 0;
        for (unsigned int k = 0; k < contact.points().size(); ++k)
          {
            const ContactPoint &point = contact.points()[k];
            const unsigned int  first =
              discretization.owned_node(contact.first_nodes()[k]);
            unsigned int second = 0;
            while (second == first ||
                   contact.positions()[k].distance(
                     discretization.node_positions[second]) > 1e-9)
              ++second;
            const Tensor<2, 3> H1   = inverse_mass(joined, first),
                               H2   = inverse_mass(joined, second);
            const Tensor<2, 3> &R   = point.frame;
            const Tensor<2, 3>  C   = R * (H1 + H2) * transpose(R);
            const Tensor<1, 3>  gap = R * (displacement_at(free, second) -
                                          displacement_at(free, first));
            // after one step friction has followed the pressure so far
            const double wave_speed = std::sqrt(1e9 / 2.4 / 2400.),
                         followed   = -std::expm1(-dt * wave_speed / 4.);
            const Tensor<1, 3> p =
              dense_force(dt * dt * C, gap, followed * friction);
            keep_largest(force_error, (p - point.force).norm());
            keep_largest(largest_force, p.norm());

            const Tensor<1, 3> global = p * R;
            for (const bool on_second : {false, true})
              {
                const unsigned int node = on_second ? second : first;
                const Tensor<1, 3> move = (on_second ? dt * dt : -dt * dt) *
                                          ((on_second ? H2 : H1) * global);
                keep_largest(motion_error,
                             (displacement_at(free, node) + move -
                              displacement_at(joined, node))
                               .norm());
                keep_largest(largest_motion, move.norm());
              }
            const double across = std::hypot(C[1][0], C[2][0]) / C[0][0];
            keep_largest(coupling, across);
            with_water += across > 1e-6 ? 1 : 0;
          }
        verdicts.above(name + ": slip by normal force over its closing",
                       coupling,
                       0.1);
        verdicts.near(name + ": points with water", with_water, 3., 0.);
        verdicts.below("  force over the largest, difference",
                       force_error / largest_force,
                       1e-9);
        verdicts.below("  motion over the largest, difference",
                       motion_error / largest_motion,
                       1e-9);
      }
    };

    // Reference: other program
    const Registry<Check>::Add<AddedMassContact>
      registered("contact added mass",
                 "A step of contact with water on a leaning face.");
  } // namespace
} // namespace Voussoir
