#include <voussoir/base/error.h>
#include <voussoir/driver/acceptance.h>
#include <voussoir/driver/run.h>
#include <voussoir/driver/verdict_tables.h>
#include <voussoir/materials/point_test.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/signals/fourier.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Limits that the program sets itself. Energy: runs warn above these limits
    // (see Supervision). Below a scaled Jacobian of a tenth a cell is close to
    // flat.
    constexpr double most_energy = 0.01, most_of_losses = 0.03,
                     least_jacobian = 0.1, intensity_carried = 0.9,
                     most_slip = 0.5;

    // Smaller openings and slips arise from elastic deformation of the mesh
    // [mm]; a surface that slides faster at the end has not come to rest
    // [mm/s].
    constexpr double visible = 0.1, at_rest = 1.;


    /** Largest stress of this sign in a uniaxial test far beyond the elastic
     *  limit [Pa]; 0 without such a limit. */
    double
    strength_of(const Material &material, const double band, const double sign)
    {
      constexpr double       sample = 1e6, short_band = 1e-3; // [Pa], [m]
      constexpr unsigned int n_steps = 300, n_at_limit = 50;
      const double modulus = material.elastic_constants().young_modulus;
      SymmetricTensor3<double> stress;
      stress[2][2]       = sign * sample;
      const double ratio = material.yield_ratio(stress, short_band);
      if (!(material.yield_ratio(2. * stress, short_band) > 1.9 * ratio))
        return 0.;
      PointTest           test(material, band, 1.);
      PointTest::Controls controls; // stresses of zero
      controls[2].is_strain = true;
      double most           = 0.;
      try
        {
          for (unsigned int i = 1; i <= n_steps; ++i)
            {
              controls[2].value = sign * sample / ratio / modulus * double(i) /
                                  double(n_at_limit);
              test.advance(controls);
              most = std::max(most, sign * test.stress[2][2]);
            }
        }
      catch (const UserError &)
        {
          // the strength is exhausted
        }
      return most;
    }


    /** Reduction of a strength in cells with this width of the crack band,
     *  against short cells [%]. */
    double
    lowered_by(const Material &material, const double band, const double sign)
    {
      const double in_short = strength_of(material, 1e-3, sign),
                   in_cells = strength_of(material, band, sign);
      return in_cells < in_short ? 100. * (1. - in_cells / in_short) : 0.;
    }


    /** Strength reduced by long cells. */
    struct LoweredStrength
    {
      double          share    = 0.; // [%]
      unsigned int    material = 0;
      const Material *law      = nullptr; // law of the run or of the static
                                          // state
      double sign = 1.;                   // tension
      double band = 0.;                   // widest [m]
    };


    /** The largest reduction. */
    LoweredStrength
    most_lowered_strength(const Model &model)
    {
      LoweredStrength           most;
      const std::vector<double> bands = model.widest_crack_bands();
      for (unsigned int m = 0; m < bands.size(); ++m)
        if (model.solid.materials[m]->n_history() > 0 && bands[m] > 0.)
          for (const Material *law :
               {model.solid.materials[m], &model.solid.materials[m]->at_rest()})
            for (const double sign : {1., -1.})
              if (const double share = lowered_by(*law, bands[m], sign);
                  most.law == nullptr || share > most.share)
                most = {share, m, law, sign, bands[m]};
      return most;
    }


    /** The refinement of cells that preserves a strength, and its cost: each
     *  halving makes eight cells of one and at most doubles the number of
     *  steps. */
    std::string
    remedy_for(const LoweredStrength &lowered, const Model &model)
    {
      constexpr unsigned int most_halvings = 10;
      unsigned int           n             = 1;
      while (n < most_halvings && lowered_by(*lowered.law,
                                             std::ldexp(lowered.band, -int(n)),
                                             lowered.sign) > most_lowered)
        ++n;
      double own = 0., all = 0.;
      for (const auto &cell :
           model.grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            all += 1.;
            own += model.grid.material(cell) == lowered.material ? 1. : 0.;
          }
      const double share = Utilities::MPI::sum(own, model.grid.communicator()) /
                           Utilities::MPI::sum(all, model.grid.communicator());
      const double more = 1. + share * (std::ldexp(1., 3 * n) - 1.);

      std::vector<std::string> items;
      for (const std::string &set :
           split_list(model.parameters.materials.objects[lowered.material]
                        .second->cell_sets))
        items.push_back(set + ": " + std::to_string(n));
      return "cells of at most " +
             number_text(std::ldexp(lowered.band, -int(n))) +
             " m keep it (\"Local refinement = " + join(items, "; ") +
             "\" in section \"Mesh\"), with about " + number_text(more) +
             " times as many cells in all and up to " +
             number_text(std::ldexp(1., n)) +
             " times as many steps; section \"Mesh/Refine where\" refines only "
             "those that a linear run, a cell set or a formula chooses";
    }


    /** The smallest carried frequency of the materials [Hz]; its material. */
    std::pair<double, std::string>
    least_carried(const Model &model)
    {
      std::pair<double, std::string> least(
        std::numeric_limits<double>::infinity(), "");
      const std::vector<double> carried = model.carried_frequencies();
      for (unsigned int m = 0; m < carried.size(); ++m)
        if (carried[m] > 0.)
          least =
            std::min(least,
                     {carried[m], model.parameters.materials.objects[m].first});
      return least;
    }


    double
    worst_jacobian(const Model &model)
    {
      double worst = std::numeric_limits<double>::infinity();
      for (const auto &quality : worst_cells(model))
        worst = std::min(worst, quality.second.scaled_jacobian);
      return worst;
    }


    /** Adds the name of its object to a line. */
    nlohmann::json
    of(nlohmann::json line, const std::string &what)
    {
      line["of"] = what;
      return line;
    }


    /** Adds time and place, from an object of the summary that has them. */
    nlohmann::json
    with_place(nlohmann::json line, const nlohmann::json &found)
    {
      for (const char *name : {"at the time [s]", "at [m]"})
        if (found.contains(name))
          line[name] = found.at(name);
      return line;
    }


    /** The object with the largest value of a number; null if none has the
     *  number. */
    std::pair<std::string, nlohmann::json>
    with_largest(const nlohmann::json &objects, const std::string &number)
    {
      std::pair<std::string, nlohmann::json> most;
      for (const auto &[name, object] : objects.items())
        if (object.is_object() && object.contains(number) &&
            (most.second.is_null() || object.at(number).is_null() ||
             (!most.second.at(number).is_null() &&
              object.at(number) > most.second.at(number))))
          most = {name, object};
      return most;
    }


    double
    number_in(const nlohmann::json &object, const std::string &name)
    {
      return object.at(name).is_null() ?
               std::numeric_limits<double>::quiet_NaN() :
               object.at(name).get<double>();
    }


    /** A line that is met if the slip is too small to be distinguished, else to
     *  be judged. */
    nlohmann::json
    slip_line(const double slip)
    {
      return slip <= visible ? at_most(slip, visible) : without_limit(slip);
    }


    void
    add_over_stress(const nlohmann::json &faces, nlohmann::json &results)
    {
      const auto [name, face] = with_largest(faces, "largest ratio");
      if (face.is_null())
        return;
      results["demand over tensile strength"] =
        of(with_place(at_most(number_in(face, "largest ratio"), 1.), face),
           name);
      const auto [other, still] = with_largest(faces, "largest ratio at rest");
      if (!still.is_null())
        {
          nlohmann::json &line =
            results["demand over tensile strength in the static state"];
          line =
            of(at_most(number_in(still, "largest ratio at rest"), 1.), other);
          line["at [m]"] = still.at("place of the largest ratio at rest [m]");
        }
    }


    void
    add_cracks(const nlohmann::json &summary, nlohmann::json &results)
    {
      const std::string once =
                          "largest opening from face to face at one moment "
                          "[mm]",
                        last = "opening from face to face at the end [mm]";
      if (summary.contains("through cracks"))
        {
          const nlohmann::json &through = summary.at("through cracks");
          results["open from face to face at one moment [mm]"] =
            with_place(at_most(number_in(through, once), visible), through);
          nlohmann::json &end =
            results["open from face to face at the end [mm]"];
          end = at_most(number_in(through, last), visible);
          if (const char *place =
                "place of the opening from face to face at the end [m]";
              through.contains(place))
            end["at [m]"] = through.at(place);
        }
      if (summary.contains("detachment"))
        {
          const nlohmann::json &widest = summary.at("detachment");
          results["detached: crack over its cell"] =
            with_place(at_most(number_in(widest, "crack over its cell"),
                               widest_crack_share),
                       widest);
        }
    }


    void
    add_slips(const nlohmann::json &interfaces, nlohmann::json &results)
    {
      const nlohmann::json &surfaces = interfaces.at("surfaces");
      for (const std::string end :
           {"residual slip [mm]", "slip rate at the end [mm/s]"})
        if (const auto [name, surface] = with_largest(surfaces, end);
            !surface.is_null())
          {
            const double value = number_in(surface, end);
            results[end[0] == 'r' ? "slip at the end [mm]" : end] =
              of(end[0] == 'r' ? slip_line(value) : at_most(value, at_rest),
                 name);
          }
      if (!interfaces.contains("blocks"))
        return;
      for (const auto &[name, block] : interfaces.at("blocks").items())
        {
          if (const nlohmann::json &safety = block.at("smallest safety");
              safety.is_number())
            {
              // below one the block has slid: its slip is to be judged
              nlohmann::json &line = results[name + ": safety against sliding"];
              line                 = at_least(safety, 1.);
              if (safety < 1.)
                line["met"] = nullptr;
              line["at the time [s]"] = block.at("time of the smallest safety "
                                                 "[s]");
            }
          results[name + ": slip at the end [mm]"] =
            slip_line(number_in(block, "slip at the end [mm]"));
          results[name + ": slip rate at the end [mm/s]"] =
            at_most(number_in(block, "slip rate at the end [mm/s]"), at_rest);
        }
    }
  } // namespace


  double
  lowered_strength(const Model &model)
  {
    return most_lowered_strength(model).share;
  }


  nlohmann::json
  numerical_checks(const RunSetup &setup)
  {
    const Model   &model = setup.model;
    nlohmann::json checks;
    checks["time step over the largest stable one"] =
      at_most(setup.time_step.length / setup.time_step.limit, 1.);
    checks["smallest scaled Jacobian of a cell"] =
      at_least(worst_jacobian(model), least_jacobian);
    if (model.solid.internal_force.has_memory())
      {
        const LoweredStrength lowered = most_lowered_strength(model);
        nlohmann::json &line = checks["strength lowered by long cells [%]"];
        line                 = at_most(lowered.share, most_lowered);
        if (lowered.share > 0.)
          line["of"] =
            model.parameters.materials.objects[lowered.material].first;
        if (lowered.share > most_lowered)
          line["remedy"] = remedy_for(lowered, model);
      }
    if (const double needed =
          frequency_of_intensity(setup.plan.motion.accelerations,
                                 EarthquakeMotion::sample_interval,
                                 intensity_carried);
        needed > 0.)
      {
        const auto [carried, material] = least_carried(model);
        checks["frequency that the mesh carries [Hz]"] =
          of(at_least(carried, needed), material);
      }
    return checks;
  }


  nlohmann::json
  numerical_checks(const Run &run)
  {
    nlohmann::json      checks  = numerical_checks(*run.setup);
    const EnergySummary energy  = run.energy.summary();
    const double        planned = double(run.n_steps()) * run.time_step.length;
    checks["end reached [s]"] = at_least(run.state.time, planned * (1. - 1e-9));
    checks["energy-balance error"] =
      at_most(std::max(energy.largest_error, energy.error_of_input),
              most_energy);
    if (energy.error_of_losses != 0.) // not assessed if losses are small
      checks["energy-balance error over the losses"] =
        at_most(energy.error_of_losses, most_of_losses);
    if (run.contact)
      {
        double slip = 0.;
        for (const ContactPoint &point : run.contact->points())
          if (point.joined)
            slip = std::max(slip, std::hypot(point.gap[1], point.gap[2]));
        checks["clusters of contact without solution"] =
          at_most(double(run.contact->effort().unsolved), 0.);
        checks["slip over a cell of the interfaces"] =
          at_most(Utilities::MPI::max(slip, run.log.communicator()) /
                    run.contact->cell_size(),
                  most_slip);
      }
    if (run.folder.exists())
      checks["files not written"] =
        at_most(double(run.log.missing_files().size()), 0.);
    return checks;
  }


  nlohmann::json
  engineering_results(const nlohmann::json &summary)
  {
    nlohmann::json results;
    if (summary.contains("over-stress"))
      add_over_stress(summary.at("over-stress"), results);
    add_cracks(summary, results);
    if (summary.contains("interfaces"))
      add_slips(summary.at("interfaces"), results);
    return results;
  }

  namespace
  {
    std::string
    text_of(const nlohmann::json &line, const char *name)
    {
      return line.contains(name) ? line.at(name).is_number() ?
                                   number_text(line.at(name)) :
                                   line.at(name).get<std::string>() :
                                   "";
    }
  } // namespace


  std::string
  description(const std::string &title, const nlohmann::json &table)
  {
    std::ostringstream text;
    if (!table.empty())
      text << char(std::toupper(title[0])) << title.substr(1) << ":\n";
    for (const auto &[name, line] : table.items())
      {
        const nlohmann::json &met   = line.at("met"),
                             &value = line.at(
                               line.contains("demand") ? "demand" : "value");
        text << "  "
             << (met.is_null()   ? "to be judged" :
                 met.get<bool>() ? "met" :
                                   "NOT MET")
             << "  " << name << ": "
             << (value.is_null() ? "none" : number_text(value));
        for (const char *sense : {"at most", "at least"})
          if (line.contains(sense))
            text << ", " << sense << ' ' << text_of(line, sense);
        if (line.contains("of"))
          text << ", " << text_of(line, "of");
        if (line.contains("at the time [s]") &&
            line.at("at the time [s]").is_number())
          text << ", at " << text_of(line, "at the time [s]") << " s";
        if (line.contains("at [m]"))
          {
            text << ", at (";
            for (unsigned int d = 0; d < 3; ++d)
              text << (d > 0 ? " " : "") << number_text(line.at("at [m]")[d]);
            text << ") m";
          }
        if (line.contains("remedy"))
          text << "; " << text_of(line, "remedy");
        text << '\n';
      }
    return text.str();
  }
} // namespace Voussoir
