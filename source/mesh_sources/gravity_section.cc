#include <voussoir/base/error.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh_sources/generator.h>
#include <voussoir/mesh_sources/grading.h>
#include <voussoir/mesh_sources/lift_joints.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A slice of a gravity dam, optionally on rock. */
    class GravitySection : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        const Patterns::Double positive(1e-3);
        prm.add_parameter("Height", height, "Base to crest [m].", positive);
        prm.add_parameter(
          "Base width",
          base_width,
          "Base width along the river, from the heel to the toe [m].",
          positive);
        prm.add_parameter(
          "Upstream batter",
          batter,
          "Distance of the heel upstream of the crest's upstream edge, which "
          "is at y = 0 [m]; 0 for an upright face.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Batter elevation",
          batter_elevation,
          "Elevation up to which the upstream face is inclined [m above the "
          "base]; 0: up to the crest.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Neck elevation",
          neck_elevation,
          "Elevation at which the downstream face changes its slope [m above "
          "the base].",
          positive);
        prm.add_parameter("Neck width",
                          neck_width,
                          "Width at the neck [m].",
                          positive);
        prm.add_parameter("Crest width",
                          crest_width,
                          "Width at the crest [m].",
                          positive);
        prm.add_parameter("Thickness",
                          thickness,
                          "Thickness of the slice, along the dam's axis x [m].",
                          positive);
        prm.add_parameter("Cells",
                          cells,
                          "Number of cells in the dam along the axis, from "
                          "downstream to upstream, and over the height.",
                          Patterns::List(Patterns::Integer(1), 3, 3));
        LiftJoints::declare(prm, lift_height);
        prm.add_parameter("Rock extent",
                          rock_extent,
                          "Extent of the rock below, upstream and downstream "
                          "of the dam [m]; 0: no rock.",
                          Patterns::Double(0.));
        prm.add_parameter("Growth",
                          growth,
                          "Size ratio of successive rows of rock away from the "
                          "dam [-].",
                          Patterns::Double(1., 2.));
        prm.add_parameter(
          "Reservoir level",
          water_level,
          "Level of the water upstream of the dam, moved to the nearest row "
          "of cells [m above the base]; its cells are the set \"reservoir\". "
          "0: no water.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Reservoir length",
          water_length,
          "Length of the water [m], rounded to the cells of the rock if "
          "there is rock; 0: to the end of the rock.",
          Patterns::Double(0.));
      }

      void
      check() const override
      {
        if (neck_elevation >= height)
          throw UserError("In section \"Mesh/gravity section\" the \"Neck "
                          "elevation\" must be less than the \"Height\".");
        if (batter_elevation >= height)
          throw UserError("In section \"Mesh/gravity section\" the \"Batter "
                          "elevation\" must be less than the \"Height\"; write "
                          "0 for a face that leans up to the crest.");
        const std::vector<double> levels = bends();
        if (cells[2] + 1 < levels.size())
          throw UserError("\"Cells\" in section \"Mesh/gravity section\" must "
                          "be at least " +
                          std::to_string(levels.size() - 1) +
                          " over the height: the faces bend at inner "
                          "elevations, where cells must end.");
        for (const double z : levels)
          if (upstream_face(z) <= downstream_face(z))
            throw UserError("The dam of section \"Mesh/gravity section\" has "
                            "no width left at an elevation of " +
                            std::to_string(z) +
                            " m; choose a smaller \"Upstream batter\".");
        if (water_level > height)
          throw UserError("\"Reservoir level\" in section \"Mesh/gravity "
                          "section\" is above the crest; choose a lower one.");
        if (water_level > 0. && rock_extent > 0. && water_length > rock_extent)
          throw UserError("\"Reservoir length\" in section \"Mesh/gravity "
                          "section\" is more than the \"Rock extent\"; shorten "
                          "the reservoir or add rock.");
        if (water_level > 0. && rock_extent == 0. && water_length == 0.)
          throw UserError(
            "\"Reservoir length\" in section \"Mesh/gravity "
            "section\" is 0, to the end of the rock, but there is "
            "no rock; give a length.");
        const std::string place = "Section \"Mesh/gravity section\"";
        check_size(1. * cells[0] * cells[1] * cells[2], 1, place);
        const Lattice lattice = make_lattice();
        check_size(1. * cells[0] * lattice.base.size() *
                     lattice.elevations.size(),
                   1,
                   place);
      }

      CoarseMesh
      generate() const override
      {
        const Lattice      lattice = make_lattice();
        const unsigned int n_x = cells[0], n_y = lattice.base.size() - 1,
                           n_z = lattice.elevations.size() - 1;
        CoarseMesh       mesh;
        const LiftJoints lift_joints(lift_height,
                                     {lattice.elevations.begin() +
                                        lattice.base_row,
                                      lattice.elevations.end()});
        lift_joints.add_remark(mesh);
        std::vector<unsigned int> vertices((n_x + 1) * (n_y + 1) * (n_z + 1),
                                           numbers::invalid_unsigned_int);
        const auto                vertex = [&](const unsigned int i,
                                const unsigned int j,
                                const unsigned int k) {
          unsigned int &number = vertices[i + (n_x + 1) * (j + (n_y + 1) * k)];
          if (number == numbers::invalid_unsigned_int)
            {
              number = mesh.vertices.size();
              mesh.vertices.push_back(lattice_point(lattice, i, j, k));
            }
          return number;
        };

        for (unsigned int k = 0; k < n_z; ++k)
          for (unsigned int j = 0; j < n_y; ++j)
            for (unsigned int i = 0; i < n_x; ++i)
              if (lattice.is_rock(k) || lattice.is_dam(j, k) ||
                  lattice.is_water(j, k))
                {
                  std::array<unsigned int, 8> corners;
                  for (unsigned int v = 0; v < 8; ++v)
                    corners[v] =
                      vertex(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
                  mesh.cells.push_back(corners);
                  name_last_cell(mesh, lattice, lift_joints, i, j, k);
                }
        return mesh;
      }

    private:
      /** The lattice of the cells: rows between elevations, upwards, and
       *  between points of the base, from downstream to upstream. */
      struct Lattice
      {
        std::vector<double> base, elevations;
        unsigned int        toe, heel, base_row;    // limits of the dam
        unsigned int        water_end, surface_row; // and of the water

        bool
        is_rock(const unsigned int k) const
        {
          return k < base_row;
        }

        bool
        is_dam(const unsigned int j, const unsigned int k) const
        {
          return k >= base_row && j >= toe && j < heel;
        }

        bool
        is_water(const unsigned int j, const unsigned int k) const
        {
          return k >= base_row && j >= heel && j < water_end && k < surface_row;
        }
      };

      Lattice
      make_lattice() const
      {
        Lattice result;
        result.elevations = rows();
        result.base_row   = result.elevations.size() - 1 - cells[2];

        std::vector<double> &base = result.base;
        for (unsigned int j = 0; j <= cells[1]; ++j)
          base.push_back(batter + base_width * (double(j) / cells[1] - 1.));
        const std::vector<double> rock =
          distances(rock_extent, base_width / cells[1]);
        result.toe  = rock.size();
        result.heel = rock.size() + cells[1];
        for (const double distance : rock)
          base.insert(base.begin(), batter - base_width - distance);
        const std::vector<double> upstream =
          rock_extent > 0. || water_level == 0. ?
            rock :
            distances(water_length, base_width / cells[1]);
        for (const double distance : upstream)
          base.push_back(batter + distance);

        const bool has_water = water_level > 0.;
        result.surface_row =
          has_water ?
            nearest(result.elevations, result.base_row + 1, water_level) :
            0;
        result.water_end =
          !has_water ? result.heel :
          water_length > 0. ?
                       nearest(base, result.heel + 1, batter + water_length) :
                       base.size() - 1;
        return result;
      }

      /** Index of the value, from the first on, that is nearest to the wanted
       *  one. */
      static unsigned int
      nearest(const std::vector<double> &values,
              const unsigned int         first,
              const double               value)
      {
        return std::min_element(values.begin() + first,
                                values.end(),
                                [&](const double a, const double b) {
                                  return std::abs(a - value) <
                                         std::abs(b - value);
                                }) -
               values.begin();
      }

      /** Above the base the rows are inclined like the faces, and the water
       *  like the upstream one; the end of the water is vertical. */
      Point<3>
      lattice_point(const Lattice     &lattice,
                    const unsigned int i,
                    const unsigned int j,
                    const unsigned int k) const
      {
        const double z = lattice.elevations[k];
        double       y = lattice.base[j];
        if (z > 0. && y <= batter)
          y = upstream_face(z) + (y - batter) *
                                   (upstream_face(z) - downstream_face(z)) /
                                   base_width;
        else if (z > 0. && batter > 0.)
          {
            const double end = lattice.base[lattice.water_end];
            y = end - (end - y) * (end - upstream_face(z)) / (end - batter);
          }
        return {thickness * (double(i) / cells[0] - 0.5), y, z};
      }

      /** Adds the cell at a place of the lattice to its sets. */
      void
      name_last_cell(CoarseMesh        &mesh,
                     const Lattice     &lattice,
                     const LiftJoints  &lift_joints,
                     const unsigned int i,
                     const unsigned int j,
                     const unsigned int k) const
      {
        const unsigned int cell = mesh.cells.size() - 1;
        const bool is_rock = lattice.is_rock(k), is_dam = lattice.is_dam(j, k),
                   is_water = lattice.is_water(j, k);
        mesh.cell_sets[is_water ? "reservoir" :
                       is_dam   ? "dam" :
                                  "rock"]
          .push_back(cell);

        const auto side = [&](const bool         is_there,
                              const std::string &name,
                              const unsigned int face) {
          if (is_there)
            mesh.face_sets[name].push_back({cell, face});
        };
        const unsigned int n_y = lattice.base.size() - 1,
                           n_z = lattice.elevations.size() - 1;
        side(i == 0, "side minus", 0);
        side(i == cells[0] - 1, "side plus", 1);
        side(is_dam && j == lattice.toe, "downstream face", 2);
        side(is_dam && j == lattice.heel - 1, "upstream face", 3);
        side(is_dam && k == n_z - 1, "crest", 5);
        side(is_dam && k == lattice.base_row, "base", 4);
        const std::string joint =
          is_dam ? lift_joints.below(k - lattice.base_row) : "";
        side(!joint.empty(), joint, 4);
        side(is_water && k == lattice.surface_row - 1, "water surface", 5);
        side(is_water && j == lattice.water_end - 1, "reservoir end", 3);
        side(is_rock && j == 0, "downstream end", 2);
        side(is_rock && j == n_y - 1, "upstream end", 3);
        side(is_rock && k == 0, "bottom", 4);
        side(k + 1 == lattice.base_row &&
               (j < lattice.toe || j >= lattice.heel),
             "ground",
             5);
      }

      /** y of the faces at an elevation [m]; the faces are plane between the
       *  bends. */
      double
      upstream_face(const double z) const
      {
        return batter * std::max(0., 1. - z / leaning_height());
      }

      double
      downstream_face(const double z) const
      {
        const double toe  = batter - base_width,
                     neck = upstream_face(neck_elevation) - neck_width;
        return z < neck_elevation ?
                 toe + (neck - toe) * z / neck_elevation :
                 neck + (-crest_width - neck) * (z - neck_elevation) /
                          (height - neck_elevation);
      }

      double
      leaning_height() const
      {
        return batter_elevation > 0. ? batter_elevation : height;
      }

      /** Elevations from base to crest between which the faces are plane. */
      std::vector<double>
      bends() const
      {
        std::vector<double> levels{0., neck_elevation, height};
        if (batter > 0. && batter_elevation > 0.)
          levels.push_back(batter_elevation);
        std::sort(levels.begin(), levels.end());
        levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
        return levels;
      }

      /** Distances from the dam, up to @p extent, of rows of rock or water
       *  whose first has this size. */
      std::vector<double>
      distances(const double extent, const double size) const
      {
        std::vector<double> result;
        if (extent > 0.)
          for (const double point : graded_points(
                 extent, size, growth, std::numeric_limits<double>::max()))
            if (point > 0.)
              result.push_back(extent * point);
        return result;
      }

      /** Elevations of the rows from below; each bend is at a row. */
      std::vector<double>
      rows() const
      {
        const std::vector<double> levels  = bends();
        const unsigned int        n_parts = levels.size() - 1;
        std::vector<double>       result;
        for (unsigned int part = 0; part < n_parts; ++part)
          {
            // in proportion, and one at least for each part
            const int so_far = result.size(),
                      last   = part + 1 == n_parts ?
                                 int(cells[2]) :
                                 std::clamp<int>(std::lround(cells[2] *
                                                           levels[part + 1] /
                                                           height),
                                               so_far + 1,
                                               cells[2] + part + 1 - n_parts);
            for (int k = so_far; k < last; ++k)
              result.push_back(levels[part] +
                               (k - so_far) *
                                 (levels[part + 1] - levels[part]) /
                                 (last - so_far));
          }
        result.push_back(height);
        for (const double depth : distances(rock_extent, result[1]))
          result.insert(result.begin(), -depth);
        return result;
      }

      // Koyna
      double                    height           = 103.;
      double                    base_width       = 70.;
      double                    batter           = 0.;
      double                    batter_elevation = 0.;
      double                    neck_elevation   = 66.5;
      double                    neck_width       = 19.25;
      double                    crest_width      = 14.8;
      double                    thickness        = 1.;
      std::vector<unsigned int> cells{1, 10, 40};
      double                    lift_height  = 0.;
      double                    rock_extent  = 0.;
      double                    growth       = 1.2;
      double                    water_level  = 0.;
      double                    water_length = 0.;
    };

    const Registry<MeshGenerator>::Add<GravitySection> registered_gravity_section(
      "gravity section",
      "A slice of a gravity dam (the default is Koyna's), optionally on rock.");
  } // namespace
} // namespace Voussoir
