#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/output/interface_faces.h>
#include <voussoir/output/table.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string place = "\"Points\" in section \"Output/interfaces\"";

    // What is summed over the points of a surface at a look.
    enum Sum
    {
      opening, // times area [m3]
      slip,    // times area [m3]
      open_area,
      sliding_area,
      pressure, // resultant [N]
      shear_x,  // resultant, in global directions [N]
      shear_y,
      shear_z,
      resistance,      // cohesion and friction [N]
      shear_of_points, // sum of sizes [N]
      n_sums
    };


    double
    slip_of(const ContactPoint &point)
    {
      return std::hypot(point.gap[1], point.gap[2]);
    }


    double
    opening_of(const ContactPoint &point)
    {
      return std::max(point.gap[0], 0.);
    }


    /** Opening, slip, forces and safety of all interfaces. */
    class Interfaces : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points",
                          points_text,
                          "Named places \"name: x y z\" [m], separated by "
                          "\";\". The nearest pair of nodes of any interface "
                          "is taken; its opening and slip, level and upwards, "
                          "are written.");
        prm.add_parameter("Interval",
                          interval,
                          "Time between two lines of interfaces.csv, and two "
                          "looks for the sliding safety [s], which is what "
                          "friction and cohesion could bear, without keys, "
                          "over the shear force.",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &observed) const override
      {
        if (observed.contact == nullptr)
          throw UserError(
            "\"Observers\" in section \"Output\" names \"interfaces\", but the "
            "case has none; list some in section \"Interfaces\", or leave the "
            "observer out.");
        parse_points(points_text, place);
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        model        = std::make_unique<ObservedModel>(observed);
        contact      = observed.contact;
        communicator = observed.discretization.grid.communicator();
        schedule     = Schedule(interval, observed.time_step);
        points       = find_contact_points(*contact,
                                     parse_points(points_text, place),
                                     communicator);

        const auto &names = contact->surface_names();
        areas.assign(names.size(), 0.);
        for (const ContactPoint &point : contact->points())
          areas[point.surface] += point.area;
        areas = sum_over_ranks(areas, communicator);
        extremes.assign(contact->points().size(), {{0., 0.}});
        smallest_safety.assign(names.size(),
                               std::numeric_limits<double>::infinity());
        time_at_one.assign(names.size(), 0.);
        energies_at_start = energies();

        if (Utilities::MPI::this_mpi_process(communicator) != 0)
          return;
        std::vector<std::string> columns;
        for (const std::string &name : names)
          for (const char *quantity : {"largest opening [mm]",
                                       "mean opening [mm]",
                                       "largest slip [mm]",
                                       "mean slip [mm]",
                                       "open area [m2]",
                                       "sliding area [m2]",
                                       "normal force [MN]",
                                       "shear force [MN]",
                                       "sliding safety [-]"})
            columns.push_back(name + ' ' + quantity);
        for (const NearestContactPoint &point : points)
          for (const char *quantity :
               {"opening [mm]", "level slip [mm]", "upward slip [mm]"})
            columns.push_back(point.name + ' ' + quantity);
        table.open(observed.folder + "/interfaces.csv",
                   columns,
                   observed.time_step,
                   start_time,
                   restarted);
      }

      void
      observe(const State &state) override
      {
        for (unsigned int k = 0; k < extremes.size(); ++k)
          {
            const ContactPoint &point = contact->points()[k];
            extremes[k][0] = std::max(extremes[k][0], opening_of(point));
            extremes[k][1] = std::max(extremes[k][1], slip_of(point));
          }
        if (!schedule.due(state.step))
          return;
        const std::size_t   n_surfaces = areas.size();
        std::vector<double> sum(n_sums * n_surfaces), largest(2 * n_surfaces);
        for (const ContactPoint &point : contact->points())
          {
            add_to_sums(point, &sum[n_sums * point.surface]);
            double *now = &largest[2 * point.surface];
            now[0]      = std::max(now[0], opening_of(point));
            now[1]      = std::max(now[1], slip_of(point));
          }
        for (const NearestContactPoint &point : points)
          for (unsigned int d = 0; d < 3; ++d)
            sum.push_back(
              point.is_mine ? contact->points()[point.number].gap[d] : 0.);
        sums.insert(sums.end(), sum.begin(), sum.end());
        largest_now.insert(largest_now.end(), largest.begin(), largest.end());
        times.push_back(state.time);
        if (times.size() >= 100)
          flush();
      }

      void
      finish(const State &state, nlohmann::json &summary) override
      {
        flush();
        write_interface_envelopes(*model, extremes, state.time);

        const auto         &names = contact->surface_names();
        std::vector<double> values(3 * names.size());
        for (unsigned int k = 0; k < extremes.size(); ++k)
          {
            const ContactPoint &point      = contact->points()[k];
            double             *of_surface = &values[3 * point.surface];
            of_surface[0] = std::max(of_surface[0], extremes[k][0]);
            of_surface[1] = std::max(of_surface[1], extremes[k][1]);
            of_surface[2] = std::max(of_surface[2], slip_of(point));
          }
        Utilities::MPI::max(values, communicator, values);
        const auto  energies_now = energies();
        auto       &result       = summary["interfaces"];
        const char *kinds[] = {"impact", "friction", "bond", "bars", "uplift"};
        for (unsigned int s = 0; s < names.size(); ++s)
          {
            auto &surface                   = result["surfaces"][names[s]];
            surface["area [m2]"]            = areas[s];
            surface["largest opening [mm]"] = 1e3 * values[3 * s];
            surface["largest slip [mm]"]    = 1e3 * values[3 * s + 1];
            surface["residual slip [mm]"]   = 1e3 * values[3 * s + 2];
            // null if there never was a shear force
            surface["smallest sliding safety"]         = smallest_safety[s];
            surface["time at safety one or below [s]"] = time_at_one[s];
            for (unsigned int k = 0; k < 5; ++k)
              surface["energies [J]"][kinds[k]] =
                energies_now[5 * s + k] - energies_at_start[5 * s + k];
          }
        for (const NearestContactPoint &point : points)
          {
            std::vector<double> largest(2);
            if (point.is_mine)
              largest.assign(extremes[point.number].begin(),
                             extremes[point.number].end());
            largest = sum_over_ranks(largest, communicator);
            result["points"][point.name] = {
              {"position [m]",
               {point.position[0], point.position[1], point.position[2]}},
              {"surface", names[point.surface]},
              {"largest opening [mm]", 1e3 * largest[0]},
              {"largest slip [mm]", 1e3 * largest[1]}};
          }

        // of the static stage too
        const auto &effort = contact->effort();
        const auto  n_clusters =
          Utilities::MPI::sum(effort.clusters, communicator);
        result["effort"] = {
          {"largest penetration over cell size",
           Utilities::MPI::max(effort.penetration, communicator) /
             contact->cell_size},
          {"largest residual",
           Utilities::MPI::max(effort.residual, communicator)},
          {"most sweeps", Utilities::MPI::max(effort.sweeps, communicator)},
          {"mean sweeps",
           double(Utilities::MPI::sum(effort.all_sweeps, communicator)) /
             std::max(n_clusters, 1ULL)}};
      }

      std::map<std::string, KeyedValues>
      checkpoint_values() override
      {
        KeyedValues values{2, {}};
        for (unsigned int k = 0; k < extremes.size(); ++k)
          values.items.emplace_back(contact->keys()[k], extremes[k].data());
        return {{"extremes", values}};
      }

      nlohmann::json
      save() override
      {
        flush();
        nlohmann::json safety;
        for (const double value : smallest_safety) // JSON has no infinity
          safety.push_back(std::min(value, std::numeric_limits<double>::max()));
        return {{"smallest safety", safety},
                {"time at one", time_at_one},
                {"energies at start", energies_at_start},
                {"last look", last_look}};
      }

      void
      load(const nlohmann::json &saved) override
      {
        if (saved.at("smallest safety").size() != smallest_safety.size())
          return;
        saved.at("smallest safety").get_to(smallest_safety);
        for (double &value : smallest_safety)
          if (value == std::numeric_limits<double>::max())
            value = std::numeric_limits<double>::infinity();
        saved.at("time at one").get_to(time_at_one);
        saved.at("energies at start").get_to(energies_at_start);
        saved.at("last look").get_to(last_look);
      }

    private:
      static void
      add_to_sums(const ContactPoint &point, double *sum)
      {
        const Tensor<1, 3> &F    = point.force;
        const bool          open = point.status == ContactStatus::open;
        sum[opening] += point.area * opening_of(point);
        sum[slip] += point.area * slip_of(point);
        sum[open_area] += open ? point.area : 0.;
        sum[sliding_area] +=
          point.status == ContactStatus::sliding ? point.area : 0.;
        sum[pressure] += F[0];
        for (unsigned int d = 0; d < 3; ++d)
          sum[shear_x + d] +=
            F[1] * point.frame[1][d] + F[2] * point.frame[2][d];
        // without keys
        ContactLimits limits = point.limits;
        limits.locked        = false;
        sum[resistance] += limits.shear(open, F[0]);
        sum[shear_of_points] += std::hypot(F[1], F[2]);
      }

      /** Impact, friction, bond, bars and uplift of each surface [J]. */
      std::vector<double>
      energies() const
      {
        std::vector<double> values;
        for (const ContactSurface &surface : contact->surfaces())
          for (const double value : {surface.energy.impact,
                                     surface.energy.friction,
                                     surface.energy.bond,
                                     surface.energy.bars,
                                     surface.energy.uplift})
            values.push_back(value);
        return sum_over_ranks(values, communicator);
      }

      void
      flush()
      {
        const auto        all_sums = sum_over_ranks(sums, communicator);
        const std::size_t width    = n_sums * areas.size() + 3 * points.size();
        Utilities::MPI::max(largest_now, communicator, largest_now);
        for (std::size_t i = 0; i < times.size(); ++i)
          {
            const double       *sum = &all_sums[width * i];
            std::vector<double> line;
            for (unsigned int s = 0; s < areas.size(); ++s, sum += n_sums)
              {
                const double *largest =
                  &largest_now[2 * (areas.size() * i + s)];
                // infinite without shear, as in an open joint without keys, or
                // with as good as none
                const double safety =
                  sum[shear_of_points] > 1e-6 * sum[resistance] ?
                    sum[resistance] / sum[shear_of_points] :
                    std::numeric_limits<double>::infinity();
                for (const double value :
                     {1e3 * largest[0],
                      1e3 * sum[opening] / areas[s],
                      1e3 * largest[1],
                      1e3 * sum[slip] / areas[s],
                      sum[open_area],
                      sum[sliding_area],
                      1e-6 * sum[pressure],
                      1e-6 *
                        Tensor<1, 3>({sum[shear_x], sum[shear_y], sum[shear_z]})
                          .norm(),
                      safety})
                  line.push_back(value);
                smallest_safety[s] = std::min(smallest_safety[s], line.back());
                // points that slide are at their limit, not beyond it
                if (line.back() < 1. + 1e-6 && times[i] > last_look)
                  time_at_one[s] += times[i] - last_look;
              }
            for (unsigned int k = 0; k < 3 * points.size(); ++k)
              line.push_back(1e3 * sum[k]);
            last_look = std::max(last_look, times[i]);
            if (table.is_open())
              table.write(times[i], line);
          }
        if (table.is_open())
          table.flush();
        sums.clear();
        largest_now.clear();
        times.clear();
      }

      std::string points_text;
      double      interval = 0.01;

      std::unique_ptr<ObservedModel>   model;
      const Contact                   *contact = nullptr;
      MPI_Comm                         communicator;
      Schedule                         schedule;
      std::vector<NearestContactPoint> points;
      TimeTable                        table;

      // looks that are not written yet
      std::vector<double> sums, largest_now, times;

      std::vector<InterfaceExtremes> extremes; // of each point, over all steps

      // of each surface
      std::vector<double> areas, smallest_safety, time_at_one,
        energies_at_start;
      double last_look = 0.;
    };

    const Registry<Observer>::Add<Interfaces> registered(
      "interfaces",
      "Opening, slip, forces and sliding safety of the interfaces, in "
      "interfaces.csv; extremes on their faces in interface_envelopes.vtu.");
  } // namespace
} // namespace Voussoir
