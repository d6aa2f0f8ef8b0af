#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_quality.h>

#include <deal.II/base/numbers.h>
#include <deal.II/grid/reference_cell.h>

#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The wedges of rock in the banks of an arch dam: the mesh does not tangle,
     * each wedge is a body of its own once the dam is cut off its rock, and the
     * base plane has the dip and the direction given, and meets the edge of dam
     * and rock at the given elevation in the dam's middle. The dam's joints
     * stay upright planes.
     */
    class AbutmentWedgeCheck : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Elevations", elevations, "[m]");
        prm.add_parameter("Dips", dips, "[degrees]");
        prm.add_parameter("Dip directions", directions, "[degrees]");
        prm.add_parameter("Cell sizes", cell_sizes, "[m]");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        for (const std::string &size : cell_sizes)
          for (const std::string &elevation : elevations)
            for (const std::string &dip : dips)
              for (const std::string &direction : directions)
                {
                  std::vector<std::string> changes = {
                    "Mesh/arch dam/Cell size=" + size};
                  for (const char *bank : {"Left", "Right"})
                    {
                      const std::string place =
                        std::string("Mesh/arch dam/") + bank + " wedge/";
                      changes.push_back(place + "Elevation=" + elevation);
                      changes.push_back(place + "Dip=" + dip);
                      changes.push_back(place + "Dip direction=" + direction);
                    }
                  evaluate(file.with(changes),
                           "cells of " + size + " m, " + elevation +
                             " m, dip " + dip + ", direction " + direction +
                             ": ",
                           {std::stod(elevation),
                            std::stod(dip),
                            std::stod(direction)},
                           verdicts);
                }
      }

    private:
      struct Wanted
      {
        double elevation, dip, direction;
      };

      static void
      evaluate(const ParameterFile &file,
               const std::string   &at,
               const Wanted        &wanted,
               Verdicts            &verdicts)
      {
        const auto         parameters = make_case(file);
        std::ostringstream report;
        CoarseMesh         mesh = parameters->make_mesh(report);
        check_mesh(mesh, "Test");

        MeshQuality quality;
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          {
            std::array<Point<3>, 8> vertices;
            for (unsigned int v = 0; v < 8; ++v)
              vertices[v] = mesh.vertices[mesh.cells[cell][v]];
            quality.take(vertices);
          }
        verdicts.is_true(at + "all scaled Jacobians above 0.15",
                         quality.scaled_jacobian > 0.15);

        double tilt = 0., off_foot = 0.;
        for (const unsigned int bank : {0, 1})
          {
            const std::string  name = bank == 0 ? "right wedge" : "left wedge";
            const double       side = bank == 0 ? -1. : 1.;
            const double       radians = numbers::PI / 180.;
            const Tensor<1, 3> normal({-side * std::sin(wanted.dip * radians) *
                                         std::cos(wanted.direction * radians),
                                       -std::sin(wanted.dip * radians) *
                                         std::sin(wanted.direction * radians),
                                       std::cos(wanted.dip * radians)});
            for (const CoarseMesh::Face &face :
                 mesh.face_sets.at(name + " base"))
              for (unsigned int v = 0; v < 4; ++v)
                {
                  // at each corner, so that the face is not twisted
                  const auto         x = corners(mesh, face);
                  const unsigned int a = v ^ 1U, b = v ^ 2U;
                  Tensor<1, 3> n = cross_product_3d(x[a] - x[v], x[b] - x[v]);
                  n *= (n[2] < 0. ? -1. : 1.) / n.norm();
                  keep_largest(tilt,
                               2. * std::asin(0.5 * (n - normal).norm()) /
                                 radians);
                }
            keep_largest(off_foot,
                         std::abs(foot(mesh, name) - wanted.elevation));
          }
        verdicts.below(at + "normals off the plane [degrees]", tilt, 1e-4);
        verdicts.below(at + "foot away from there [m]", off_foot, 1e-6);
        verdicts.below(at + "joints off their planes [m]",
                       largest_bend(mesh),
                       1e-6);

        split_interfaces(mesh,
                         {"left wedge base",
                          "left wedge lateral plane",
                          "left wedge rear plane",
                          "right wedge base",
                          "right wedge lateral plane",
                          "right wedge rear plane",
                          "dam-rock interface"},
                         "Test");
        check_mesh(mesh, "Test");
        verdicts.near(at + "dam, rock and wedges", n_bodies(mesh), 4., 0.);
      }

      static std::array<Point<3>, 4>
      corners(const CoarseMesh &mesh, const CoarseMesh::Face &face)
      {
        std::array<Point<3>, 4> x;
        for (unsigned int v = 0; v < 4; ++v)
          x[v] = mesh.vertices[mesh.cells[face.cell][ReferenceCells::Hexahedron
                                                       .face_to_cell_vertices(
                                                         face.face, v, 1)]];
        return x;
      }

      static std::vector<Point<3>>
      vertices(const CoarseMesh &mesh, const std::string &set)
      {
        std::vector<Point<3>> result;
        for (const CoarseMesh::Face &face : mesh.face_sets.at(set))
          for (const Point<3> &x : corners(mesh, face))
            result.push_back(x);
        return result;
      }

      /** Joints in plan. */
      static double
      largest_bend(const CoarseMesh &mesh)
      {
        double bend = 0.;
        for (const auto &[name, faces] : mesh.face_sets)
          if (name.rfind("joint ", 0) == 0)
            {
              const auto x = vertices(mesh, name);
              const auto downstream =
                std::min_element(x.begin(),
                                 x.end(),
                                 [](const auto &a, const auto &b) {
                                   return a[1] < b[1];
                                 });
              const auto upstream =
                std::max_element(x.begin(),
                                 x.end(),
                                 [](const auto &a, const auto &b) {
                                   return a[1] < b[1];
                                 });
              Tensor<1, 3> along = *upstream - *downstream;
              along[2]           = 0.;
              along /= along.norm();
              for (const Point<3> &y : x)
                keep_largest(
                  bend, std::abs(cross_product_3d(along, y - *downstream)[2]));
            }
        return bend;
      }

      /** Elevation of the base plane where it meets the dam's middle surface:
       *  the middle vertex of those on the edge of dam and rock. */
      static double
      foot(const CoarseMesh &mesh, const std::string &name)
      {
        const auto bottom    = vertices(mesh, name + " base"),
                   interface = vertices(mesh, "dam-rock interface");
        std::map<double, double> elevation; // by y
        for (const Point<3> &x : bottom)
          for (const Point<3> &y : interface)
            if (x.distance(y) < 1e-9)
              elevation[x[1]] = x[2];
        return std::next(elevation.begin(), elevation.size() / 2)->second;
      }

      std::vector<std::string> elevations{"100"}, dips{"0"}, directions{"0"},
        cell_sizes{"22"};
    };

    // Reference: closed form
    const Registry<Check>::Add<AbutmentWedgeCheck>
      registered("abutment wedge", "Wedges of rock in the banks.");
  } // namespace
} // namespace Voussoir
