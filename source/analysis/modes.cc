#include <voussoir/analysis/eigensolver.h>
#include <voussoir/analysis/elastic_solver.h>
#include <voussoir/analysis/modes.h>
#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/lumped_mass.h>
#include <voussoir/fem/nodal_values.h>

#include <deal.II/base/timer.h>

#include <algorithm>
#include <iomanip>
#include <random>

namespace Voussoir
{
  using namespace dealii;

  void
  ModeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Number",
                      number,
                      "How many of the lowest natural modes to compute; 0: "
                      "none. Absorbing faces are held in them, and the moduli "
                      "are those given.",
                      Patterns::Integer(0, 1000));
    prm.add_parameter("Held materials",
                      held_materials,
                      "Materials that do not move in the modes, separated by "
                      "commas: rigid rock.");
    prm.add_parameter("Massless materials",
                      massless_materials,
                      "Materials that are elastic but without mass in the "
                      "modes, separated by commas.");
    prm.add_parameter("Water",
                      water,
                      "Whether the water that moves with the dam counts; false "
                      "for the modes of the empty reservoir.");
    prm.add_parameter("Relative tolerance",
                      tolerance,
                      "Residual |K phi - omega^2 M phi| over |K phi|; the "
                      "frequencies are closer by far.",
                      Patterns::Double(1e-12, 1e-2));
  }


  void
  ModeParameters::check(const std::vector<std::string> &materials,
                        const BoundaryParameters       &boundaries) const
  {
    if (number == 0)
      return;
    const auto check_names = [&](const std::string &entry,
                                 const std::string &names) {
      for (const std::string &name : split_list(names))
        if (std::find(materials.begin(), materials.end(), name) ==
            materials.end())
          throw UserError("\"" + entry + "\" in section \"Modes\" names \"" +
                          name +
                          "\", which is not among the \"Names\" of section "
                          "\"Materials\"" +
                          known_names(name, materials) + ".");
    };
    check_names("Held materials", held_materials);
    check_names("Massless materials", massless_materials);
    if (split_list(held_materials).empty() && boundaries.empty())
      throw UserError("Section \"Modes\" asks for modes of a model that "
                      "nothing holds; name faces in section \"Boundaries\", or "
                      "\"Held materials\" in section \"Modes\".");
  }


  namespace
  {
    std::vector<bool>
    among(const std::vector<std::string> &materials, const std::string &names)
    {
      std::vector<bool> result(materials.size(), false);
      for (const std::string &name : split_list(names))
        result[std::find(materials.begin(), materials.end(), name) -
               materials.begin()] = true;
      return result;
    }


    AffineConstraints<double>
    modal_constraints(const ModalModel &model, const ModeParameters &parameters)
    {
      const auto held = among(model.material_names, parameters.held_materials);
      return model.discretization.make_constraints(
        model.boundaries.supports_with_absorbing(false),
        [&](const Grid::Cell &cell) {
          return held[model.material_of_cell(cell)];
        });
    }


    /** Zero where nothing can move. */
    Vector
    structural_mass(const ModalModel                &model,
                    const ModeParameters            &parameters,
                    const AffineConstraints<double> &constraints)
    {
      const auto massless =
        among(model.material_names, parameters.massless_materials);
      std::vector<double> density;
      for (unsigned int m = 0; m < massless.size(); ++m)
        density.push_back(massless[m] ? 0. :
                                        model.materials[m]->inertial_density());
      Vector mass = LumpedMass(model.discretization,
                               density,
                               density,
                               model.material_of_cell)
                      .mass;
      for (unsigned int i = 0; i < mass.locally_owned_size(); ++i)
        if (constraints.is_constrained(
              model.discretization.owned_dofs.nth_index_in_set(i)))
          mass.local_element(i) = 0.;
      return mass;
    }


    /** Modes wanted and some more, which speed up the iteration. Three times
     *  that many directions must be there. */
    unsigned int
    block_size(const Vector &mass, const unsigned int number)
    {
      types::global_dof_index moving = 0;
      for (const double entry : mass)
        moving += entry > 0.;
      moving = Utilities::MPI::sum(moving, mass.get_mpi_communicator());
      if (3 * number > moving)
        throw UserError("\"Number\" in section \"Modes\" is " +
                        std::to_string(number) + ", but the model has only " +
                        counted(moving, "unknown", "unknowns") +
                        " with mass; ask for at most " +
                        std::to_string(moving / 3) + " modes, or refine.");
      return std::min<types::global_dof_index>(number +
                                                 std::max(3u, number / 4),
                                               moving / 3);
    }


    bool
    has_added_mass(const ModalModel &model)
    {
      double largest = 0.;
      for (const NodalTerms::Matrix &added : model.terms.added_mass)
        largest = std::max(largest, added.norm());
      return Utilities::MPI::max(largest,
                                 model.discretization.grid.communicator()) > 0.;
    }


    /** The product with M + M_a. */
    class ModalMass
    {
    public:
      ModalMass(const Vector        &structure,
                const NodalTerms    *water,
                const ElasticSolver &solver)
        : structure(structure)
        , water(water)
        , solver(solver)
      {}

      void
      operator()(Vector &momentum, const Vector &velocity) const
      {
        momentum = velocity;
        momentum.scale(structure);
        if (water == nullptr)
          return;
        for (unsigned int slot = 0; slot < water->nodes.size(); ++slot)
          {
            const unsigned int first = 3 * water->nodes[slot];
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int e = 0; e < 3; ++e)
                momentum.local_element(first + d) +=
                  water->added_mass[slot][d][e] *
                  velocity.local_element(first + e);
          }
        solver.clear_held(momentum);
      }

    private:
      const Vector        &structure;
      const NodalTerms    *water;
      const ElasticSolver &solver;
    };


    /**
     * Displacements under forces that vary in waves of arbitrary direction over
     * the mass: smooth, without symmetry, the same on any number of ranks.
     */
    std::vector<Vector>
    start_vectors(const Discretization &discretization,
                  const Vector         &mass,
                  const ElasticSolver  &solver,
                  const ModalMass      &modal_mass,
                  const unsigned int    number)
    {
      std::vector<double> moments(7);
      for (unsigned int node = 0; node < discretization.n_owned_nodes(); ++node)
        {
          const Point<3> &x = discretization.node_positions[node];
          double          m = 0.; // a roller may hold some of the directions
          for (unsigned int d = 0; d < 3; ++d)
            m += mass.local_element(3 * node + d);
          moments[6] += m;
          for (unsigned int d = 0; d < 3; ++d)
            {
              moments[d] += m * x[d];
              moments[3 + d] += m * x[d] * x[d];
            }
        }
      moments = sum_over_ranks(moments, discretization.grid.communicator());
      Point<3>     centre;
      Tensor<1, 3> extent; // standard deviations
      for (unsigned int d = 0; d < 3; ++d)
        {
          centre[d] = moments[d] / moments[6];
          extent[d] = std::sqrt(
            std::max(0., moments[3 + d] / moments[6] - centre[d] * centre[d]));
        }
      const double smallest = 0.01 * extent.norm();

      std::mt19937 generator(1); // raw numbers, which are the same everywhere
      const auto   draw = [&] { return generator() / 2147483648. - 1.; };
      std::vector<Vector> result(number, discretization.create_vector());
      Vector              wave(result[0]), force(result[0]);
      for (Vector &vector : result)
        {
          for (unsigned int d = 0; d < 3; ++d)
            {
              Tensor<1, 3> wave_number;
              for (unsigned int e = 0; e < 3; ++e)
                wave_number[e] = 2. * numbers::PI / 3. * draw() /
                                 std::max(extent[e], smallest);
              const double phase = numbers::PI * draw();
              for (unsigned int node = 0; node < discretization.n_owned_nodes();
                   ++node)
                wave.local_element(3 * node + d) = std::cos(
                  wave_number * (discretization.node_positions[node] - centre) +
                  phase);
            }
          modal_mass(force, wave);
          solver.precondition(vector, force);
        }
      return result;
    }


    /** r^T (M + M_a) r of a rigid motion r in one direction of all that is not
     *  held, which the effective masses of all modes add up to [kg]. */
    double
    moving_mass(const unsigned int   direction,
                const Vector        &mass,
                const ModalMass     &modal_mass,
                const ElasticSolver &solver)
    {
      Vector motion(mass), momentum(mass);
      motion = 0.;
      for (unsigned int i = direction; i < motion.locally_owned_size(); i += 3)
        motion.local_element(i) = 1.;
      solver.clear_held(motion);
      modal_mass(momentum, motion);
      return momentum * motion;
    }


    /** A mode from an eigenvector with phi^T (M + M_a) phi = 1. */
    Mode
    make_mode(const double     eigenvalue,
              const double     residual,
              Vector           shape,
              const ModalMass &modal_mass,
              const Vector    &orientation)
    {
      Vector momentum(shape);
      modal_mass(momentum, shape);
      const Tensor<1, 3> factors = resultant(momentum); // phi^T (M + M_a) r
      const double       largest =
        std::copysign(largest_amount(shape), momentum * orientation);
      shape /= largest;

      Mode mode{std::sqrt(eigenvalue) / (2. * numbers::PI),
                std::move(shape),
                1. / (largest * largest),
                residual,
                factors * largest,
                {}};
      for (unsigned int d = 0; d < 3; ++d)
        mode.effective_mass[d] = factors[d] * factors[d];
      return mode;
    }


    /** Effective over moving mass; 0 where nothing can move. */
    Tensor<1, 3>
    share(const Tensor<1, 3> &mass, const Tensor<1, 3> &moving_mass)
    {
      Tensor<1, 3> result;
      for (unsigned int d = 0; d < 3; ++d)
        if (moving_mass[d] > 0.)
          result[d] = mass[d] / moving_mass[d];
      return result;
    }


    std::string
    table(const Modes &modes)
    {
      std::ostringstream text;
      text << "  mode        Hz         s  effective mass x, y, z [%]"
              "   cumulative x, y, z [%]   residual\n";
      Tensor<1, 3> sum;
      for (unsigned int j = 0; j < modes.list.size(); ++j)
        {
          const Mode &mode = modes.list[j];
          sum += mode.effective_mass;
          text << std::setw(6) << j + 1 << std::fixed << std::setprecision(4)
               << std::setw(10) << mode.frequency << std::setw(10)
               << 1. / mode.frequency << "  " << std::setprecision(2);
          for (unsigned int d = 0; d < 3; ++d)
            text << std::setw(8)
                 << 100. * share(mode.effective_mass, modes.moving_mass)[d];
          text << "   ";
          for (unsigned int d = 0; d < 3; ++d)
            text << std::setw(8) << 100. * share(sum, modes.moving_mass)[d];
          text << std::scientific << std::setprecision(1) << std::setw(11)
               << mode.residual << '\n';
        }
      return text.str();
    }


    nlohmann::json
    to_json(const Tensor<1, 3> &values)
    {
      return {values[0], values[1], values[2]};
    }
  } // namespace


  std::vector<double>
  Modes::frequencies() const
  {
    std::vector<double> values;
    for (const Mode &mode : list)
      values.push_back(mode.frequency);
    return values;
  }


  nlohmann::json
  Modes::summary() const
  {
    nlohmann::json result;
    result["moving mass [kg]"] = to_json(moving_mass);
    Tensor<1, 3> sum;
    for (const Mode &mode : list)
      {
        sum += mode.effective_mass;
        result["modes"].push_back(
          {{"frequency [Hz]", mode.frequency},
           {"period [s]", 1. / mode.frequency},
           {"modal mass [kg]", mode.mass},
           {"participation factors", to_json(mode.participation)},
           {"effective mass [-]",
            to_json(share(mode.effective_mass, moving_mass))},
           {"cumulative effective mass [-]", to_json(share(sum, moving_mass))},
           {"residual", mode.residual}});
      }
    return result;
  }


  void
  check_modes(const ModalModel &model, const ModeParameters &parameters)
  {
    block_size(structural_mass(model,
                               parameters,
                               modal_constraints(model, parameters)),
               parameters.number);
  }


  Modes
  find_modes(const ModalModel     &model,
             const ModeParameters &parameters,
             Log                  &log)
  {
    const Discretization &discretization = model.discretization;
    const Timer           clock;
    const InternalForce   moduli_as_given = model.internal_force.with(
      std::vector<StiffnessFactors>(model.materials.size()));

    const auto          constraints = modal_constraints(model, parameters);
    const ElasticSolver solver(discretization,
                               moduli_as_given,
                               model.materials,
                               model.material_of_cell,
                               constraints,
                               nullptr);
    const Vector        mass = structural_mass(model, parameters, constraints);
    const ModalMass     modal_mass(mass,
                               parameters.water ? &model.terms : nullptr,
                               solver);

    const std::vector<Vector> start =
      start_vectors(discretization,
                    mass,
                    solver,
                    modal_mass,
                    block_size(mass, parameters.number));
    const Eigenpairs pairs =
      find_lowest({[&](Vector &force, const Vector &displacement) {
                     solver.apply(force, displacement);
                     solver.clear_held(force);
                   },
                   modal_mass,
                   [&](Vector &displacement, const Vector &force) {
                     solver.precondition(displacement, force);
                   }},
                  start,
                  parameters.number,
                  parameters.tolerance);

    Modes modes;
    for (unsigned int d = 0; d < 3; ++d)
      modes.moving_mass[d] = moving_mass(d, mass, modal_mass, solver);
    for (unsigned int j = 0; j < parameters.number; ++j)
      modes.list.push_back(make_mode(pairs.values[j],
                                     pairs.residuals[j],
                                     pairs.vectors[j],
                                     modal_mass,
                                     start[0]));

    std::ostringstream text;
    text << std::setprecision(4) << "Modes: " << modes.list.size() << " in "
         << pairs.iterations << " iterations, "
         << duration_text(clock.wall_time())
         << "; effective masses over the mass that can move, "
         << modes.moving_mass[0] << ", " << modes.moving_mass[1] << ", "
         << modes.moving_mass[2] << " kg in x, y, z";
    if (parameters.water && has_added_mass(model))
      text << ", the water that moves along included";
    log.line(text.str());
    log(table(modes));
    return modes;
  }
} // namespace Voussoir
