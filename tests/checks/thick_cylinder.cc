#include <voussoir/materials/material.h>
#include <voussoir/mesh_sources/generator.h>

#include <deal.II/fe/fe_values.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A quarter of a ring about the z axis, one cell thick. */
    class QuarterRing : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Inner radius", inner, "[m]");
        prm.add_parameter("Outer radius", outer, "[m]");
        prm.add_parameter("Cells", cells, "Along the radius and the arc.");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        CoarseMesh         mesh;
        const unsigned int n = cells[0], m = cells[1];
        const auto         vertex = [&](const unsigned int i,
                                const unsigned int j,
                                const unsigned int k) {
          return i + (n + 1) * (j + (m + 1) * k);
        };
        for (unsigned int k = 0; k <= 1; ++k)
          for (unsigned int j = 0; j <= m; ++j)
            for (unsigned int i = 0; i <= n; ++i)
              {
                const double radius = inner + (outer - inner) * i / n,
                             angle  = 0.5 * numbers::PI * j / m;
                mesh.vertices.push_back({j == m ? 0. : radius * std::cos(angle),
                                         radius * std::sin(angle),
                                         k * (outer - inner) / n});
              }
        for (unsigned int j = 0; j < m; ++j)
          for (unsigned int i = 0; i < n; ++i)
            {
              const unsigned int          cell = mesh.cells.size();
              std::array<unsigned int, 8> corners;
              for (unsigned int v = 0; v < 8; ++v)
                corners[v] = vertex(i + (v & 1), j + ((v >> 1) & 1), v >> 2);
              mesh.cells.push_back(corners);
              mesh.cell_sets["ring"].push_back(cell);
              if (i == 0)
                mesh.face_sets["wall"].push_back({cell, 0});
              if (j == 0)
                mesh.face_sets["y plane"].push_back({cell, 2});
              if (j == m - 1)
                mesh.face_sets["x plane"].push_back({cell, 3});
              mesh.face_sets["sides"].push_back({cell, 4});
              mesh.face_sets["sides"].push_back({cell, 5});
            }
        return mesh;
      }

    private:
      double                    inner = 1., outer = 3.;
      std::vector<unsigned int> cells{40, 12};
    };

    const Registry<MeshGenerator>::Add<QuarterRing>
      ring("quarter ring", "For closed forms of thick cylinders.");


    /**
     * Rock around a pressure gallery, in plane strain: the extent of yielding
     * by Mohr and Coulomb, and the stresses, against the closed form. With N =
     * (1 + sin phi) / (1 - sin phi), Y = 2 c sqrt(N) and A = Y / (N - 1), the
     * radial stress inside of the plastic radius R is
     *   A - (A + p) (a / r)^((N - 1) / N) ,
     * and N s_theta - s_r = Y; outside there is Lame's solution for the
     * pressure at R, under which R is about to yield.
     */
    class ThickCylinder : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Inner radius", inner, "[m]");
        prm.add_parameter("Outer radius", outer, "[m]");
        prm.add_parameter("Cohesion", cohesion, "[Pa]");
        prm.add_parameter("Friction angle", friction_angle, "[degrees]");
        prm.add_parameter("Pressure", pressure, "[Pa]");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const Discretization &discretization =
          simulation->model.solid.discretization;
        const Material     &material = *simulation->model.solid.materials[0];
        const PointHistory &history =
          *simulation->run.state.material_memory.of(0);
        FEValues<3>  values(discretization.mapping,
                           discretization.fe,
                           discretization.matrix_free.quadrature,
                           update_gradients | update_JxW_values |
                             update_quadrature_points);
        const double expected = plastic_radius();
        Vector displacement   = simulation->static_state.initial.displacement;
        displacement.update_ghost_values();

        double yielded = 0., volume = 0., error = 0.;
        std::vector<SymmetricTensor<2, 3>> strains(values.n_quadrature_points);
        for (const auto &[cell, place] : history.cells())
          {
            values.reinit(cell);
            values[FEValuesExtractors::Vector(0)]
              .get_function_symmetric_gradients(displacement, strains);
            // the mean over a cell, which is closer than single points
            Point<3> centre;
            double   stress = 0., size = 0.;
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const Point<3> point  = values.quadrature_point(q);
                const double   part   = values.JxW(q);
                Tensor<1, 3>   radial = point;
                radial[2]             = 0.;
                radial /= radial.norm();
                std::vector<double> memory = history.read(place, q);
                if (memory[6] > 1e-7)
                  yielded += part;
                size += part;
                centre += part * point;
                stress +=
                  part * (radial *
                          (material.respond(strains[q], memory.data(), {1., 0.})
                             .stress *
                           radial));
              }
            centre[2] = 0.;
            const double miss =
              stress / size - radial_stress(centre.norm() / size, expected);
            error += miss * miss * size;
            volume += size;
          }
        yielded = Utilities::MPI::sum(yielded, communicator);
        error   = Utilities::MPI::sum(error, communicator);
        volume  = Utilities::MPI::sum(volume, communicator);
        // the part of the volume that has yielded
        const double measured = std::sqrt(
          inner * inner + (outer * outer - inner * inner) * yielded / volume);
        verdicts.near("plastic radius", measured, expected, 0.02, "m");
        verdicts.below("radial stress less the closed form, root of the mean "
                       "square over the pressure",
                       std::sqrt(error / volume) / pressure,
                       0.01);
      }

    private:
      double
      factor() const // N
      {
        const double sine = std::sin(friction_angle * numbers::PI / 180.);
        return (1. + sine) / (1. - sine);
      }

      double
      hoop_share(const double radius) const // Lame: s_theta = -share * s_r
      {
        const double squares = outer * outer;
        return (squares + radius * radius) / (squares - radius * radius);
      }

      double
      plastic_stress(const double radius) const
      {
        const double n = factor(), a = 2. * cohesion * std::sqrt(n) / (n - 1.);
        return a - (a + pressure) * std::pow(inner / radius, (n - 1.) / n);
      }

      double
      plastic_radius() const
      {
        const double n = factor(), y = 2. * cohesion * std::sqrt(n);
        double       low = inner, high = outer;
        for (unsigned int i = 0; i < 60; ++i)
          {
            const double radius = 0.5 * (low + high);
            // beyond yield if there is no more plastic flow at this radius
            if (-plastic_stress(radius) * (n * hoop_share(radius) + 1.) > y)
              low = radius;
            else
              high = radius;
          }
        return low;
      }

      double
      radial_stress(const double radius, const double end) const
      {
        if (radius < end)
          return plastic_stress(radius);
        const double squares = outer * outer;
        return plastic_stress(end) * (squares / (radius * radius) - 1.) /
               (squares / (end * end) - 1.);
      }

      double inner = 1., outer = 3., cohesion = 1e6, friction_angle = 30.,
             pressure = 1.38e6;
    };

    // Reference: closed form
    const Registry<Check>::Add<ThickCylinder>
      registered("thick cylinder", "Plastic radius around a gallery.");
  } // namespace
} // namespace Voussoir
