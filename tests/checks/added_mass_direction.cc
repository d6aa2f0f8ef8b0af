#include <voussoir/mesh_sources/generator.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A wall that may be turned in plan and lean: its vertices lie at
     *   u t + (s z - d) m + z e_z
     * with the distance u along it, t = (cos b, sin b, 0), the height z, the
     * depth d behind its face and m = (-sin b, cos b, 0).
     */
    class TurnedWall : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length", length, "[m]");
        prm.add_parameter("Height", height, "[m]");
        prm.add_parameter("Thickness", thickness, "Across [m].");
        prm.add_parameter("Bearing", bearing, "b [degrees].");
        prm.add_parameter("Slope", slope, "s, run over rise.");
        prm.add_parameter("Cells", cells, "Along, through, upwards.");
      }

      void
      check() const override
      {}

      CoarseMesh
      generate() const override
      {
        const double c = std::cos(bearing * numbers::PI / 180.),
                     s = std::sin(bearing * numbers::PI / 180.);
        CoarseMesh mesh;
        const auto number =
          [&](unsigned int i, unsigned int j, unsigned int k) {
            return i + (cells[0] + 1) * (j + (cells[1] + 1) * k);
          };
        for (unsigned int k = 0; k <= cells[2]; ++k)
          for (unsigned int j = 0; j <= cells[1]; ++j)
            for (unsigned int i = 0; i <= cells[0]; ++i)
              {
                const double u = i * length / cells[0],
                             d = thickness - j * thickness / cells[1],
                             z = k * height / cells[2];
                mesh.vertices.emplace_back(u * c - (slope * z - d) * s,
                                           u * s + (slope * z - d) * c,
                                           z);
              }
        for (unsigned int k = 0; k < cells[2]; ++k)
          for (unsigned int j = 0; j < cells[1]; ++j)
            for (unsigned int i = 0; i < cells[0]; ++i)
              {
                const unsigned int          cell = mesh.cells.size();
                std::array<unsigned int, 8> corners;
                for (unsigned int v = 0; v < 8; ++v)
                  corners[v] =
                    number(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
                mesh.cells.push_back(corners);
                mesh.cell_sets["wall"].push_back(cell);
                if (i == 0)
                  mesh.face_sets["end"].push_back({cell, 0});
                if (j == cells[1] - 1)
                  mesh.face_sets["face"].push_back({cell, 3});
                if (k == 0)
                  mesh.face_sets["base"].push_back({cell, 4});
              }
        return mesh;
      }

    private:
      double length = 1., height = 1., thickness = 1., bearing = 0., slope = 0.;
      std::vector<unsigned int> cells{1, 1, 1};
    };

    const Registry<MeshGenerator>::Add<TurnedWall>
      registered_wall("turned wall", "For a test: a plane face of any normal.");


    /**
     * Westergaard's added mass of the nodes of a plane face: 7/8 rho sqrt(H h)
     * of the node's area times n n^T, or the part of it that an option keeps.
     */
    class AddedMassDirection : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const auto &[bearing, slope] : std::vector<std::array<double, 2>>{
               {{0., 0.}}, {{0., 0.4}}, {{25., 0.}}, {{25., -0.4}}})
          {
            std::ostringstream wall;
            wall << "bearing " << bearing << ", slope " << slope;
            const ParameterFile turned =
              file.with({"Mesh/turned wall/Bearing=" + std::to_string(bearing),
                         "Mesh/turned wall/Slope=" + std::to_string(slope)});
            for (const std::string option : {"normal", "uncoupled", "river"})
              compare(wall.str() + ", " + option,
                      turned.with({"Reservoir/added mass/Direction=" + option}),
                      normal_of(bearing, slope),
                      option,
                      communicator,
                      verdicts);
          }
        // a river along x
        for (const std::string option : {"normal", "river"})
          across(file.with({"Reservoir/added mass/Face sets=end",
                            "Reservoir/added mass/Direction=" + option}),
                 option,
                 communicator,
                 verdicts);
      }

    private:
      // the numbers of the cases, calculated by hand
      static constexpr double length = 12., height = 40., thickness = 5.,
                              density       = 1000.;
      static constexpr unsigned int n_along = 3, n_up = 16;


      /** Normal of the face times its area over length times height. */
      static Tensor<1, 3>
      normal_of(const double bearing, const double slope)
      {
        const double b = bearing * numbers::PI / 180.;
        return Tensor<1, 3>({-std::sin(b), std::cos(b), -slope});
      }


      /** Horizontal normal of the face: the direction of the water pressure. */
      static Tensor<1, 3>
      river_before(const Tensor<1, 3> &n)
      {
        const Tensor<1, 3> plan({n[0], n[1], 0.});
        return plan / plan.norm();
      }


      /** Part of a direction's cells that belong to the point at this place. */
      static double
      share(const double place, const unsigned int cells)
      {
        return (place < 1e-9 || place > 1. - 1e-9 ? 0.5 : 1.) / cells;
      }


      static SymmetricTensor<2, 3>
      left_by(const std::string &option, const Tensor<1, 3> &n)
      {
        const Tensor<1, 3>    river = river_before(n);
        SymmetricTensor<2, 3> result;
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int e = d; e < 3; ++e)
            result[d][e] = option == "normal" ?
                             n[d] * n[e] :
                             (n * river) * (n * river) * river[d] * river[e];
        if (option == "uncoupled")
          result[2][2] += n[2] * n[2];
        return result;
      }


      static SymmetricTensor<2, 3>
      added_at(const NodalTerms &terms, const unsigned int node)
      {
        const auto slot = terms.slot_at(node);
        return slot ? terms.added_mass[*slot] : SymmetricTensor<2, 3>();
      }


      static void
      compare(const std::string   &name,
              const ParameterFile &file,
              const Tensor<1, 3>  &direction,
              const std::string   &option,
              const MPI_Comm       communicator,
              Verdicts            &verdicts)
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double level      = parameters->reservoir.added_mass.level;
        const double area       = direction.norm() * length * height;
        const Tensor<1, 3> n    = direction / direction.norm();

        const Discretization &discretization =
          simulation->model.solid.discretization;
        double difference = 0., largest = 0., sum = 0.;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const Point<3> &x     = discretization.node_positions[node];
            const auto      added = added_at(simulation->model.terms, node);
            const double    along =
              (x[0] * direction[1] - x[1] * direction[0]) / length;
            // on the plane of the face, and below the level
            const bool   wet = std::abs(n * x) < 1e-9 && x[2] < level;
            const double mass =
              wet ?
                7. / 8. * density * std::sqrt(level * (level - x[2])) * area *
                  share(along, n_along) * share(x[2] / height, n_up) :
                0.;
            keep_largest(difference,
                         (added - mass * left_by(option, n)).norm());
            keep_largest(largest, mass);
            sum += trace(added);
          }
        verdicts.below(name + ": nodes against m n n^T",
                       difference / largest,
                       1e-12);
        // the sum over nodes does not resolve the root at the surface
        verdicts.near(name + ": trace over 7/12 rho H^2 b",
                      sum / (7. / 12. * density * level * level * length *
                             direction.norm()),
                      trace(left_by(option, n)),
                      0.01);
      }


      /** With an upright face that is normal to x the river is along x. */
      static void
      across(const ParameterFile &file,
             const std::string   &option,
             const MPI_Comm       communicator,
             Verdicts            &verdicts)
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double level      = parameters->reservoir.added_mass.level;
        SymmetricTensor<2, 3> sum;
        for (const auto &added : simulation->model.terms.added_mass)
          sum += added;
        const double reference = 7. / 12. * density * level * level * thickness;
        verdicts.near("end of the wall, " + option + ": x over 7/12 rho H^2 b",
                      sum[0][0] / reference,
                      1.,
                      0.01);
        sum[0][0] = 0.;
        verdicts.below("all other entries", sum.norm() / reference, 1e-12);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<AddedMassDirection>
      registered("added mass direction", "Of plane faces of any normal.");
  } // namespace
} // namespace Voussoir
