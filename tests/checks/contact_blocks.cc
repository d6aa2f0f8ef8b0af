// A mesh of blocks for the tests of contact.

#include <voussoir/mesh_sources/generator.h>

#include <cmath>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A base of one layer of cells with four blocks on it, "north west" and so
     * on, each a cube of cells; x points east, y north.
     */
    class Blocks : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cells", n, "Along the edge of a block.");
        prm.add_parameter("Cell size", h, "[m].");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        CoarseMesh mesh;
        const auto vertex =
          [&](unsigned int i, unsigned int j, unsigned int k) {
            return i + (2 * n + 1) * (j + (2 * n + 1) * k);
          };
        for (unsigned int k = 0; k <= n + 1; ++k)
          for (unsigned int j = 0; j <= 2 * n; ++j)
            for (unsigned int i = 0; i <= 2 * n; ++i)
              mesh.vertices.emplace_back(h * i, h * j, h * k);
        for (unsigned int k = 0; k <= n; ++k)
          for (unsigned int j = 0; j < 2 * n; ++j)
            for (unsigned int i = 0; i < 2 * n; ++i)
              {
                const unsigned int          cell = mesh.cells.size();
                std::array<unsigned int, 8> corners;
                for (unsigned int v = 0; v < 8; ++v)
                  corners[v] =
                    vertex(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
                mesh.cells.push_back(corners);
                mesh.cell_sets["all"].push_back(cell);
                mesh
                  .cell_sets[k == 0 ? "base" :
                                      std::string(j < n ? "south " : "north ") +
                                        (i < n ? "west" : "east")]
                  .push_back(cell);
                if (k == 0)
                  mesh.face_sets["bottom"].push_back({cell, 4});
                if (k == n)
                  mesh.face_sets["top"].push_back({cell, 5});
              }
        return mesh;
      }

    private:
      unsigned int n = 2;
      double       h = 1.;
    };

    const Registry<MeshGenerator>::Add<Blocks>
      registered("blocks", "A base and four blocks on it, for tests.");
  } // namespace
} // namespace Voussoir
