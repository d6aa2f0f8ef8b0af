#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/tension_split.h>
#include <voussoir/output/material_memory.h>
#include <voussoir/output/table.h>

#include <deal.II/base/geometry_info.h>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/serialization/array.hpp>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string section = "section \"Output/through cracks\"";


    /** A cell with a crack in it. */
    struct CrackedCell
    {
      double                                 opening; // [mm]
      std::array<types::global_dof_index, 8> corners;
      bool                                   begins, ends; // at the two faces

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &opening &corners &begins &ends;
      }
    };


    /**
     * The widest opening that a chain of cells, each next to the last one by an
     * edge, has everywhere on its way from one face to the other; 0 if there is
     * no such chain. Cells are taken in from the most open one on until a chain
     * is whole.
     */
    double
    widest_way(std::vector<CrackedCell> cells)
    {
      std::sort(cells.begin(), cells.end(), [](const auto &a, const auto &b) {
        return a.opening > b.opening;
      });
      boost::disjoint_sets_with_storage<> chains(cells.size());
      std::vector<bool> begins(cells.size()), ends(cells.size()); // of a chain
      using Edge = std::pair<types::global_dof_index, types::global_dof_index>;
      std::map<Edge, std::size_t> cell_at;
      for (std::size_t i = 0; i < cells.size(); ++i)
        {
          begins[i] = cells[i].begins;
          ends[i]   = cells[i].ends;
          for (unsigned int line = 0; line < GeometryInfo<3>::lines_per_cell;
               ++line)
            {
              const Edge edge = std::minmax(
                cells[i]
                  .corners[GeometryInfo<3>::line_to_cell_vertices(line, 0)],
                cells[i]
                  .corners[GeometryInfo<3>::line_to_cell_vertices(line, 1)]);
              const auto [other, is_first] = cell_at.insert({edge, i});
              if (is_first)
                continue;
              const std::size_t a = chains.find_set(other->second),
                                b = chains.find_set(i);
              chains.link(a, b);
              const std::size_t whole = chains.find_set(i);
              begins[whole]           = begins[a] || begins[b];
              ends[whole]             = ends[a] || ends[b];
            }
          if (const std::size_t chain = chains.find_set(i);
              begins[chain] && ends[chain])
            return cells[i].opening;
        }
      return 0.;
    }


    /** Cracks that go through from one face of the dam to the other. */
    class ThroughCracks : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("From", from, "Face sets on which a crack begins.");
        prm.add_parameter("To", to, "Face sets on which it ends.");
        prm.add_parameter("Interval",
                          interval,
                          "Time between two lines of through_cracks.csv [s].",
                          Patterns::Double(1e-6));
      }

      double
      record_interval() const override
      {
        return interval;
      }

      void
      check(const ObservedModel &model) const override
      {
        check_sets(model, "\"From\" in " + section, from);
        check_sets(model, "\"To\" in " + section, to);
        if (std::none_of(model.materials.begin(),
                         model.materials.end(),
                         tells_of_cracks))
          throw UserError("No material of the case cracks, but " + section +
                          " looks for cracks; leave out the observer "
                          "\"through cracks\", or give a material a law that "
                          "cracks.");
      }

      void
      prepare(const ObservedModel &observed,
              const double         start_time,
              const bool           restarted) override
      {
        model    = std::make_unique<ObservedModel>(observed);
        schedule = Schedule(interval, observed.time_step);
        table.open(observed.log,
                   observed.folder + "/through_cracks.csv",
                   {title},
                   observed.time_step,
                   start_time,
                   restarted);
      }

      void
      observe(const State &state) override
      {
        if (schedule.due(state.step))
          table.write(state.time, {widest_opening()});
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        table.flush();
        summary["through cracks"][title] = widest_opening();
      }

    private:
      static void
      check_sets(const ObservedModel &model,
                 const std::string   &place,
                 const std::string   &list)
      {
        const auto sets = split_list(list);
        if (sets.empty())
          throw UserError(place + " is empty; name a face set.");
        for (const std::string &set : sets)
          model.discretization.grid.check_face_set(set, place);
      }

      static bool
      tells_of_cracks(const Material *material)
      {
        const auto names = material->output_names();
        return std::find(names.begin(),
                         names.end(),
                         OutputName::crack_opening) != names.end();
      }

      /** [mm] */
      double
      widest_opening() const
      {
        const Discretization &discretization = model->discretization;
        const auto            openings =
          memory_of_cells(*model).at(OutputName::crack_opening);
        const auto begins = split_list(from), ends = split_list(to);
        std::vector<CrackedCell> mine;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned() &&
              openings[cell->active_cell_index()] > 0.)
            {
              const auto nodes = discretization.cell_nodes(cell);
              mine.push_back({openings[cell->active_cell_index()],
                              {},
                              touches(cell, begins),
                              touches(cell, ends)});
              // vertices come first
              std::copy_n(nodes.begin(), 8, mine.back().corners.begin());
            }
        return widest_way(
          join_over_ranks(mine, discretization.grid.communicator()));
      }

      bool
      touches(const Discretization::Cell     &cell,
              const std::vector<std::string> &sets) const
      {
        const Grid &grid = model->discretization.grid;
        for (const std::string &set : sets)
          for (const unsigned int face : cell->face_indices())
            if (grid.in_face_set(cell, face, set))
              return true;
        return false;
      }

      static inline const std::string title =
        "widest opening from face to face [mm]";

      std::string from = "upstream face", to = "downstream face";
      double      interval = 0.1;

      std::unique_ptr<ObservedModel> model;
      Schedule                       schedule;
      TimeTable                      table;
    };

    const Registry<Observer>::Add<ThroughCracks> registered(
      "through cracks",
      "Cracks that go through the dam: how wide they are open all the way from "
      "one face to the other, in through_cracks.csv.");
  } // namespace
} // namespace Voussoir
