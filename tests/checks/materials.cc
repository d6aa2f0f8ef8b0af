#include <voussoir/fem/nodal_values.h>
#include <voussoir/materials/crack_directions.h>
#include <voussoir/materials/point_test.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/physics/transformations.h>

#include <random>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Tensor2 = SymmetricTensor<2, 3>;

    Tensor2
    random_strain(std::mt19937 &random, const double size)
    {
      std::normal_distribution<double> normal;
      Tensor2                          strain;
      for (unsigned int i = 0; i < 6; ++i)
        strain.access_raw_entry(i) = size * normal(random);
      return strain;
    }


    Tensor<2, 3>
    random_rotation(std::mt19937 &random)
    {
      std::normal_distribution<double> normal;
      Tensor<1, 3>                     axis;
      for (unsigned int d = 0; d < 3; ++d)
        axis[d] = normal(random);
      return Physics::Transformations::Rotations::rotation_matrix_3d(
        axis / axis.norm(), 1. + normal(random));
    }


    Tensor2
    rotated(const Tensor2 &tensor, const Tensor<2, 3> &rotation)
    {
      return symmetrize(rotation * Tensor<2, 3>(tensor) * transpose(rotation));
    }


    /** Corners of a path of strains, up to several times the elastic range. */
    std::vector<Tensor2>
    random_path(std::mt19937 &random)
    {
      std::vector<Tensor2> corners{Tensor2()};
      for (unsigned int i = 0; i < 8; ++i)
        corners.push_back(random_strain(random, i % 2 == 0 ? 4e-4 : 2e-3));
      return corners;
    }


    constexpr unsigned int steps = 1000; // from corner to corner


    double
    stored(const PointResponse<double> &response)
    {
      return 0.5 * (response.stress * response.elastic_strain);
    }


    /** Calls visit(strain) along a path. */
    void
    follow(const std::vector<Tensor2>                 &corners,
           const std::function<void(const Tensor2 &)> &visit)
    {
      for (unsigned int i = 0; i + 1 < corners.size(); ++i)
        for (unsigned int step = 1; step <= steps; ++step)
          visit(corners[i] +
                (corners[i + 1] - corners[i]) * (double(step) / steps));
    }


    /**
     * Properties of every registered class of materials, with the default
     * entries, classes of other authors included.
     */
    class Materials : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string &name : Registry<Material>::names())
          evaluate(name, {}, file, verdicts, communicator);
        const auto names = Registry<Material>::names();
        for (const std::string name : {"concrete damage", "rock damage"})
          if (std::find(names.begin(), names.end(), name) != names.end())
            evaluate(name,
                     {"Materials/stuff/Crack direction=fixed"},
                     file,
                     verdicts,
                     communicator);
      }

    private:
      void
      evaluate(const std::string              &name,
               const std::vector<std::string> &entries,
               const ParameterFile            &file,
               Verdicts                       &verdicts,
               const MPI_Comm                  communicator) const
      {
        std::vector<std::string> all{"Materials/stuff/Class=" + name};
        all.insert(all.end(), entries.begin(), entries.end());
        std::string title = name;
        for (const std::string &entry : entries)
          title += ", " + entry.substr(entry.rfind('/') + 1);
        const auto      parameters = make_case(file.with(all));
        const Material &material   = *parameters->material_list().at(0);
        evaluate_point(title, material, verdicts);
        evaluate_cells(title, *parameters, verdicts, communicator);
        evaluate_patch(title, *parameters, 1e-5, verdicts, communicator);
        // cracks depend on the size of the cells
        all.push_back("Mesh/box/Distortion=0");
        evaluate_patch(
          title, *make_case(file.with(all)), 1e-3, verdicts, communicator);
      }


      void
      evaluate_point(const std::string &name,
                     const Material    &material,
                     Verdicts          &verdicts) const
      {
        std::mt19937                 random(1);
        const PointSituation<double> situation{1., 1e-3};
        const double modulus = material.elastic_constants().young_modulus;
        double       turned = 0., lost = 0., turnover = 0., flowed = 0.;
        for (unsigned int repetition = 0; repetition < 5; ++repetition)
          {
            const auto          rotation = random_rotation(random);
            std::vector<double> history(material.n_history()), other(history);
            Tensor2             plastic;
            follow(random_path(random), [&](const Tensor2 &strain) {
              const auto response =
                material.respond(strain, history.data(), situation);
              plastic += response.plastic_increment;
              keep_largest(flowed,
                           (strain - response.elastic_strain - plastic).norm());
              const auto turned_response =
                material.respond(rotated(strain, rotation),
                                 other.data(),
                                 situation);
              keep_largest(turned,
                           (rotated(response.stress, rotation) -
                            turned_response.stress)
                               .norm() /
                             (1e-4 * modulus));
              keep_smallest(lost, response.dissipation);
              keep_largest(turnover, stored(response));
            });
          }
        if (material.isotropic())
          verdicts.below(name + ": stress turns with the strain", turned, 1e-9);
        verdicts.below(name + ": energy made, over the largest stored",
                       -lost / turnover,
                       1e-12);
        verdicts.below(name + ": plastic strain less the sum of its increments",
                       flowed,
                       1e-15);

        // to first order in the step
        double error = 0.;
        for (unsigned int repetition = 0; repetition < 5; ++repetition)
          {
            std::vector<double> history(material.n_history());
            Tensor2             last_strain, last_stress;
            double              work = 0., dissipated = 0., largest = 0.;
            follow(random_path(random), [&](const Tensor2 &strain) {
              const auto response =
                material.respond(strain, history.data(), situation);
              work +=
                0.5 * (response.stress + last_stress) * (strain - last_strain);
              dissipated += response.dissipation;
              largest = std::max({largest, stored(response), dissipated});
              keep_largest(error,
                           std::abs(work - dissipated - stored(response)) /
                             largest);
              last_strain = strain;
              last_stress = response.stress;
            });
          }
        verdicts.below(name + ": work less what is stored and lost",
                       error,
                       0.01);

        // elastic waves of all directions are no faster than the P wave
        double fastest = 0.;
        for (unsigned int repetition = 0; repetition < 200; ++repetition)
          {
            const Tensor<2, 3> axes = random_rotation(random);
            Tensor<1, 3>       direction, polarisation;
            for (unsigned int d = 0; d < 3; ++d)
              {
                direction[d]    = axes[d][0];
                polarisation[d] = repetition % 2 == 0 ? axes[d][0] : axes[d][1];
              }
            const Tensor2 strain =
              symmetrize(outer_product(direction, polarisation));
            keep_largest(fastest, material.stress(strain) * strain);
          }
        const ElasticConstants c = material.elastic_constants();
        verdicts.below(
          name + ": speed of waves over that of the P wave, less 1",
          positive_part(std::sqrt(fastest / c.density) / c.p_wave_speed() - 1.),
          1e-9);
      }


      void
      evaluate_cells(const std::string &name,
                     Case              &parameters,
                     Verdicts          &verdicts,
                     const MPI_Comm     communicator) const
      {
        const auto simulation = make_simulation(parameters, communicator);
        const InternalForce &internal = simulation->run.equation.internal_force;
        MaterialMemory       memory   = internal.new_memory();
        const Discretization &discretization =
          simulation->model.solid.discretization;
        const Material &material = *simulation->model.solid.materials[0];

        // a rough field that grows: SIMD lanes against points by themselves
        Vector force = discretization.create_vector(), u = force, plain = force;
        std::map<std::pair<unsigned int, unsigned int>, std::vector<double>>
                                                                histories;
        std::map<std::pair<unsigned int, unsigned int>, double> bands;
        double                                                  worst = 0.;
        for (unsigned int step = 1; step <= 6; ++step)
          {
            for (unsigned int node = 0; node < discretization.n_owned_nodes();
                 ++node)
              {
                const Point<3> &x = discretization.node_positions[node];
                for (unsigned int d = 0; d < 3; ++d)
                  u.local_element(3 * node + d) =
                    (step % 3 == 0 ? -3e-4 : 1e-4) * step *
                    std::sin(3. * x[d] + 2. * x[(d + 1) % 3] + d);
              }
            internal.respond(force, u, memory);
            respond_plainly(*simulation, u, plain, histories, bands);
            plain -= force;
            keep_largest(worst, largest_entry(plain) / largest_entry(force));
          }
        verdicts.below(name + ": force in SIMD lanes against point by point",
                       worst,
                       1e-10);

        if (material.n_history() > 0)
          {
            PointHistory     &history = *memory.of(0);
            const KeyedValues saved   = history.checkpoint_values();
            std::vector<std::vector<double>> kept(saved.items.size());
            for (unsigned int i = 0; i < kept.size(); ++i)
              saved.row(i, kept[i]);
            Vector after = force;
            u *= 1.1;
            internal.respond(after, u, memory);
            for (unsigned int i = 0; i < kept.size(); ++i)
              saved.set(i, kept[i].data());
            Vector again = force;
            internal.respond(again, u, memory);
            again -= after;
            verdicts.below(name + ": force from saved memory",
                           largest_entry(again),
                           1e-12 * largest_entry(after));
          }
      }


      /** A uniform strain: no force inside, under any law. */
      void
      evaluate_patch(const std::string &name,
                     Case              &parameters,
                     const double       size,
                     Verdicts          &verdicts,
                     const MPI_Comm     communicator) const
      {
        const auto simulation = make_simulation(parameters, communicator);
        const Discretization &discretization =
          simulation->model.solid.discretization;
        std::mt19937  random(2);
        const Tensor2 strain = random_strain(random, size);
        Vector        u = discretization.create_vector(), force = u;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Tensor<1, 3> value =
              strain * Tensor<1, 3>(discretization.node_positions[node]);
            for (unsigned int d = 0; d < 3; ++d)
              u.local_element(3 * node + d) = value[d];
          }
        simulation->run.equation.internal_force.respond(
          force, u, simulation->run.state.material_memory);
        double inside = 0.;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &x     = discretization.node_positions[node];
            bool            inner = true;
            for (unsigned int d = 0; d < 3; ++d)
              inner = inner && x[d] > 1e-6 && x[d] < 1. - 1e-6;
            if (inner)
              keep_largest(inside, node_value(force, node).norm());
          }
        verdicts.below(name + ": patch test",
                       Utilities::MPI::max(inside, communicator) /
                         largest_entry(force),
                       1e-10);
      }


      /** Width of the band of a crack in a cell: Oliver's formula as published,
       *  over the corner functions at the centre. */
      static double
      width_across(const Triangulation<3>::active_cell_iterator &cell,
                   const double                                  share,
                   const Tensor<1, 3>                           &normal)
      {
        const FE_Q<3>      corners(1);
        const QMidpoint<3> centre;
        FEValues<3>        values(corners, centre, update_gradients);
        values.reinit(cell);
        double sum = 0.;
        for (const unsigned int a : values.dof_indices())
          sum += std::abs(normal * values.shape_grad(a, 0));
        return 2. / sum * share;
      }


      /** The internal force from points by themselves; of cells with one point,
       *  which has their mean strain, the difference from the elastic force.
       */
      void
      respond_plainly(
        const Simulation &simulation,
        const Vector     &u,
        Vector           &result,
        std::map<std::pair<unsigned int, unsigned int>, std::vector<double>>
                                                                &histories,
        std::map<std::pair<unsigned int, unsigned int>, double> &bands) const
      {
        const Discretization &discretization =
          simulation.model.solid.discretization;
        const auto     &fe        = discretization.fe;
        const Material &material  = *simulation.model.solid.materials[0];
        const auto     &points    = discretization.points(0);
        const bool      one_point = points.size() == 1;
        FEValues<3>     values(discretization.mapping,
                           fe,
                           one_point ? QGauss<3>(2) : points,
                           update_gradients | update_JxW_values);
        const FEValuesExtractors::Vector     displacement(0);
        std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
        std::vector<Tensor2> strains(values.n_quadrature_points);
        if (one_point)
          simulation.run.equation.internal_force.apply(result, u);
        else
          result = 0.;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          {
            values.reinit(cell);
            values[displacement].get_function_symmetric_gradients(u, strains);
            if (one_point)
              {
                Tensor2 sum;
                double  volume = 0.;
                for (const unsigned int q : values.quadrature_point_indices())
                  {
                    sum += strains[q] * values.JxW(q);
                    volume += values.JxW(q);
                  }
                std::fill(strains.begin(), strains.end(), sum / volume);
              }
            cell->get_dof_indices(dofs);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                auto &history = histories[{cell->active_cell_index(), q}];
                history.resize(material.n_history());
                // of the crack that would open, as long as none has opened
                double &band = bands[{cell->active_cell_index(), q}];
                if (std::all_of(history.begin(),
                                history.end(),
                                [](const double number) {
                                  return number == 0.;
                                }))
                  {
                    const auto crack =
                      crack_directions(material.stress(strains[q]));
                    const double share = crack.share_of_tension;
                    band =
                      share * width_across(cell,
                                           discretization.crack_share,
                                           crack.tension) +
                      (1. - share) * width_across(cell,
                                                  discretization.crack_share,
                                                  crack.compression);
                  }
                Tensor2 stress =
                  material.respond(strains[q], history.data(), {band, 1e300})
                    .stress;
                if (one_point)
                  stress -= material.stress(strains[q]);
                for (const unsigned int i : values.dof_indices())
                  result(dofs[i]) +=
                    stress * values[displacement].symmetric_gradient(i, q) *
                    values.JxW(q);
              }
          }
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Materials>
      registered("materials", "Properties of all materials.");
  } // namespace
} // namespace Voussoir
