#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/grid/reference_cell.h>

#include "check.h"
#include "cylinder_dam.h"
#include "falling_errors.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Quadrature of order 2n over an interval. */
    double
    integral(const std::function<double(double)> &f,
             const double                         begin,
             const double                         end)
    {
      const QGauss<1> gauss(40);
      double          sum = 0.;
      for (unsigned int q = 0; q < gauss.size(); ++q)
        sum += (end - begin) * gauss.weight(q) *
               f(begin + (end - begin) * gauss.point(q)[0]);
      return sum;
    }


    /**
     * Volume and length of a mesh of an arch dam. Faces of the mesh are flat
     * between the vertices, which lie on the dam's faces, so that its error is
     * proportional to the square of the cell size.
     */
    class MeasuredDam
    {
    public:
      explicit MeasuredDam(const CoarseMesh &mesh)
        : mesh(mesh)
      {}

      /** Volume by 2 x 2 x 2 points, exact for the trilinear map. */
      double
      volume() const
      {
        double sum = 0.;
        for (const unsigned int cell : mesh.cell_sets.at("dam"))
          for (unsigned int q = 0; q < gauss.size(); ++q)
            {
              Tensor<2, 3> jacobian;
              for (unsigned int v = 0; v < 8; ++v)
                jacobian +=
                  outer_product(vertex(cell, v),
                                hexahedron.d_linear_shape_function_gradient(
                                  gauss.point(q), v));
              sum += gauss.weight(q) * determinant(jacobian);
            }
        return sum;
      }

      /** Length of the crest's middle line, if one cell fills the thickness:
       *  between the points half-way from downstream to upstream. */
      double
      crest_length() const
      {
        double sum = 0.;
        for (const auto &[cell, face] : mesh.face_sets.at("crest"))
          {
            // the vertex number has a bit for each of the cell's directions, of
            // which the second leads upstream
            const unsigned int here  = face % 2 << face / 2,
                               along = 1 << (2 - face / 2);
            const Tensor<1, 3> edge =
              vertex(cell, here + along) + vertex(cell, here + along + 2) -
              vertex(cell, here) - vertex(cell, here + 2);
            sum += 0.5 * edge.norm();
          }
        return sum;
      }

      /** Extent in y of the vertices on the crown at a height [m]. */
      double
      crown_thickness(const double z) const
      {
        double lowest = 1e300, highest = -1e300;
        for_each_vertex([&](const Tensor<1, 3> &x) {
          if (std::abs(x[0]) > 1e-8 || std::abs(x[2] - z) > 1e-8)
            return;
          keep_smallest(lowest, x[1]);
          keep_largest(highest, x[1]);
        });
        return highest - lowest;
      }

      double
      height() const
      {
        double lowest = 1e300, highest = -1e300;
        for_each_vertex([&](const Tensor<1, 3> &x) {
          keep_smallest(lowest, x[2]);
          keep_largest(highest, x[2]);
        });
        return highest - lowest;
      }

      /** Smallest and largest distance of the dam's vertices from an upright
       *  axis in the plane x = 0 [m]. */
      std::array<double, 2>
      radii(const double y) const
      {
        std::array<double, 2> result{{1e300, 0.}};
        for_each_vertex([&](const Tensor<1, 3> &x) {
          const double r = std::hypot(x[0], x[1] - y);
          keep_smallest(result[0], r);
          keep_largest(result[1], r);
        });
        return result;
      }

    private:
      void
      for_each_vertex(
        const std::function<void(const Tensor<1, 3> &)> &visit) const
      {
        for (const unsigned int cell : mesh.cell_sets.at("dam"))
          for (unsigned int v = 0; v < 8; ++v)
            visit(vertex(cell, v));
      }


      Tensor<1, 3>
      vertex(const unsigned int cell, const unsigned int v) const
      {
        return mesh.vertices[mesh.cells[cell][v]];
      }

      const CoarseMesh   &mesh;
      const QGauss<3>     gauss{2};
      const ReferenceCell hexahedron = ReferenceCells::Hexahedron;
    };


    /**
     * Two dams of a custom shape, by their entries: a cylinder of constant
     * thickness between straight banks, in closed form, and parabolas with an
     * upright middle surface, by quadrature. In both all arches are normal to
     * the same upright sections.
     */
    class CustomArchDam : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cell sizes", sizes, "From coarse to fine [m].");
        prm.add_parameter("Tolerance",
                          tolerance,
                          "Tolerance of the finest mesh.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        run_cylinder(file.with(CylinderDam::entries()), verdicts);
        run_parabola(file.with(parabola), verdicts);
        run_table(file, verdicts);
      }

    private:
      struct Expected
      {
        double volume, crest_length; // [m3], [m]
      };


      void
      run_cylinder(const ParameterFile &file, Verdicts &verdicts) const
      {
        Expected expected{CylinderDam::volume(), 0.};
        for (const double w : CylinderDam::crest_half_width)
          expected.crest_length +=
            CylinderDam::radius * std::asin(w / CylinderDam::radius);
        const CoarseMesh  mesh = compare("cylinder", file, expected, verdicts);
        const MeasuredDam dam(mesh);
        const auto        radii = dam.radii(CylinderDam::centre);
        verdicts.near("cylinder: radius downstream", radii[0], 115., 1e-9, "m");
        verdicts.near("cylinder: radius upstream", radii[1], 125., 1e-9, "m");
      }


      /** R = 150, t = 8 + 20 e + 6 e^2, 1.3 times that at the banks, H = 100;
       *  half widths 20 + 130 (z/H)^0.8. */
      void
      run_parabola(const ParameterFile &file, Verdicts &verdicts) const
      {
        const auto arc = [](const double x) {
          const double t = x / 150.;
          return 75. * (t * std::sqrt(1. + t * t) + std::asinh(t));
        };
        const auto thickness = [](const double e) {
          return 8. + 20. * e + 6. * e * e;
        };
        // z/H = s^5 makes it smooth; 1 + 0.3 (s/s_a)^2 has the mean 1.1
        const double volume = integral(
          [&](const double s) {
            return 100. * 5. * std::pow(s, 4) * thickness(1. - std::pow(s, 5)) *
                   1.1 * 2. * arc(20. + 130. * std::pow(s, 4));
          },
          0.,
          1.);
        const CoarseMesh mesh =
          compare("parabola", file, {volume, 2. * arc(150.)}, verdicts);
        const MeasuredDam dam(mesh);
        for (const double z : {0., 100.})
          verdicts.near("parabola: thickness of the crown at z = " +
                          std::to_string(int(z)),
                        dam.crown_thickness(z),
                        thickness(1. - z / 100.),
                        1e-9,
                        "m");
      }


      /** Quadratic functions of the elevation, given by their coefficients and
       *  by four arches. */
      void
      run_table(const ParameterFile &file, Verdicts &verdicts) const
      {
        std::ostringstream table;
        table.precision(17);
        for (const double z : {0., 30., 60., 100.})
          {
            const double e = 1. - z / 100., t = 8. + 20. * e + 6. * e * e;
            table << (z > 0. ? "; " : "") << z << ' ' << 10. * e + 3. * e * e
                  << ' ' << t << ' ' << 1.3 * t << ' ' << 1.3 * t << ' '
                  << 150. - 40. * e << ' ' << 150. - 40. * e << ' '
                  << 120. - 90. * e << ' ' << 150. - 130. * e;
          }
        std::vector<std::string> numbers = parabola;
        for (const char *entry : {"Base radius=110",
                                  "Radius exponent=1",
                                  "Crest half width=120, 150",
                                  "Base half width=30, 20",
                                  "Canyon exponent=1"})
          numbers.push_back(place + entry);
        std::vector<CoarseMesh> meshes;
        for (const std::vector<std::string> &changes :
             {numbers,
              {place + "Arch=parabola", place + "Arches=" + table.str()}})
          {
            const auto parameters =
              make_case(file.with(changes).with({"Mesh/arch dam/Cell size=8"}));
            std::ostringstream log;
            meshes.push_back(parameters->make_mesh(log));
          }
        verdicts.is_true("table: as many vertices as by numbers",
                         meshes[0].vertices.size() ==
                           meshes[1].vertices.size());
        double distance = 0.;
        for (unsigned int v = 0; v < meshes[0].vertices.size(); ++v)
          keep_largest(distance,
                       meshes[0].vertices[v].distance(meshes[1].vertices[v]));
        verdicts.below("table: vertices from those by numbers [m]",
                       distance,
                       1e-6);
      }


      /** @return the finest mesh */
      CoarseMesh
      compare(const std::string   &name,
              const ParameterFile &file,
              const Expected      &expected,
              Verdicts            &verdicts) const
      {
        std::vector<double> of_volume, of_length;
        CoarseMesh          mesh;
        for (const double size : sizes)
          {
            const auto parameters = make_case(
              file.with({"Mesh/arch dam/Cell size=" + std::to_string(size)}));
            std::ostringstream log;
            mesh = parameters->make_mesh(log);
            const MeasuredDam dam(mesh);
            of_volume.push_back(dam.volume() / expected.volume - 1.);
            of_length.push_back(dam.crest_length() / expected.crest_length -
                                1.);
          }
        verdicts.near(name + ": volume",
                      (1. + of_volume.back()) * expected.volume,
                      expected.volume,
                      tolerance,
                      "m3");
        verdicts.near(name + ": crest length",
                      (1. + of_length.back()) * expected.crest_length,
                      expected.crest_length,
                      tolerance,
                      "m");
        verdicts.near(
          name + ": height", MeasuredDam(mesh).height(), 100., 1e-12, "m");
        verdicts.is_true(name + ": missing volume falls below 0.4 of it "
                                "with half the cell size",
                         fall(of_volume));
        verdicts.is_true(name + ": so does the missing crest length",
                         fall(of_length));
        return mesh;
      }


      const std::string              place = "Mesh/arch dam/Custom shape/";
      const std::vector<std::string> parabola{
        place + "Arch=parabola",
        place + "Crest radius=150",
        place + "Base radius=150",
        place + "Crest half width=150, 150",
        place + "Base half width=20, 20",
        place + "Canyon exponent=0.8",
        // half the thickness: the middle surface is upright
        place + "Crown face=10, 3, 0",
        place + "Crown thickness=8, 20, 6, 0",
        place + "Abutment thickness=1.3"};
      std::vector<double> sizes;
      double              tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<CustomArchDam>
      registered("custom arch dam", "Measures of a custom shape.");
  } // namespace
} // namespace Voussoir
