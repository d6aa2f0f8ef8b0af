#include <voussoir/base/error.h>
#include <voussoir/base/json_entries.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/output/crack_paths.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/output/table_observer.h>

#include <deal.II/base/geometry_info.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string cracks_section = "section \"Output/through cracks\"";


    /** Weights of the integration points of a cell in the mean of each eighth:
     *  those in the eighth count whole, those on its borders with other eighths
     *  half. */
    std::vector<std::array<double, 8>>
    shares_in_eighths(const Quadrature<3> &points)
    {
      std::vector<std::array<double, 8>> shares(points.size());
      std::array<double, 8>              sums{};
      for (unsigned int q = 0; q < points.size(); ++q)
        for (unsigned int corner = 0; corner < 8; ++corner)
          {
            shares[q][corner] = points.weight(q);
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double beyond = (points.point(q)[d] - 0.5) *
                                      ((corner >> d & 1) == 1 ? 1 : -1);
                shares[q][corner] *= beyond > 1e-10  ? 1. :
                                     beyond > -1e-10 ? 0.5 :
                                                       0.;
              }
            sums[corner] += shares[q][corner];
          }
      for (auto &of_point : shares)
        for (unsigned int corner = 0; corner < 8; ++corner)
          of_point[corner] /= sums[corner];
      return shares;
    }


    /** Through cracks from one face of the dam to the other. */
    class ThroughCracks : public TableObserver
    {
    public:
      ThroughCracks()
        : TableObserver("through_cracks.csv", 0.02)
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("From", from, "Face sets on which a crack begins.");
        prm.add_parameter("To", to, "Face sets on which it ends.");
        declare_interval(prm,
                         "Time between two lines of through_cracks.csv [s]; "
                         "cracks are evaluated each twentieth of the shortest "
                         "period that the mesh carries with eight nodes per "
                         "wavelength, if that is shorter.");
      }

      double
      record_interval() const override
      {
        return interval;
      }

      void
      check(const ObservedModel &model) const override
      {
        check_sets(model, "\"From\" in " + cracks_section, from);
        check_sets(model, "\"To\" in " + cracks_section, to);
        if (std::none_of(model.solid.materials.begin(),
                         model.solid.materials.end(),
                         [](const Material *material) {
                           return reports_cracks(*material);
                         }))
          throw UserError(
            "No material of the case has a law that reports openings of "
            "cracks, as concrete damage does, but " +
            cracks_section +
            " records cracks; remove the observer \"through cracks\", or "
            "give a material such a law.");
      }

      void
      observe(const State &state) override
      {
        if (!is_due(state.step))
          return;
        const bool      lists    = has_line(state.step);
        const Openings  openings = find_openings(lists);
        const CrackPath now = paths->widest(openings.now, lists ? 0. : most[0]);
        compare(now, state.time);
        if (lists)
          table.write(state.time,
                      {now.opening, paths->widest(openings.ever, 0.).opening});
      }

    private:
      void
      prepare() override
      {
        keep("most", most, {});
        shares.clear();
        for (unsigned int m = 0; m < run().solid.materials.size(); ++m)
          shares.push_back(
            shares_in_eighths(run().solid.discretization.points(m)));
        find_touching();
        paths.emplace(run().solid.discretization, touching);
        n_active    = 0;
        active_path = false;
        open_table({"opening from face to face now [mm]",
                    "largest openings ever from face to face [mm]"});
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        const Openings  openings = find_openings(true);
        const CrackPath now      = paths->widest(openings.now, 0.),
                        ever     = paths->widest(openings.ever, 0.);
        compare(now, state.time);
        const std::string last   = "opening from face to face at the end",
                          widest = "largest openings ever from face to face";
        nlohmann::json &cracks   = summary["through cracks"];
        cracks                   = {
                            {"largest opening from face to face at one moment [mm]", most[0]},
                            {"at the time [s]", most[1]},
                            {last + " [mm]", now.opening},
                            {"time of the " + last + " [s]", state.time},
                            {widest + " [mm]", ever.opening},
                            {"time of the " + widest + " [s]", nullptr}}; // of several moments
        if (most[0] > 0.)
          cracks["at [m]"] = {most[2], most[3], most[4]};
        if (now.opening > 0.)
          cracks["place of the " + last + " [m]"] = to_json(now.where);
        if (ever.opening > 0.)
          cracks["place of the " + widest + " [m]"] = to_json(ever.where);
      }

      static void
      check_sets(const ObservedModel &model,
                 const std::string   &place,
                 const std::string   &list)
      {
        const auto sets = split_list(list);
        if (sets.empty())
          throw UserError(place + " is empty; name a face set.");
        for (const std::string &set : sets)
          model.solid.grid().check_face_set(set, place);
      }

      /** Openings of the eighths of cells [mm]. */
      struct Openings
      {
        std::vector<double> now;
        std::vector<double> ever; // the largest, possibly at different moments
      };

      void
      compare(const CrackPath &path, const double time)
      {
        if (const auto &[opening, where] = path; opening > most[0])
          most = {{opening, time, where[0], where[1], where[2]}};
      }

      /** Openings of the eighths, the largest ones only if @p with_largest;
       *  zero where no path from face to face is possible. */
      Openings
      find_openings(const bool with_largest)
      {
        const bool can_be_through = has_active_path();
        Openings   openings{std::vector<double>(paths->n_eighths()),
                          std::vector<double>(paths->n_eighths())};
        if (!can_be_through)
          return openings;
        for_each_crack(run(),
                       [&](const Discretization::Cell &cell,
                           const unsigned int          q,
                           const double,
                           const CrackOpening &opening) {
                         const double now = opening.now();
                         if (now > 0.)
                           add(openings.now, cell, q, now);
                         if (with_largest)
                           add(openings.ever, cell, q, opening.largest());
                       });
        return openings;
      }

      /** Adds the opening [m] of a point to the means of the eighths of its
       *  cell; in cells of degree 2 and more it is that of the whole cell. */
      void
      add(std::vector<double>        &eighths,
          const Discretization::Cell &cell,
          const unsigned int          q,
          const double                opening)
      {
        const unsigned int first      = 8 * paths->number_of(cell);
        const auto        &share      = shares_of(cell)[q];
        const bool         is_of_cell = CrackOpening::is_of_cell(run().solid);
        for (unsigned int corner = 0; corner < 8; ++corner)
          if (double &eighth = eighths[first + corner]; !is_of_cell)
            eighth += 1e3 * share[corner] * opening;
          else if (share[corner] > 0.)
            eighth = std::max(eighth, 1e3 * opening);
      }

      /** Whether points that have left the elastic range lead from face to
       *  face; otherwise no crack does, whatever its openings. */
      bool
      has_active_path()
      {
        std::size_t n = 0;
        for_each_active_point(run(),
                              [&](const Discretization::Cell &,
                                  const unsigned int) { ++n; });
        n = Utilities::MPI::sum(n, communicator());
        if (n == n_active)
          return active_path;
        n_active = n;
        std::vector<double> is_active;
        for_each_active_point(
          run(), [&](const Discretization::Cell &cell, const unsigned int q) {
            const unsigned int first = 8 * paths->number_of(cell);
            is_active.resize(paths->n_eighths());
            for (unsigned int corner = 0; corner < 8; ++corner)
              if (shares_of(cell)[q][corner] > 0.)
                is_active[first + corner] = 1.;
          });
        active_path = paths->widest(is_active, 0.).opening > 0.;
        return active_path;
      }

      const std::vector<std::array<double, 8>> &
      shares_of(const Discretization::Cell &cell) const
      {
        return shares[run().solid.grid().material(cell)];
      }

      /** Finds the corners of cells that lie on the two sets of faces. */
      void
      find_touching()
      {
        const Grid &grid = run().solid.grid();
        touching.assign(grid.triangulation().n_locally_owned_active_cells(),
                        {});
        const std::array<std::string, 2> lists{{from, to}};
        for (const unsigned int side : {0, 1})
          for (const std::string &set : split_list(lists[side]))
            grid.for_each_face(
              set, [&](const auto &cell, const unsigned int face) {
                for (unsigned int v = 0; v < 4; ++v)
                  touching[grid.owned_cell(cell)][side]
                          [GeometryInfo<3>::face_to_cell_vertices(face, v)] =
                            true;
              });
      }

      std::string from = "upstream face", to = "downstream face";

      // of each material and point
      std::vector<std::vector<std::array<double, 8>>> shares;

      // of each owned cell, whether its corners lie on the two sets of faces
      std::vector<std::array<std::bitset<8>, 2>> touching;
      std::optional<CrackPaths>                  paths;

      // number of points that have left the elastic range, and whether they
      // lead from face to face
      std::size_t n_active    = 0;
      bool        active_path = false;

      // largest opening from face to face at one moment [mm], its time [s], and
      // its narrowest place [m]
      std::array<double, 5> most{};
    };

    const Registry<Observer>::Add<ThroughCracks> registered_through_cracks(
      "through cracks",
      "Through cracks of the dam: their opening at one moment all the way "
      "from one face to the other, in through_cracks.csv.");
  } // namespace
} // namespace Voussoir
