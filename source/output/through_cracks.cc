#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/tension_split.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/output/table_observer.h>

#include <deal.II/base/geometry_info.h>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/serialization/array.hpp>

#include <bitset>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string cracks_section = "section \"Output/through cracks\"";


    /** An eighth of a cell, at one of its corners, with a crack in it. */
    struct CrackedEighth
    {
      double                  opening; // [mm]
      std::uint64_t           cell;    // Grid::global_key
      unsigned int            corner;  // of the cell
      types::global_dof_index node;    // there
      Point<3>                where;   // that is [m]

      // of the edges of the cell that begin there, in thousandths, as those of
      // cells of other size begin there too
      std::array<std::array<int, 3>, 3> directions;

      bool begins, ends; // at the two faces

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &opening &cell &corner &node &where &directions &begins &ends;
      }
    };


    /** A path from face to face. */
    struct Way
    {
      double   opening = 0.; // smallest opening along it [mm]
      Point<3> where;        // that is [m]
    };


    /**
     * The widest opening that a chain of eighths of cells has everywhere on its
     * way from one face to the other; 0 if there is no such chain. Eighths of
     * one cell are next to each other unless they lie across its middle, those
     * of two cells if an edge of both begins in their corner. They are added in
     * the order of their opening until a chain is complete.
     */
    Way
    widest_way(std::vector<CrackedEighth> eighths)
    {
      const auto none = [&](const bool CrackedEighth::*at_face) {
        return std::none_of(eighths.begin(),
                            eighths.end(),
                            [&](const auto &one) { return one.*at_face; });
      };
      if (none(&CrackedEighth::begins) || none(&CrackedEighth::ends))
        return {};
      std::sort(eighths.begin(),
                eighths.end(),
                [](const auto &a, const auto &b) {
                  return a.opening > b.opening;
                });
      boost::disjoint_sets_with_storage<> chains(eighths.size());
      std::vector<bool> begins(eighths.size()), ends(eighths.size()); // of one
      std::map<std::pair<types::global_dof_index, std::array<int, 3>>,
               std::size_t>
                                                        at_edge;
      std::map<std::uint64_t, std::vector<std::size_t>> in_cell;
      for (std::size_t i = 0; i < eighths.size(); ++i)
        {
          const CrackedEighth &own = eighths[i];
          begins[i]                = own.begins;
          ends[i]                  = own.ends;
          const auto join          = [&](const std::size_t other) {
            const std::size_t a = chains.find_set(other),
                              b = chains.find_set(i);
            const bool begin = begins[a] || begins[b], end = ends[a] || ends[b];
            chains.link(a, b);
            const std::size_t whole = chains.find_set(i);
            begins[whole]           = begin;
            ends[whole]             = end;
          };
          for (const auto &direction : own.directions)
            {
              const auto [known, is_first] =
                at_edge.insert({{own.node, direction}, i});
              if (!is_first)
                join(known->second);
            }
          auto &others = in_cell[own.cell];
          for (const std::size_t other : others)
            if ((eighths[other].corner ^ own.corner) != 7)
              join(other);
          others.push_back(i);
          if (const std::size_t chain = chains.find_set(i);
              begins[chain] && ends[chain])
            return {own.opening, own.where};
        }
      return {};
    }


    /** The edges that begin in a corner of a cell, see CrackedEighth. */
    std::array<std::array<int, 3>, 3>
    directions_at(const Discretization::Cell &cell, const unsigned int corner)
    {
      std::array<std::array<int, 3>, 3> directions;
      for (unsigned int k = 0; k < 3; ++k)
        {
          Tensor<1, 3> edge =
            cell->vertex(corner ^ (1 << k)) - cell->vertex(corner);
          edge /= edge.norm();
          for (unsigned int d = 0; d < 3; ++d)
            directions[k][d] = std::lround(1e3 * edge[d]);
        }
      return directions;
    }


    /** Shares of the integration points of a cell in the mean of each eighth:
     *  those in it, and those between it and its neighbours by halves. */
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
                           return tells_of_cracks(*material);
                         }))
          throw UserError(
            "No material of the case cracks, but " + cracks_section +
            " looks for cracks; remove the observer \"through cracks\", or "
            "give a material a law that cracks.");
      }

      void
      observe(const State &state) override
      {
        if (!is_due(state.step))
          return;
        const Ways ways = find_ways();
        compare(ways, state.time);
        if (has_line(state.step))
          table.write(state.time, {ways.now.opening, ways.ever.opening});
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
        open_table({"opening from face to face now [mm]",
                    "largest openings ever from face to face [mm]"});
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        const Ways ways = find_ways();
        compare(ways, state.time);
        summary["through cracks"] = {
          {"largest opening from face to face at one moment [mm]", most[0]},
          {"at the time [s]", most[1]},
          {"opening from face to face at the end [mm]", ways.now.opening},
          {"largest openings ever from face to face [mm]", ways.ever.opening}};
        if (most[0] > 0.)
          summary["through cracks"]["at [m]"] = {most[2], most[3], most[4]};
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

      /** Widest openings from face to face [mm]. */
      struct Ways
      {
        Way now;
        Way ever; // by the largest openings, which need not be of one moment
      };

      void
      compare(const Ways &ways, const double time)
      {
        if (const auto &[opening, where] = ways.now;
            !(opening <= most[0])) // a NaN stays
          most = {{opening, time, where[0], where[1], where[2]}};
      }

      Ways
      find_ways() const
      {
        const Discretization &discretization = run().solid.discretization;
        using OfEighths                      = std::array<double, 8>;
        struct Cracked
        {
          Discretization::Cell cell;
          OfEighths            now{}, ever{};
        };
        std::vector<Cracked> cells;
        for_each_crack(run(),
                       [&](const Discretization::Cell &cell,
                           const unsigned int          q,
                           const double,
                           const CrackOpening &opening) {
                         if (opening.largest == 0.)
                           return;
                         if (cells.empty() || cells.back().cell != cell)
                           cells.push_back({cell});
                         const auto &share =
                           shares[run().solid.grid().material(cell)][q];
                         for (unsigned int corner = 0; corner < 8; ++corner)
                           {
                             const double factor = 1e3 * share[corner];
                             cells.back().now[corner] += factor * opening.now;
                             cells.back().ever[corner] +=
                               factor * opening.largest;
                           }
                       });
        std::array<std::vector<CrackedEighth>, 2> mine;
        for (const Cracked &cracked : cells)
          {
            const auto  nodes = discretization.cell_nodes(cracked.cell);
            const auto &touched =
              touching[discretization.grid.owned_cell(cracked.cell)];
            for (unsigned int corner = 0; corner < 8; ++corner)
              {
                CrackedEighth one{cracked.now[corner],
                                  Grid::global_key(cracked.cell),
                                  corner,
                                  nodes[corner], // vertices come first
                                  cracked.cell->vertex(corner),
                                  directions_at(cracked.cell, corner),
                                  touched[0][corner],
                                  touched[1][corner]};
                if (one.opening > 0.)
                  mine[0].push_back(one);
                one.opening = cracked.ever[corner];
                if (one.opening > 0.)
                  mine[1].push_back(one);
              }
          }
        return {widest_way(join_over_ranks(mine[0], communicator())),
                widest_way(join_over_ranks(mine[1], communicator()))};
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

      // largest opening from face to face at one moment [mm], when [s], and
      // where it was narrowest [m]
      std::array<double, 5> most{};
    };

    const Registry<Observer>::Add<ThroughCracks> registered_through_cracks(
      "through cracks",
      "Cracks that go through the dam: how wide they are open at one moment "
      "all the way from one face to the other, in through_cracks.csv.");
  } // namespace
} // namespace Voussoir
