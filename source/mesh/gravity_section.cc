#include <voussoir/base/error.h>
#include <voussoir/mesh/generator.h>
#include <voussoir/mesh/grading.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A slice of a gravity dam, by choice on rock. */
    class GravitySection : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        const Patterns::Double positive(1e-3);
        prm.add_parameter("Height", height, "Base to crest [m].", positive);
        prm.add_parameter("Base width",
                          base_width,
                          "Along the river, from the vertical upstream face at "
                          "y = 0 to the downstream toe [m].",
                          positive);
        prm.add_parameter(
          "Neck elevation",
          neck_elevation,
          "Where the downstream face changes its slope [m above "
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
                          "Of the slice, along the dam's axis x [m].",
                          positive);
        prm.add_parameter("Cells",
                          cells,
                          "Number of cells in the dam along the axis, from "
                          "downstream to upstream, and over the height.",
                          Patterns::List(Patterns::Integer(1), 3, 3));
        prm.add_parameter("Rock extent",
                          rock_extent,
                          "Rock below, upstream and downstream of the dam [m]; "
                          "0: no rock.",
                          Patterns::Double(0.));
        prm.add_parameter("Growth",
                          growth,
                          "Size ratio of successive rows of rock away from the "
                          "dam [-].",
                          Patterns::Double(1., 2.));
        prm.add_parameter(
          "Reservoir level",
          water_level,
          "Water upstream of the dam up to the row of cells nearest to this "
          "level, cell set \"reservoir\" [m above the base]; 0: no water.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Reservoir length",
          water_length,
          "Length of the water [m], with rock rounded to its cells; 0: to the "
          "end of the rock.",
          Patterns::Double(0.));
      }

      void
      check() const override
      {
        if (neck_elevation >= height)
          throw UserError("In section \"Mesh/gravity section\" the \"Neck "
                          "elevation\" must be less than the \"Height\".");
        if (cells[2] < 2)
          throw UserError("\"Cells\" in section \"Mesh/gravity section\" must "
                          "be at least 2 over the height: one below and one "
                          "above the neck.");
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
      }

      CoarseMesh
      generate() const override
      {
        const std::vector<double> elevations = rows();
        const unsigned int        base_row   = elevations.size() - 1 - cells[2];

        // Points of the base from downstream to upstream.
        std::vector<double> base;
        for (unsigned int j = 0; j <= cells[1]; ++j)
          base.push_back(base_width * (double(j) / cells[1] - 1.));
        const std::vector<double> rock =
          distances(rock_extent, base_width / cells[1]);
        const unsigned int heel = rock.size() + cells[1], toe = rock.size();
        for (const double distance : rock)
          base.insert(base.begin(), -base_width - distance);
        const std::vector<double> upstream =
          rock_extent > 0. || water_level == 0. ?
            rock :
            distances(water_length, base_width / cells[1]);
        base.insert(base.end(), upstream.begin(), upstream.end());

        // where the water ends, by rows and by points of the base
        const auto nearest = [](const std::vector<double> &values,
                                const unsigned int         first,
                                const double               value) {
          return std::min_element(values.begin() + first,
                                  values.end(),
                                  [&](const double a, const double b) {
                                    return std::abs(a - value) <
                                           std::abs(b - value);
                                  }) -
                 values.begin();
        };
        const bool         has_water = water_level > 0.;
        const unsigned int surface =
          has_water ? nearest(elevations, base_row + 1, water_level) : 0;
        const unsigned int end =
          !has_water        ? heel :
          water_length > 0. ? nearest(base, heel + 1, water_length) :
                              base.size() - 1;

        CoarseMesh         mesh;
        const unsigned int n_x = cells[0], n_y = base.size() - 1,
                           n_z = elevations.size() - 1;
        std::vector<unsigned int> vertices((n_x + 1) * (n_y + 1) * (n_z + 1),
                                           numbers::invalid_unsigned_int);
        const auto                vertex = [&](unsigned int i,
                                unsigned int j,
                                unsigned int k) {
          unsigned int &number = vertices[i + (n_x + 1) * (j + (n_y + 1) * k)];
          if (number == numbers::invalid_unsigned_int)
            {
              const double z = elevations[k];
              const double y = base[j];
              number         = mesh.vertices.size();
              mesh.vertices.emplace_back(thickness * (double(i) / n_x - 0.5),
                                         z > 0. && y < 0. ?
                                                          y * width(z) / base_width :
                                                          y,
                                         z);
            }
          return number;
        };

        for (unsigned int k = 0; k < n_z; ++k)
          for (unsigned int j = 0; j < n_y; ++j)
            for (unsigned int i = 0; i < n_x; ++i)
              {
                const bool above = k >= base_row, in_dam = j >= toe && j < heel;
                const bool in_water =
                  above && j >= heel && j < end && k < surface;
                if (above && !in_dam && !in_water)
                  continue;
                const unsigned int          cell = mesh.cells.size();
                std::array<unsigned int, 8> corners;
                for (unsigned int v = 0; v < 8; ++v)
                  corners[v] =
                    vertex(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
                mesh.cells.push_back(corners);
                mesh.cell_sets[in_water ? "reservoir" :
                               above    ? "dam" :
                                          "rock"]
                  .push_back(cell);

                const auto side = [&](const bool         is_there,
                                      const std::string &name,
                                      const unsigned int face) {
                  if (is_there)
                    mesh.face_sets[name].push_back({cell, face});
                };
                side(i == 0, "side minus", 0);
                side(i == n_x - 1, "side plus", 1);
                side(above && j == toe, "downstream face", 2);
                side(above && j == heel - 1, "upstream face", 3);
                side(in_dam && k == n_z - 1, "crest", 5);
                side(in_dam && k == base_row, "base", 4);
                side(in_water && k == surface - 1, "water surface", 5);
                side(in_water && j == end - 1, "reservoir end", 3);
                side(!above && j == 0, "downstream end", 2);
                side(!above && j == n_y - 1, "upstream end", 3);
                side(!above && k == 0, "bottom", 4);
                side(k + 1 == base_row && !in_dam, "ground", 5);
              }
        return mesh;
      }

    private:
      double
      width(const double z) const
      {
        return z < neck_elevation ?
                 base_width + (neck_width - base_width) * z / neck_elevation :
                 neck_width + (crest_width - neck_width) *
                                (z - neck_elevation) /
                                (height - neck_elevation);
      }

      /** Distances from the dam, up to @p extent, of the rows of rock or water
       *  that begin with a size. */
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

      /** Elevations of the rows, one of them at the neck, from below. */
      std::vector<double>
      rows() const
      {
        const int below = std::max<int>(
          1,
          std::min<int>(cells[2] - 1,
                        std::lround(cells[2] * neck_elevation / height)));
        const int           above = cells[2] - below;
        std::vector<double> result;
        for (const double depth :
             distances(rock_extent, neck_elevation / below))
          result.insert(result.begin(), -depth);
        for (int k = 0; k < below; ++k)
          result.push_back(k * neck_elevation / below);
        for (int k = 0; k < above; ++k)
          result.push_back(neck_elevation +
                           k * (height - neck_elevation) / above);
        result.push_back(height);
        return result;
      }

      // Koyna
      double                    height         = 103.;
      double                    base_width     = 70.;
      double                    neck_elevation = 66.5;
      double                    neck_width     = 19.25;
      double                    crest_width    = 14.8;
      double                    thickness      = 1.;
      std::vector<unsigned int> cells{1, 10, 40};
      double                    rock_extent  = 0.;
      double                    growth       = 1.2;
      double                    water_level  = 0.;
      double                    water_length = 0.;
    };

    const Registry<MeshGenerator>::Add<GravitySection> registered(
      "gravity section",
      "A slice of a gravity dam (the default is Koyna's), by choice on rock.");
  } // namespace
} // namespace Voussoir
