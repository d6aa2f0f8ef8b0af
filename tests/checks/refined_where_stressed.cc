#include <voussoir/base/mpi.h>

#include <set>

#include "contact_mesh.h"
#include "folders.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A cantilever of length L and height h under a force P at its end, in
     * cubic cells: with the bending moment P (L - x) the stress is
     *   P (L - x) z / I ,   I = b h^3 / 12 ,
     * z from the axis. A second case refines its cells where this stress
     * exceeds a share of the strength, and the ring of cells around them.
     */
    class RefinedWhereStressed : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"bent"}, communicator);
        const auto linear = make_case(file.with({"Output/Folder=bent"}));
        make_simulation_with_files(*linear, communicator)->run.march();

        const ParameterFile cracking =
          file.with({"Materials/concrete/Class=concrete damage",
                     "Materials/concrete/Fracture energy=160",
                     "Mesh/Refine where/Demand of=bent",
                     "Mesh/Refine where/Threshold=" + std::to_string(limit)});
        const RefinedMesh alone(cracking, MPI_COMM_SELF);
        const auto        expected = chosen_cells();
        verdicts.near("chosen cells",
                      alone.summary.chosen,
                      expected.size(),
                      0.);
        bool right = true;
        for (const auto &[coarse, levels] : alone.levels)
          right = right &&
                  (levels == std::set<int>{2}) == (expected.count(coarse) > 0);
        verdicts.is_true("refined twice: these, and no others", right);
        verdicts.near("cells in their place",
                      alone.summary.fine,
                      64. * expected.size(),
                      0.);
        verdicts.near("their longest edge [m]",
                      alone.summary.longest,
                      0.25 * cell,
                      1e-12);
        verdicts.near("that stay longer than asked for",
                      alone.summary.too_long,
                      0.,
                      0.);
        for (const std::string partition : {"p4est", "METIS"})
          {
            const RefinedMesh together(
              cracking.with({"Mesh/Partition=" + partition}), communicator);
            verdicts.is_true("same cells on all ranks, by " + partition,
                             together.keys == alone.keys &&
                               together.summary.chosen ==
                                 alone.summary.chosen &&
                               together.summary.lower == alone.summary.lower);
          }

        const auto changed = [&](const std::vector<std::string> &changes) {
          return RefinedMesh(cracking.with(changes), communicator).summary;
        };
        verdicts.near("chosen cells where x > 20 m",
                      changed({"Mesh/Refine where/Expression=x > 20"}).chosen,
                      std::count_if(expected.begin(),
                                    expected.end(),
                                    [](const auto &place) {
                                      return (place.first + 0.5) * cell > 20.;
                                    }),
                      0.);
        const RefinementSummary once = changed({"Mesh/Refine where/Levels=1"});
        verdicts.near("one level: cells that stay longer",
                      once.too_long,
                      8. * expected.size(),
                      0.);
        const RefinementSummary none =
          changed({"Mesh/Refine where/Threshold=3"});
        verdicts.is_true("a threshold that no cell reaches: nothing",
                         none.chosen == 0 && none.before == none.after);
        verdicts.is_true(
          "a longer beam: refused",
          is_refused([&] { changed({"Mesh/box/Upper corner=80, 2, 8"}); },
                     "a run of another model"));
        verdicts.is_true(
          "other materials: refused",
          is_refused(
            [&] {
              RefinedMesh(file.with({"Materials/Names=mortar",
                                     "Materials/mortar/Class=concrete damage",
                                     "Materials/mortar/Cell sets=box",
                                     "Mesh/Refine where/Demand of=bent"}),
                          communicator);
            },
            "a run with a material \"concrete\""));
      }

    private:
      static constexpr double length = 40., height = 8., width = 2., cell = 2.,
                              force = 2.13333e6, strength = 2e6, limit = 0.83;

      using Place = std::pair<int, int>; // along the beam and upwards

      /** The mesh of a case, by its cells. */
      struct RefinedMesh
      {
        RefinedMesh(const ParameterFile &file, const MPI_Comm communicator)
        {
          const auto  parameters = make_case(file);
          Log         log(communicator, true);
          const Model model(*parameters, log);
          summary = model.grid.refinement();
          std::vector<std::uint64_t>      own;
          std::vector<std::array<int, 3>> own_levels;
          for (const auto &cell_of_mesh :
               model.grid.triangulation().active_cell_iterators())
            if (cell_of_mesh->is_locally_owned())
              {
                own.push_back(Grid::global_key(cell_of_mesh));
                const Point<3> x = cell_of_mesh->center();
                own_levels.push_back({{int(x[0] / cell),
                                       int(x[2] / cell),
                                       cell_of_mesh->level()}});
              }
          for (const auto key : join_over_ranks(own, communicator))
            keys.insert(key);
          for (const auto &[along, upwards, level] :
               join_over_ranks(own_levels, communicator))
            levels[{along, upwards}].insert(level);
        }

        RefinementSummary              summary;
        std::set<std::uint64_t>        keys;
        std::map<Place, std::set<int>> levels; // of the cells in a coarse one
      };

      static std::set<Place>
      chosen_cells()
      {
        constexpr double inertia = width * height * height * height / 12.;
        std::set<Place>  chosen;
        for (int i = 0; i < length / cell; ++i)
          for (int k = 0; k < height / cell; ++k)
            if (force * (length - i * cell) * ((k + 1) * cell - 0.5 * height) /
                  inertia >
                limit * strength)
              for (const int along : {i - 1, i, i + 1})
                for (const int upwards : {k - 1, k, k + 1})
                  if (along >= 0 && along < length / cell && upwards >= 0 &&
                      upwards < height / cell)
                    chosen.insert({along, upwards});
        return chosen;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<RefinedWhereStressed>
      registered("refined where stressed",
                 "Cells are refined where an earlier run is stressed.");
  } // namespace
} // namespace Voussoir
