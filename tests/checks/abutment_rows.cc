#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/grid/reference_cell.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The cells beside the line where an arch dam meets its rock, for several
     * dams and cell sizes: they form a layer on either side, so that as many
     * cells meet at each of its points as in a regular mesh, and they are well
     * shaped and not small. Without such layers up to six cells met at a point,
     * with local peaks of stress.
     */
    class AbutmentRows : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cells over the height",
                          numbers,
                          "That would fit into it at the crest's cell size.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        measure_known_cells(verdicts);
        const std::vector<std::pair<std::string, double>> dams = {
          {"Baihetan-like", 289.}, {"Shapai-like", 132.}, {"custom", 100.}};
        for (const auto &[shape, height] : dams)
          for (const double number : numbers)
            if (number <= 40. || shape == "custom")
              evaluate(file, shape, height / number, verdicts);
      }

    private:
      /** A box of 1 x 2 x 4 whose third direction is inclined by 45 degrees. */
      static void
      measure_known_cells(Verdicts &verdicts)
      {
        std::array<Point<3>, 8> vertices;
        for (unsigned int v = 0; v < 8; ++v)
          vertices[v] = Point<3>(v & 1U, 2 * (v >> 1 & 1U), 4 * (v >> 2));
        MeshQuality box, sheared;
        box.take(vertices);
        verdicts.near("box: scaled Jacobian", box.scaled_jacobian, 1., 1e-12);
        verdicts.near("box: aspect ratio", box.aspect_ratio, 4., 1e-12);
        verdicts.near("box: smallest angle", box.smallest_angle, 90., 1e-12);
        for (Point<3> &x : vertices)
          x[0] += x[2];
        sheared.take(vertices);
        verdicts.near("leaning box: scaled Jacobian",
                      sheared.scaled_jacobian,
                      std::sqrt(0.5),
                      1e-12);
        verdicts.near("leaning box: aspect ratio",
                      sheared.aspect_ratio,
                      4. * std::sqrt(2.),
                      1e-12);
        verdicts.near("leaning box: smallest angle",
                      sheared.smallest_angle,
                      45.,
                      1e-12);
        for (Point<3> &x : vertices)
          x[1] = -x[1];
        sheared.take(vertices);
        verdicts.near("inside out: scaled Jacobian",
                      sheared.scaled_jacobian,
                      -std::sqrt(0.5),
                      1e-12);
      }


      static void
      evaluate(const ParameterFile &file,
               const std::string   &shape,
               const double         cell_size,
               Verdicts            &verdicts)
      {
        std::ostringstream size, log;
        size << cell_size;
        const std::string name = shape + ", " + size.str() + " m: ";
        const auto        parameters =
          make_case(file.with({"Mesh/arch dam/Cell size=" + size.str(),
                               "Mesh/arch dam/Shape=" + shape}));
        const CoarseMesh mesh = parameters->make_mesh(log);
        check_mesh(mesh, "Test");
        std::vector<unsigned int> n_dam(mesh.vertices.size()),
          n_rock(mesh.vertices.size()), n_faces(mesh.vertices.size());
        for (const unsigned int cell : mesh.cell_sets.at("dam"))
          for (const unsigned int v : mesh.cells[cell])
            ++n_dam[v];
        for (const unsigned int cell : mesh.cell_sets.at("rock"))
          for (const unsigned int v : mesh.cells[cell])
            ++n_rock[v];
        double highest = 0.;
        for (const auto &[cell, face] : mesh.face_sets.at("dam-rock interface"))
          for (unsigned int i = 0; i < 4; ++i)
            {
              const unsigned int v =
                mesh.cells[cell][ReferenceCells::Hexahedron
                                   .face_to_cell_vertices(face, i, 1)];
              ++n_faces[v];
              keep_largest(highest, mesh.vertices[v][2]);
            }
        unsigned int n = 0, n_irregular = 0;
        for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
          if (n_faces[v] > 0)
            {
              ++n;
              const bool at_crest = mesh.vertices[v][2] >= highest;
              if (n_dam[v] != n_faces[v] || n_rock[v] != (at_crest ? 2 : 4))
                ++n_irregular;
            }
        verdicts.above(name + "points where dam and rock meet", n, 30.);
        verdicts.below(name + "irregular ones", n_irregular, 0.);

        MeshQuality dam;
        double      shortest = std::numeric_limits<double>::max();
        for (const unsigned int cell : mesh.cell_sets.at("dam"))
          {
            std::array<Point<3>, 8> vertices;
            for (unsigned int v = 0; v < 8; ++v)
              vertices[v] = mesh.vertices[mesh.cells[cell][v]];
            dam.take(vertices);
            for (unsigned int v = 0; v < 8; ++v)
              // not through the thickness, along the second direction
              for (const unsigned int other : {v ^ 1U, v ^ 4U})
                keep_smallest(shortest, vertices[v].distance(vertices[other]));
          }
        verdicts.above(name + "scaled Jacobian of the dam",
                       dam.scaled_jacobian,
                       0.3);
        verdicts.above(name + "smallest angle [degrees]",
                       dam.smallest_angle,
                       25.);
        verdicts.above(name + "shortest edge over the cell size",
                       shortest / cell_size,
                       0.35);
      }

      std::vector<double> numbers;
    };

    // Reference: closed form
    const Registry<Check>::Add<AbutmentRows>
      registered("abutment rows", "Cells beside the rock.");
  } // namespace
} // namespace Voussoir
