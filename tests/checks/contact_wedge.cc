#include <voussoir/mesh_sources/generator.h>

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A wedge in a notch: a prism along y whose section is a triangle with the
     * apex below, on two planes that rise to the left and to the right of it;
     * a layer of cells under the planes supports it.
     */
    class Wedge : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Left dip", left, "Dip of the left plane [degrees].");
        prm.add_parameter("Right dip",
                          right,
                          "Dip of the right plane [degrees].");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        const double   radians = numbers::PI / 180.;
        const Point<2> apex(0., 0.),
          a(-height / std::tan(left * radians), height),
          b(height / std::tan(right * radians), height);
        const Point<2> half_a(0.5 * a), half_b(0.5 * b), top(0.5 * (a + b)),
          middle((a + b) / 3.);
        const Tensor<1, 2> down({0., -0.25 * height});

        // the triangle as three quadrilaterals, then the cells below
        const std::vector<std::array<Point<2>, 4>> quads = {
          {{apex, half_b, half_a, middle}},
          {{half_a, middle, a, top}},
          {{half_b, b, middle, top}},
          {{half_a + down, apex + down, half_a, apex}},
          {{a + down, half_a + down, a, half_a}},
          {{apex + down, half_b + down, apex, half_b}},
          {{half_b + down, b + down, half_b, b}}};
        CoarseMesh            mesh;
        std::vector<Point<2>> corners;
        const auto number = [&](const Point<2> &point, const unsigned int j) {
          unsigned int i = 0;
          while (i < corners.size() && corners[i].distance(point) > 1e-9)
            ++i;
          if (i == corners.size())
            {
              corners.push_back(point);
              for (unsigned int k = 0; k <= n; ++k)
                mesh.vertices.emplace_back(point[0], length * k / n, point[1]);
            }
          return i * (n + 1) + j;
        };
        for (unsigned int q = 0; q < quads.size(); ++q)
          for (unsigned int j = 0; j < n; ++j)
            {
              const unsigned int          cell = mesh.cells.size();
              std::array<unsigned int, 8> vertices;
              for (unsigned int v = 0; v < 8; ++v)
                vertices[v] =
                  number(quads[q][(v & 1) + 2 * (v >> 2)], j + ((v >> 1) & 1));
              mesh.cells.push_back(vertices);
              mesh.cell_sets[q < 3 ? "wedge" : "support"].push_back(cell);
              if (q >= 3)
                {
                  mesh.face_sets["bottom"].push_back({cell, 4});
                  mesh.face_sets[q < 5 ? "left" : "right"].push_back({cell, 5});
                }
              else if (j == 0)
                mesh.face_sets["back"].push_back({cell, 2});
            }
        return mesh;
      }

    private:
      static constexpr double       height = 6., length = 12.;
      static constexpr unsigned int n = 4;

      double left = 45., right = 45.;
    };

    const Registry<MeshGenerator>::Add<Wedge>
      registered_mesh("wedge", "A wedge on two planes, for tests.");


    /**
     * The wedge against limit equilibrium. The frame is that of the sliding
     * line y, which is level; the weight is tilted by its plunge.
     *
     * The elastic wedge in its static state also carries shear across the line,
     * so that the forces of each plane are not those of limit equilibrium; but
     * the block's safety, which follows from their resultant, is. A push from
     * behind, which grows slowly, then lowers the safety below one. The shear
     * across the line presses on the planes and adds a little to their
     * resistance, until the wedge has slipped so far that all shear is along
     * the line.
     */
    class WedgeSafety : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Plunge", plunge, "Plunge of the line [degrees].");
        prm.add_parameter("Friction", friction, "Left, right.");
        prm.add_parameter("Cohesion", cohesion, "Left, right [Pa].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double radians = numbers::PI / 180.;
        const double down    = gravity * std::cos(plunge * radians),
                     along   = gravity * std::sin(plunge * radians);
        const double left =
          std::stod(file.given("Mesh/wedge/Left dip", "45")) * radians;
        const double right =
          std::stod(file.given("Mesh/wedge/Right dip", "45")) * radians;
        const double section =
          0.5 * height * height * (1. / std::tan(left) + 1. / std::tan(right));
        const double mass = density * length * section;

        // across the line: N1 n1 + N2 n2 = weight, with n1 = (sin l, cos l),
        // n2 = (-sin r, cos r)
        const double N1 =
          mass * down * std::sin(right) / std::sin(left + right);
        const double N2 = mass * down * std::sin(left) / std::sin(left + right);
        const double resistance =
          friction[0] * N1 + friction[1] * N2 +
          length * height *
            (cohesion[0] / std::sin(left) + cohesion[1] / std::sin(right));
        const double safety = resistance / (mass * along);
        verdicts.above("safety factor of limit equilibrium", safety, 1.);

        const auto reduced = [&](const double factor) {
          std::vector<std::string> changes;
          for (const unsigned int side : {0, 1})
            {
              const std::string place =
                side == 0 ? "Interfaces/left/" : "Interfaces/right/";
              std::ostringstream f, c;
              f.precision(17);
              c.precision(17);
              f << place << "Friction coefficient=" << friction[side] / factor;
              c << place << "Cohesion=" << cohesion[side] / factor;
              changes.push_back(f.str());
              changes.push_back(c.str());
            }
          changes.push_back(vector_entry("Loads/weight/Acceleration",
                                         Tensor<1, 3>({0., along, -down})));
          return changes;
        };
        verdicts.is_true("strength over 0.99 F: it stays",
                         stands(file.with(reduced(0.99 * safety)),
                                communicator));

        // a pressure on its back grows slowly beyond the resistance
        const double       excess = 0.5 * mass * along;
        const double       push   = resistance - mass * along + excess;
        std::ostringstream pressure, history;
        pressure.precision(17);
        pressure << "Loads/push/Pressure=" << push / section;
        history << "Loads/push/Time function=min(t / " << ramp << ", 1)";
        auto changes = reduced(1.);
        changes.push_back(pressure.str());
        changes.push_back(history.str());
        const auto parameters = make_case(file.with(changes));
        const auto simulation = make_simulation(*parameters, communicator);
        verdicts.near("static state: safety factor of the block",
                      block_safety(*simulation, "wedge: left, right"),
                      safety,
                      0.01);

        double              resisting = 0., N_left = 0., N_right = 0.;
        unsigned int        samples = 0;
        std::vector<double> times, motion;
        double              at_start = 0., before = 0.;
        while (simulation->run.state.time < parameters->time.end_time)
          {
            simulation->run.scheme.step(simulation->run.state);
            const double time = simulation->run.state.time;
            const double load =
              resistance / (mass * along + push * std::min(time / ramp, 1.));
            if (load > 1.05)
              before = mean_motion(*simulation)[1];
            if (at_start == 0. &&
                block_safety(*simulation, "wedge: left, right") < 1.001)
              at_start = load;
            if (time < ramp)
              continue;
            times.push_back(time);
            motion.push_back(mean_motion(*simulation)[1]);
            const ContactSums on_left  = contact_sums(*simulation, 0),
                              on_right = contact_sums(*simulation, 1);
            resisting -= on_left.force[1] + on_right.force[1];
            N_left += on_left.pressure;
            N_right += on_right.pressure;
            ++samples;
          }
        // the acceleration follows from the displacements at the ends and in
        // the middle of two equal intervals
        const unsigned int half = (samples - 1) / 2;
        const double       step = times[half] - times[0];
        // elastic; the wedge ends half a metre away
        verdicts.below("motion while the load leaves a safety of 1.05 [mm]",
                       1e3 * before,
                       0.05);
        // The points that stick under the weight are not unique, and on other
        // numbers of ranks their forces differ by some thousandths.
        const auto off = [&](const std::string &name,
                             const double       value,
                             const double       reference,
                             const double       tolerance) {
          verdicts.below(name + ", off its reference by",
                         std::abs(value / reference - 1.),
                         tolerance);
        };
        off("starts to slide at a safety under the load of 1",
            at_start,
            1.,
            0.02);
        off("sliding: resistance over driving weight",
            resisting / samples / (mass * along),
            safety,
            0.01);
        off("  normal force on the left", N_left / samples, N1, 0.01);
        off("  normal force on the right", N_right / samples, N2, 0.01);
        off("  acceleration",
            (motion[2 * half] - 2. * motion[half] + motion[0]) / (step * step),
            excess / mass,
            0.01);
        verdicts.below(
          "penetration over cell size",
          Utilities::MPI::max(simulation->run.contact->effort().penetration,
                              communicator) /
            simulation->run.contact->cell_size(),
          1e-12);
      }

    private:
      static constexpr double gravity = 9.81, density = 2700., height = 6.,
                              length = 12., ramp = 1.; // [s]

      double       plunge = 20.;
      Tensor<1, 2> friction{{0.6, 0.6}}, cohesion;
    };

    // Reference: closed form
    const Registry<Check>::Add<WedgeSafety>
      registered("contact wedge", "A wedge against limit equilibrium.");
  } // namespace
} // namespace Voussoir
