#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/output/interface_faces.h>
#include <voussoir/output/interface_sums.h>
#include <voussoir/output/table_observer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using namespace InterfaceSum;

    const std::string points_entry =
                        "\"Points\" in section \"Output/interfaces\"",
                      blocks_entry =
                        "\"Blocks\" in section \"Output/interfaces\"";

    /** Opening, slip, forces and safety of all interfaces. */
    class Interfaces : public TableObserver
    {
    public:
      Interfaces()
        : TableObserver("interfaces.csv", 0.01)
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points",
                          points_text,
                          "Named places \"name: x y z\" [m], separated by "
                          "\";\". The nearest pair of nodes of any interface "
                          "is taken; its opening and its level and upward "
                          "slip are written.");
        prm.add_parameter(
          "Blocks",
          blocks_text,
          "Blocks of rock whose safety against sliding as a whole is "
          "evaluated: \"cell set: surface, surface\", separated by \";\", "
          "with all surfaces of contact of the block, one for each plane. "
          "The safety is that of limit equilibrium under the driving forces "
          "(weight, water, uplift, thrust of the dam, and the inertia of the "
          "block as if it moved with its base), against sliding along one "
          "plane or along the line where two planes meet; zero if the block "
          "lifts off, infinite without a driving force or if other planes "
          "prevent the slip. The mobilised ratio is the shear of the contact "
          "forces over the resistance of the planes, one where the block "
          "slides. Both are means over 0.443 of the shortest period that the "
          "mesh carries.");
        declare_interval(
          prm,
          "Time between two lines of interfaces.csv [s]. The sliding safety "
          "of a surface in this file is (c A + mu N) / T, the resistance by "
          "cohesion and friction over the resultant of the shear, both where "
          "no keys prevent slip. Extremes in summary.json are those of all "
          "steps.");
      }

      void
      check(const ObservedModel &model) const override
      {
        if (model.interfaces == nullptr)
          throw UserError(
            "\"Observers\" in section \"Output\" names \"interfaces\", but "
            "the case has no interfaces; list some in section "
            "\"Interfaces\", or remove the observer.");
        parse_points(points_text, points_entry);
        find_sliding_blocks(blocks_text,
                            blocks_entry,
                            model.solid,
                            *model.interfaces);
      }

      void
      observe(const State &state) override
      {
        const std::size_t n_surfaces = areas.size();
        Sample            sample{state.time,
                      has_line(state.step),
                      no_sums(n_quantities * n_surfaces),
                      std::vector<double>(2 * n_surfaces)};
        for (unsigned int k = 0; k < extremes.size(); ++k)
          {
            const ContactPoint &point = contact().points()[k];
            const double opening = opening_of(point), slip = slip_of(point);
            extremes[k][0] = std::max(extremes[k][0], opening);
            extremes[k][1] = std::max(extremes[k][1], slip);
            add_to_sums(point, &sample.parts[n_quantities * point.surface]);
            double *now = &sample.largest[2 * point.surface];
            now[0]      = std::max(now[0], opening);
            now[1]      = std::max(now[1], slip);
          }
        for (const NearestContactPoint &point : points)
          for (unsigned int d = 0; d < 3; ++d)
            {
              sample.parts.push_back(no_sums(1)[0]);
              sample.parts.back() +=
                point.is_mine ? contact().points()[point.number].gap[d] : 0.;
            }
        take(std::move(sample));
      }

    private:
      const Contact &
      contact() const
      {
        return *run().contact;
      }

      void
      prepare() override
      {
        points = find_contact_points(contact(),
                                     parse_points(points_text, points_entry),
                                     communicator());
        blocks = find_sliding_blocks(blocks_text,
                                     blocks_entry,
                                     run().solid,
                                     contact());

        const std::size_t n_surfaces   = contact().surface_names().size();
        std::vector<Sum>  sum_of_areas = no_sums(n_surfaces);
        for (const ContactPoint &point : contact().points())
          sum_of_areas[point.surface] += point.area;
        areas = sum_over_ranks(sum_of_areas, communicator());

        extremes.assign(contact().points().size(), {{0., 0.}});
        keep([this] {
          KeyedValues values{2, {}};
          for (unsigned int k = 0; k < extremes.size(); ++k)
            values.items.emplace_back(contact().keys()[k], extremes[k].data());
          return std::map<std::string, KeyedValues>{{"extremes", values}};
        });
        smallest_safety.assign(n_surfaces,
                               std::numeric_limits<double>::infinity());
        keep(
          "smallest safety",
          [this] {
            nlohmann::json saved;
            for (const double value : smallest_safety)
              saved.push_back(json_number(value));
            return saved;
          },
          [this](const nlohmann::json &saved) {
            for (unsigned int s = 0; s < smallest_safety.size(); ++s)
              smallest_safety[s] = from_json_number(saved.at(s));
          });
        safety_of_blocks.assign(blocks.size(), {});
        keep(
          "blocks",
          [this] {
            nlohmann::json saved = nlohmann::json::array();
            for (const SafetyHistory &block : safety_of_blocks)
              saved.push_back(block.save());
            return saved;
          },
          [this](const nlohmann::json &saved) {
            for (unsigned int b = 0; b < blocks.size(); ++b)
              safety_of_blocks[b].load(saved.at(b));
          });
        window = std::max(0.443 / run().carried_frequency, run().time_step);
        keep("block windows",
             windows,
             std::vector<std::vector<double>>(
               blocks.size(),
               std::vector<double>(n_of_window + n_quantities * n_surfaces)));
        std::vector<std::vector<double>> no_forces;
        for (const SlidingBlock &block : blocks)
          no_forces.emplace_back(3 * (block.planes.size() + 1));
        keep("block forces", forces_at_smallest, no_forces);
        keep("largest open area",
             largest_open,
             std::vector<std::array<double, 2>>(n_surfaces, {{0., 0.}}));
        keep("largest openings",
             largest_opening,
             std::vector<std::array<double, 2>>(n_surfaces, {{0., 0.}}));
        keep("time at one", time_at_one, std::vector<double>(n_surfaces, 0.));
        keep("energies at start", energies_at_start, energies());
        keep("last sample", last_sample, 0.);
        open_table(columns());
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        write_interface_envelopes(run(), extremes, state.time);

        auto &result = summary["interfaces"];
        describe_surfaces(result["surfaces"]);
        for (unsigned int b = 0; b < blocks.size(); ++b)
          {
            auto &block                      = result["blocks"][blocks[b].name];
            block                            = safety_of_blocks[b].summary();
            const double *now                = windows[b].data();
            block["largest mobilised ratio"] = now[most_mobilised];
            block["slip at the end [mm]"]    = 1e3 * now[slip_now];
            block["largest slip [mm]"]       = 1e3 * now[largest_slip];
            block["slip rate at the end [mm/s]"] = 1e3 * now[rate_now];
            block["volume [m3]"]                 = blocks[b].volume;
            block["weight [MN]"]                 = 1e-6 * blocks[b].weight;
            block["mass [kg]"]                   = blocks[b].mass;
            describe_forces(b, block["forces at the smallest safety [N]"]);
            block["id"] = number_of(blocks[b].name, run().names.cell_sets);
          }
        for (const NearestContactPoint &point : points)
          describe_point(point, result["points"][point.name]);
        result["effort"] = effort();
      }

      /** Titles of the columns of interfaces.csv. */
      std::vector<std::string>
      columns() const
      {
        std::vector<std::string> titles;
        for (const std::string &name : contact().surface_names())
          for (const char *quantity : surface_columns)
            titles.push_back(name + ' ' + quantity);
        for (const NearestContactPoint &point : points)
          for (const char *quantity :
               {"opening [mm]", "level slip [mm]", "upward slip [mm]"})
            titles.push_back(point.name + ' ' + quantity);
        for (const SlidingBlock &block : blocks)
          {
            titles.push_back(block.name + " block safety [-]");
            titles.push_back(block.name + " mobilised ratio [-]");
          }
        return titles;
      }

      /** Impact, friction, bond, bars and uplift of each surface [J]. */
      std::vector<double>
      energies() const
      {
        std::vector<double> values;
        for (const ContactSurface &surface : contact().surfaces())
          for (const double value : {surface.energy.impact,
                                     surface.energy.friction,
                                     surface.energy.bond,
                                     surface.energy.bars,
                                     surface.energy.uplift})
            values.push_back(value);
        return sum_over_ranks(values, communicator());
      }

      std::vector<double>
      line_of(const Sample &sample) override
      {
        const double       *sums  = sample.sums.data();
        const double        since = std::max(0., sample.time - last_sample);
        std::vector<double> line;
        for (unsigned int s = 0; s < areas.size(); ++s)
          {
            const auto values = surface_values(sums + n_quantities * s,
                                               &sample.largest[2 * s],
                                               areas[s]);
            line.insert(line.end(), values.begin(), values.end());
            const double open = sums[n_quantities * s + open_area];
            if (open > largest_open[s][0])
              largest_open[s] = {{open, sample.time}};
            if (sample.largest[2 * s] > largest_opening[s][0])
              largest_opening[s] = {{sample.largest[2 * s], sample.time}};
            const double safety = values.back();
            smallest_safety[s]  = std::min(smallest_safety[s], safety);
            // sliding points are at their limit, apart from waves inside the
            // block
            if (safety < 1. + 1e-3)
              time_at_one[s] += since;
          }
        for (unsigned int k = 0; k < 3 * points.size(); ++k)
          line.push_back(1e3 * sums[n_quantities * areas.size() + k]);
        for (unsigned int b = 0; b < blocks.size(); ++b)
          {
            evaluate_block(b, sample.time, since, sums);
            line.push_back(from_json_number(windows[b][safety_now]));
            line.push_back(windows[b][mobilised_now]);
          }
        last_sample = std::max(last_sample, sample.time);
        return line;
      }

      /** Updates the means of a block. */
      void
      evaluate_block(const unsigned int b,
                     const double       time,
                     const double       since,
                     const double      *sums)
      {
        const SlidingBlock &block    = blocks[b];
        double             *now      = windows[b].data();
        double             *means    = now + n_of_window;
        const std::size_t   n_sums   = n_quantities * areas.size();
        const Tensor<1, 3>  velocity = slip_velocity(block, sums, areas);
        now[rate_now]                = velocity.norm();
        now[slip_now]                = 0.;
        for (const SlidingBlock::Plane &plane : block.planes)
          now[slip_now] = std::max(now[slip_now],
                                   sums[n_quantities * plane.surface + slip] /
                                     areas[plane.surface]);
        now[largest_slip] = std::max(now[largest_slip], now[slip_now]);
        for (std::size_t k = 0; k < n_sums; ++k)
          means[k] += since * sums[k];
        now[elapsed] += since;
        const bool is_first = time <= 0.;
        if (!is_first && now[elapsed] < window * (1. - 1e-6))
          return;
        for (std::size_t k = 0; k < n_sums; ++k)
          means[k] = is_first ? sums[k] : means[k] / now[elapsed];
        Tensor<1, 3> inertia;
        for (unsigned int d = 0; d < 3 && !is_first; ++d)
          inertia[d] = block.mass * (velocity[d] - now[velocity_before + d]) /
                       now[elapsed];
        const double safety = safety_from_sums(block, means, areas, inertia),
                     of_contact = safety_from_sums(block, means, areas, {});
        if (safety_of_blocks[b].add(time - 0.5 * now[elapsed],
                                    now[elapsed],
                                    safety))
          keep_forces(b, means, inertia);
        now[safety_now]     = json_number(safety);
        now[mobilised_now]  = of_contact > 0. ? 1. / of_contact : 0.;
        now[most_mobilised] = std::max(now[most_mobilised], now[mobilised_now]);
        for (unsigned int d = 0; d < 3; ++d)
          now[velocity_before + d] = velocity[d];
        now[elapsed] = 0.;
        std::fill_n(means, n_sums, 0.);
      }

      /** Stores the contact forces of the planes of a block, and its driving
       *  force D - M (a - a_s) , see safety_from_sums. */
      void
      keep_forces(const unsigned int  b,
                  const double       *sums,
                  const Tensor<1, 3> &inertia)
      {
        Tensor<1, 3> driving = inertia;
        auto         kept    = forces_at_smallest[b].begin();
        for (const SlidingBlock::Plane &plane : blocks[b].planes)
          {
            const Tensor<1, 3> force = force_on_block(plane, sums);
            driving -= force;
            kept = std::copy_n(force.begin_raw(), 3, kept);
          }
        std::copy_n(driving.begin_raw(), 3, kept);
      }

      void
      describe_forces(const unsigned int b, nlohmann::json &result) const
      {
        auto       kept = forces_at_smallest[b].begin();
        const auto next = [&kept] {
          kept += 3;
          return nlohmann::json{kept[-3], kept[-2], kept[-1]};
        };
        for (const SlidingBlock::Plane &plane : blocks[b].planes)
          result["contact"][contact().surface_names()[plane.surface]] = next();
        result["driving, with inertia"] = next();
      }

      void
      describe_surfaces(nlohmann::json &result) const
      {
        const auto         &names = contact().surface_names();
        std::vector<double> values(4 * names.size());
        for (unsigned int k = 0; k < extremes.size(); ++k)
          {
            const ContactPoint &point      = contact().points()[k];
            double             *of_surface = &values[4 * point.surface];
            of_surface[0] = std::max(of_surface[0], extremes[k][0]);
            of_surface[1] = std::max(of_surface[1], extremes[k][1]);
            of_surface[2] = std::max(of_surface[2], slip_of(point));
            if (point.status == ContactStatus::sliding)
              of_surface[3] =
                std::max(of_surface[3],
                         std::hypot(point.velocity[1], point.velocity[2]));
          }
        Utilities::MPI::max(values, communicator(), values);
        const auto  energies_now = energies();
        const char *kinds[] = {"impact", "friction", "bond", "bars", "uplift"};
        for (unsigned int s = 0; s < names.size(); ++s)
          {
            auto &surface                              = result[names[s]];
            surface["id"]                              = s;
            surface["area [m2]"]                       = areas[s];
            surface["largest opening [mm]"]            = 1e3 * values[4 * s];
            surface["time of the largest opening [s]"] = largest_opening[s][1];
            surface["largest open share [%]"] =
              100. * largest_open[s][0] / areas[s];
            surface["time of the largest open share [s]"] = largest_open[s][1];
            surface["largest slip [mm]"]           = 1e3 * values[4 * s + 1];
            surface["residual slip [mm]"]          = 1e3 * values[4 * s + 2];
            surface["slip rate at the end [mm/s]"] = 1e3 * values[4 * s + 3];
            // null if there never was a shear force
            surface["smallest sliding safety"]         = smallest_safety[s];
            surface["time at safety one or below [s]"] = time_at_one[s];
            for (unsigned int k = 0; k < 5; ++k)
              surface["energies [J]"][kinds[k]] =
                energies_now[5 * s + k] - energies_at_start[5 * s + k];
          }
      }

      void
      describe_point(const NearestContactPoint &point,
                     nlohmann::json            &result) const
      {
        std::vector<double> largest(2);
        if (point.is_mine)
          largest.assign(extremes[point.number].begin(),
                         extremes[point.number].end());
        largest = sum_over_ranks(largest, communicator());
        result  = {{"position [m]",
                    {point.position[0], point.position[1], point.position[2]}},
                   {"surface", contact().surface_names()[point.surface]},
                   {"largest opening [mm]", 1e3 * largest[0]},
                   {"largest slip [mm]", 1e3 * largest[1]}};
      }

      /** Statistics of the contact solver, static stages included. */
      nlohmann::json
      effort() const
      {
        const auto effort = contact().effort();
        return {{"largest penetration over cell size",
                 effort.penetration / contact().cell_size()},
                {"largest residual", effort.residual},
                {"most sweeps", effort.sweeps},
                {"mean sweeps",
                 double(effort.all_sweeps) / std::max(effort.clusters, 1ULL)},
                {"clusters by path following", effort.paths},
                {"unsolved clusters", effort.unsolved}};
      }

      std::string points_text, blocks_text;

      std::vector<NearestContactPoint> points;

      std::vector<InterfaceExtremes> extremes; // of each point, over all steps

      // of each surface
      std::vector<double> areas, smallest_safety, time_at_one,
        energies_at_start;
      double last_sample = 0.;

      std::vector<SlidingBlock>  blocks;
      std::vector<SafetyHistory> safety_of_blocks;

      // of each block: contact forces of its planes, and its driving force [N]
      std::vector<std::vector<double>> forces_at_smallest;

      // largest open area [m2] and opening [m] of each surface, and their times
      // [s]
      std::vector<std::array<double, 2>> largest_open, largest_opening;

      // of each block its present values, then sums times their time since
      // the last mean
      enum OfWindow
      {
        elapsed,         // [s]
        velocity_before, // of the slip, at the last mean [m/s]
        safety_now = 4,  // last mean
        mobilised_now,   // last mean
        most_mobilised,  // of these
        slip_now,        // largest mean of a plane [m]
        largest_slip,    // of these
        rate_now,        // of the slip [m/s]
        n_of_window
      };
      std::vector<std::vector<double>> windows;
      double                           window = 0.; // [s]
    };

    const Registry<Observer>::Add<Interfaces> registered_interfaces(
      "interfaces",
      "Opening, slip, forces and sliding safety of the interfaces, in "
      "interfaces.csv; extremes on their faces in interface_envelopes.vtu, "
      "with the state at the end: 0 closed, 1 sliding, 2 open.");
  } // namespace
} // namespace Voussoir
