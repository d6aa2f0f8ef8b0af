#include <voussoir/analysis/eigensolver.h>
#include <voussoir/analysis/measured_shapes.h>
#include <voussoir/analysis/modal_system.h>
#include <voussoir/analysis/modes.h>
#include <voussoir/base/error.h>
#include <voussoir/base/json_entries.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/nodal_values.h>

#include <deal.II/base/timer.h>

#include <algorithm>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The wanted modes and some more, which speed up the iteration. The model
     *  must have three times as many unknowns as wanted modes. */
    unsigned int
    block_size(const ModalSystem &system, const unsigned int number)
    {
      const auto moving = system.n_with_mass();
      if (3 * number > moving)
        throw UserError("\"Number\" in section \"Modes\" is " +
                        std::to_string(number) + ", but the model has only " +
                        counted(moving, "unknown", "unknowns") +
                        " with mass; set at most " +
                        std::to_string(moving / 3) + " modes, or refine.");
      return std::min<types::global_dof_index>(number +
                                                 std::max(3u, number / 4),
                                               moving / 3);
    }


    /** b = (M + M_a) r of unit motions r of all nodes, fixed ones too, in x,
     *  y and z. */
    using Momenta = std::array<ModalSystem::Motion, 3>;


    /** A mode from an eigenvector with phi^T (M + M_a) phi = 1. */
    Mode
    make_mode(const double               eigenvalue,
              const double               residual,
              const ModalSystem::Motion &motion,
              const ModalSystem         &system,
              const Momenta             &momenta,
              const Vector              &orientation)
    {
      ModalSystem::Motion momentum(motion.size());
      system.mass(momentum.data(), motion.data());
      Vector       shape   = system.displacement(motion);
      const Vector inertia = system.solid_part(momentum);
      Tensor<1, 3> factors; // phi^T b
      for (unsigned int d = 0; d < 3; ++d)
        factors[d] = system.product(motion, momenta[d]);
      const double largest =
        std::copysign(largest_amount(shape), inertia * orientation);
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


    /** Effective over moving mass; 0 in directions without moving mass. */
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
    if (!measured_shapes.empty())
      result["measured shapes"] = measured_shapes;
    return result;
  }


  void
  check_modes(const ModalModel &model, const ModeParameters &parameters)
  {
    block_size(ModalSystem(model, parameters), parameters.number);
    MeasuredShapes(model, parameters);
    if (model.reservoir == nullptr)
      return;
    bool surface = false;
    for (const double value : model.reservoir->inverse_storage)
      surface = surface || value == 0.;
    if (Utilities::MPI::logical_or(surface, model.solid.grid().communicator()))
      return;
    throw UserError("\"Free surface\" in section \"Reservoir\" names no faces "
                    "of the water, which cannot move without a surface in the "
                    "natural modes; name some, or set \"Water = none\" in "
                    "section \"Modes\".");
  }


  namespace
  {
    /** Returns the warnings. */
    std::vector<std::string>
    report_ties(const ModalSystem &system, Log &log)
    {
      const ModalSystem::TiedPoints &points = system.tied_points();
      if (points.all == 0)
        return {};
      log.line("Modes: ",
               points.tied,
               " of ",
               points.all,
               " points of the interfaces are tied");
      if (!points.bars)
        return {};
      return {
        "the natural modes are those without the bars across open "
        "interfaces; set \"Interfaces = all tied\" in section \"Modes\" to "
        "include them"};
    }


    /** Residuals fall by about the same factor in each iteration. */
    void
    report_progress(const unsigned int    iterations,
                    const unsigned int    found,
                    const double          residual,
                    const ModeParameters &parameters,
                    const double          seconds,
                    Log                  &log)
    {
      if (!log.progress_is_due())
        return;
      const double done =
        std::clamp(std::log(residual) / std::log(parameters.tolerance),
                   1e-3,
                   1.);
      std::ostringstream text;
      text << std::setprecision(2) << "of the modes: " << found << " of "
           << parameters.number << " found in " << iterations
           << " iterations, residual " << residual << ", time left "
           << duration_text(seconds * (1. - done) / done);
      log.progress(done, text.str());
    }
  } // namespace


  Modes
  find_modes(const ModalModel     &model,
             const ModeParameters &parameters,
             Log                  &log)
  {
    const Timer clock;
    ModalSystem system(model, parameters);
    Modes       modes;
    modes.warnings = report_ties(system, log);
    system.set_up();
    auto         start = system.start(block_size(system, parameters.number));
    const Vector orientation = system.solid_part(start[0]);
    const Eigenpairs pairs =
      find_lowest({[&](double *force, const double *motion) {
                     system.stiffness(force, motion);
                   },
                   [&](double *momentum, const double *motion) {
                     system.mass(momentum, motion);
                   },
                   [&](double *motion, const double *force) {
                     system.precondition(motion, force);
                   },
                   system.size(),
                   model.solid.grid().communicator(),
                   [&](const unsigned int iterations,
                       const unsigned int found,
                       const double       residual) {
                     report_progress(iterations,
                                     found,
                                     residual,
                                     parameters,
                                     clock.wall_time(),
                                     log);
                   }},
                  std::move(start),
                  parameters.number,
                  parameters.tolerance);

    Momenta momenta;
    for (unsigned int d = 0; d < 3; ++d)
      {
        // sum of (phi^T b)^2 over all modes
        momenta[d] = system.rigid_momentum(d);
        modes.moving_mass[d] =
          system.product(momenta[d], system.divided_by_mass(momenta[d]));
      }
    for (unsigned int j = 0; j < parameters.number; ++j)
      modes.list.push_back(make_mode(pairs.values[j],
                                     pairs.residuals[j],
                                     pairs.vectors[j],
                                     system,
                                     momenta,
                                     orientation));

    modes.measured_shapes =
      MeasuredShapes(model, parameters).nearest(modes.list);

    std::ostringstream text;
    text << std::setprecision(4) << "Modes: " << modes.list.size() << " in "
         << pairs.iterations << " iterations, "
         << duration_text(clock.wall_time())
         << "; effective masses over the mass that can move, "
         << modes.moving_mass[0] << ", " << modes.moving_mass[1] << ", "
         << modes.moving_mass[2] << " kg in x, y, z";
    if (system.has_added_mass())
      text << ", the moving water included";
    log.line(text.str());
    log(table(modes));
    for (const auto &[name, found] : modes.measured_shapes.items())
      log.line("Modes: the measured shape \"",
               name,
               "\" is nearest to mode ",
               found.at("mode").get<unsigned int>(),
               ", with a modal assurance criterion of ",
               found.at("modal assurance criterion [-]").get<double>());
    return modes;
  }
} // namespace Voussoir
