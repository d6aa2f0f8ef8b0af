#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh_sources/generator.h>

#include <cmath>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A box of hexahedra, optionally in horizontal layers; a column is a box.
     */
    class Box : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Lower corner", lower, "x, y, z [m].");
        prm.add_parameter("Upper corner", upper, "x, y, z [m].");
        prm.add_parameter("Cells",
                          cells,
                          "Number of cells in x, y and z.",
                          Patterns::List(Patterns::Integer(1), 3, 3));
        prm.add_parameter(
          "Layers",
          layers_text,
          "Cell sets by height, from below, \"name: top elevation\" [m] "
          "separated by \";\"; the last one reaches to the top and needs no "
          "elevation. Cells belong to sets by their centres.");
        prm.add_parameter(
          "Distortion",
          distortion,
          "Displacement of the inner vertices over the cell size, for tests "
          "of cells of general shape.",
          Patterns::Double(0., 0.4));
      }

      void
      check() const override
      {
        for (unsigned int d = 0; d < 3; ++d)
          if (lower[d] >= upper[d])
            {
              std::ostringstream text;
              text << "\"Upper corner\" in section \"Mesh/box\" is " << upper[d]
                   << " m in "
                   << "xyz"[d] << ", but must lie above the \"Lower corner\", "
                   << lower[d] << " m; correct one of them.";
              throw UserError(text.str());
            }
        layers();
        check_size(1. * cells[0] * cells[1] * cells[2],
                   1,
                   "\"Cells\" in section \"Mesh/box\"");
      }

      CoarseMesh
      generate() const override
      {
        CoarseMesh                        mesh;
        const std::array<unsigned int, 3> n{{cells[0], cells[1], cells[2]}};
        const auto                        vertex =
          [&](unsigned int i, unsigned int j, unsigned int k) {
            return i + (n[0] + 1) * (j + (n[1] + 1) * k);
          };
        for (unsigned int k = 0; k <= n[2]; ++k)
          for (unsigned int j = 0; j <= n[1]; ++j)
            for (unsigned int i = 0; i <= n[0]; ++i)
              {
                const std::array<unsigned int, 3> index{{i, j, k}};
                Point<3>                          x;
                for (unsigned int d = 0; d < 3; ++d)
                  {
                    const double h = (upper[d] - lower[d]) / n[d];
                    // the last vertex exactly at the upper corner
                    x[d] =
                      index[d] == n[d] ? upper[d] : lower[d] + index[d] * h;
                    if (index[d] > 0 && index[d] < n[d])
                      x[d] +=
                        distortion * h *
                        std::sin(1. + 12.9 * i + 78.2 * j + 37.7 * k + 2. * d);
                  }
                mesh.vertices.push_back(x);
              }

        const auto list = layers();
        const auto side = [&](const std::string &name,
                              const unsigned int cell,
                              const unsigned int face) {
          mesh.face_sets[name].push_back({cell, face});
        };
        for (unsigned int k = 0; k < n[2]; ++k)
          for (unsigned int j = 0; j < n[1]; ++j)
            for (unsigned int i = 0; i < n[0]; ++i)
              {
                const unsigned int          cell = mesh.cells.size();
                std::array<unsigned int, 8> corners;
                for (unsigned int v = 0; v < 8; ++v)
                  corners[v] =
                    vertex(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
                mesh.cells.push_back(corners);

                const double z =
                  lower[2] + (k + 0.5) * (upper[2] - lower[2]) / n[2];
                for (const auto &[name, top] : list)
                  if (z < top)
                    {
                      mesh.cell_sets[name].push_back(cell);
                      break;
                    }
                if (i == 0)
                  side("left", cell, 0);
                if (i == n[0] - 1)
                  side("right", cell, 1);
                if (j == 0)
                  side("front", cell, 2);
                if (j == n[1] - 1)
                  side("back", cell, 3);
                if (k == 0)
                  side("bottom", cell, 4);
                if (k == n[2] - 1)
                  side("top", cell, 5);
              }
        return mesh;
      }

    private:
      /** Names and top elevations, from below. */
      std::vector<std::pair<std::string, double>>
      layers() const
      {
        std::vector<std::pair<std::string, double>> list;
        const auto items = split_list(layers_text, ';');
        for (unsigned int i = 0; i < items.size(); ++i)
          {
            const bool last  = i + 1 == items.size();
            const auto colon = items[i].find(':');
            const auto top   = parse_number(
              colon == std::string::npos ? "" : items[i].substr(colon + 1));
            if (!top && !(last && colon == std::string::npos))
              throw UserError("\"Layers\" in section \"Mesh/box\": \"" +
                              items[i] +
                              "\" has no top elevation; write \"name: "
                              "elevation\" [m].");
            if (!list.empty() && !last && *top <= list.back().second)
              throw UserError("\"Layers\" in section \"Mesh/box\": \"" +
                              items[i] +
                              "\" does not lie above the layer before it; list "
                              "the layers from below.");
            list.emplace_back(Utilities::trim(items[i].substr(0, colon)),
                              last ? 1e300 : *top);
          }
        return list;
      }

      Point<3>                  lower{0., 0., 0.}, upper{1., 1., 1.};
      std::vector<unsigned int> cells{4, 4, 4};
      std::string               layers_text = "box";
      double                    distortion  = 0.;
    };

    const Registry<MeshGenerator>::Add<Box>
      registered_box("box", "A box, or a column, optionally in layers.");
  } // namespace
} // namespace Voussoir
