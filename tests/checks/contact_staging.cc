#include <voussoir/mesh_sources/generator.h>

#include "contact_sums.h"
#include "csv_table.h"
#include "same.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_blocks = 3;

    /** Blocks in a row along x, "left wall", "block 1" and so on, "right wall",
     *  which are as wide as long; y runs across the row. */
    class Row : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length",
                          length,
                          "Length of a block along the row [m].");
        prm.add_parameter("Height", height, "[m].");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        constexpr unsigned int n = n_blocks + 2;
        CoarseMesh             mesh;
        const auto             vertex =
          [&](unsigned int i, unsigned int j, unsigned int k) {
            return i + (n + 1) * (j + 2 * k);
          };
        for (unsigned int k = 0; k <= n_layers; ++k)
          for (unsigned int j = 0; j < 2; ++j)
            for (unsigned int i = 0; i <= n; ++i)
              mesh.vertices.emplace_back(length * i,
                                         length * (j - 0.5),
                                         height * k / n_layers);
        for (unsigned int k = 0; k < n_layers; ++k)
          for (unsigned int i = 0; i < n; ++i)
            {
              const unsigned int          cell = mesh.cells.size();
              std::array<unsigned int, 8> corners;
              for (unsigned int v = 0; v < 8; ++v)
                corners[v] = vertex(i + (v & 1), (v >> 1) & 1, k + (v >> 2));
              mesh.cells.push_back(corners);
              const bool wall = i == 0 || i == n - 1;
              mesh
                .cell_sets[i == 0     ? "left wall" :
                           i == n - 1 ? "right wall" :
                                        "block " + std::to_string(i)]
                .push_back(cell);
              mesh.cell_sets[wall ? "walls" : "blocks"].push_back(cell);
              if (wall)
                for (const unsigned int face : {0, 1})
                  {
                    // the sides of the walls at the blocks, and away from them
                    const bool inner = (face == 1) == (i == 0);
                    mesh
                      .face_sets[inner ? (i == 0 ? "left end" : "right end") :
                                         "outside"]
                      .push_back({cell, face});
                  }
              else
                {
                  mesh.face_sets["front"].push_back({cell, 2});
                  mesh.face_sets["back"].push_back({cell, 3});
                  if (i < n_blocks)
                    mesh.face_sets["joint " + std::to_string(i)].push_back(
                      {cell, 1});
                }
              if (k == 0)
                mesh.face_sets["bottom"].push_back({cell, 4});
            }
        return mesh;
      }

    private:
      static constexpr unsigned int n_layers = 4;

      double length = 2., height = 8.;
    };

    const Registry<MeshGenerator>::Add<Row>
      registered_mesh("row", "A row of blocks between walls, for tests.");


    /**
     * Blocks between rigid walls that slide on their base: their weight makes
     * them wider. Joined from the start they press against each other with nu
     * rho g H^2 / 2 per width; free-standing blocks do not. If these are then
     * pressed with q from both sides across the row, they press against each
     * other with nu q H. All stresses are those of plane sections.
     */
    class Staging : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double nu = number_in(file, "Materials/concrete/Poisson's ratio"),
                     E  = number_in(file, "Materials/concrete/Young's modulus"),
                     rho    = number_in(file, "Materials/concrete/Density"),
                     L      = number_in(file, "Mesh/row/Length"),
                     H      = number_in(file, "Mesh/row/Height"),
                     q      = number_in(file, "Loads/water/Pressure");
        const double weight = rho * gravity * L * L * H,
                     thrust_of_weight = nu * 0.5 * rho * gravity * H * H * L,
                     thrust_of_water  = nu * q * H * L;
        const auto after              = [&](const std::string &stages,
                               const std::string &grouted_after) {
          return file.with(
            {"Static state/Stages=" + stages,
             "Interfaces/joints/Grouted after=" + grouted_after});
        };
        const auto compare = [&](const std::string   &name,
                                 const ParameterFile &stages,
                                 const double         expected) {
          const auto parameters = make_case(stages);
          const auto simulation = make_simulation(*parameters, communicator);
          for (const auto &stage :
               simulation->static_state.summary.at("stages"))
            verdicts.is_true(name + "found by multigrid",
                             stage.at("found by multigrid").get<bool>());
          double largest = 0., smallest = 1e300, opening = 0., slip = 0.;
          for (unsigned int s = 0;
               s < simulation->run.contact->surface_names().size();
               ++s)
            {
              const ContactSums sums = contact_sums(*simulation, s);
              keep_largest(largest, sums.pressure);
              keep_smallest(smallest, sums.pressure);
            }
          for (const ContactPoint &point : simulation->run.contact->points())
            {
              keep_largest(opening, std::abs(point.gap[0]));
              if (point.surface < 2) // between blocks
                keep_largest(slip,
                             std::abs(point.gap[1] * point.frame[1][2] +
                                      point.gap[2] * point.frame[2][2]));
            }
          opening = Utilities::MPI::max(opening, communicator);
          slip    = Utilities::MPI::max(slip, communicator);
          if (expected == 0.)
            verdicts.below(name + "thrust over the weight of a block",
                           largest / weight,
                           1e-6);
          else
            {
              verdicts.near(name + "largest thrust [kN]",
                            1e-3 * largest,
                            1e-3 * expected,
                            0.001);
              verdicts.near(name + "smallest thrust [kN]",
                            1e-3 * smallest,
                            1e-3 * expected,
                            0.001);
            }
          verdicts.below(name + "opening or overlap of the joints [m]",
                         opening,
                         1e-12);
          verdicts.below(name + "vertical slip between the blocks [m]",
                         slip,
                         1e-9);

          // The gap counts from the places of the blocks at grouting; away from
          // the base each of them grows by nu sigma L / E. Their position
          // between the walls is indeterminate.
          const unsigned int n_surfaces =
            simulation->run.contact->surface_names().size();
          std::vector<double> overlap(n_surfaces), points(n_surfaces);
          for (unsigned int k = 0; k < simulation->run.contact->points().size();
               ++k)
            if (const ContactPoint &point =
                  simulation->run.contact->points()[k];
                std::abs(simulation->run.contact->positions()[k][2] - 0.5 * H) <
                1e-6)
              {
                overlap[point.surface] += point.initial_gap[0];
                points[point.surface] += 1.;
              }
          Utilities::MPI::sum(overlap, communicator, overlap);
          Utilities::MPI::sum(points, communicator, points);
          double sum = 0.;
          for (unsigned int s = 0; s < n_surfaces; ++s)
            sum += overlap[s] / points[s];
          return sum;
        };

        compare("joined from the start, weight: ",
                after("weight", ""),
                thrust_of_weight);
        const double overlap =
          compare("free-standing, weight: ", after("weight", "weight"), 0.);
        verdicts.near("  overlap at half the height when they are grouted [mm]",
                      1e3 * overlap,
                      0.5e3 * n_blocks * nu * rho * gravity * H * L / E,
                      0.001);
        compare_displacements(after("weight; water", "weight"),
                              -0.5 * rho * gravity * H * H / E,
                              nu * (1. + nu) * q * H / E,
                              verdicts,
                              communicator);
        compare(
          "then water: ", after("weight; water", "weight"), thrust_of_water);
        compare("joined from the start, weight and water: ",
                after("weight; water", ""),
                thrust_of_weight + thrust_of_water);
      }

    private:
      static constexpr double gravity = 9.81;

      /** The rise of a block's top, in total and since later states. The foot
       *  of a block that stands free disturbs the plane sections a little. */
      static void
      compare_displacements(const ParameterFile &stages,
                            const double         of_weight,
                            const double         of_water,
                            Verdicts            &verdicts,
                            const MPI_Comm       communicator)
      {
        const auto parameters = make_case(stages.with(
          {"Output/Folder=since",
           "Output/Observers=histories, fields",
           "Output/histories/Points=top: 5 0 8",
           "Output/histories/Quantities=displacement, displacement since "
           "static state, displacement since grouting",
           "Output/fields/Times=0",
           "Output/fields/Quantities=displacement since static state, "
           "displacement since grouting",
           "Time/End time=0.01"}));
        make_simulation_with_files(*parameters, communicator)->run.march();
        MPI_Barrier(communicator);

        const CsvTable table("since/histories.csv");
        const auto     rise = [&](const std::string &name) {
          return table.numbers("top displacement " + name + "z [m]").at(0);
        };
        verdicts.near("rise of the top [mm]",
                      1e3 * rise(""),
                      1e3 * (of_weight + of_water),
                      0.01);
        verdicts.near("  since the blocks were grouted",
                      1e3 * rise("since grouting "),
                      1e3 * of_water,
                      0.001);
        verdicts.below("  since the static state [m]",
                       std::abs(rise("since static state ")),
                       1e-12);
        for (const std::string origin : {"static_state", "grouting"})
          verdicts.is_true("  pictures have displacement_since_" + origin,
                           text_of("since/fields/fields-00000000.vtu")
                               .find("\"displacement_since_" + origin + '"') !=
                             std::string::npos);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<Staging>
      registered("contact staging", "Blocks that are grouted after a stage.");
  } // namespace
} // namespace Voussoir
