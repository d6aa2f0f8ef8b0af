#include <voussoir/mesh_sources/generator.h>

#include <deal.II/numerics/rtree.h>
#include <deal.II/physics/transformations.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Tensor<2, 3>
    turned_by(const double degrees)
    {
      return Physics::Transformations::Rotations::rotation_matrix_3d(
        Point<3>(0., 0., 1.), degrees * numbers::PI / 180.);
    }


    /** An arch dam, turned in plan. */
    class TurnedDam : public MeshGenerator
    {
    public:
      TurnedDam()
        : dam(Registry<MeshGenerator>::create("arch dam", "A check"))
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        dam->declare_parameters(prm);
        prm.add_parameter("Angle", angle, "[degrees]");
      }

      void
      check() const override
      {
        dam->check();
      }

      CoarseMesh
      generate() const override
      {
        CoarseMesh         mesh     = dam->generate();
        const Tensor<2, 3> rotation = turned_by(angle);
        mesh.chart                  = {};
        for (Point<3> &vertex : mesh.vertices)
          vertex = Point<3>(rotation * vertex);
        return mesh;
      }

    private:
      const std::unique_ptr<MeshGenerator> dam;
      double                               angle = 0.;
    };

    const Registry<MeshGenerator>::Add<TurnedDam>
      registered_dam("turned dam", "For a test: an arch dam, turned in plan.");


    /** Water on a dam that is turned in plan turns with it: its pressure, its
     *  weight, and its added mass. */
    class WaterOnTurnedDam : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const std::string option : {"normal", "uncoupled", "river"})
          {
            const ParameterFile given =
              file.with({"Reservoir/added mass/Direction=" + option});
            const Water along_y = water_on(given, communicator);
            for (const double angle : {30., 90., 250.})
              {
                std::ostringstream name;
                name << option << ", turned by " << angle << " degrees: ";
                compare(name.str(),
                        along_y,
                        water_on(given.with({"Mesh/turned dam/Angle=" +
                                             std::to_string(angle)}),
                                 communicator),
                        turned_by(angle),
                        verdicts);
              }
          }
      }

    private:
      struct Water
      {
        Vector                             pressure; // [N]
        std::vector<SymmetricTensor<2, 3>> masses;   // of each node
        std::vector<Point<3>>              places;   // of each node
        double                             mass;     // along the river
        Tensor<1, 3>                       river;
      };


      static Water
      water_on(const ParameterFile &file, const MPI_Comm communicator)
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Model &model      = simulation->model;
        Water        water{model.solid.discretization.create_vector(),
                    std::vector<SymmetricTensor<2, 3>>(
                      model.solid.discretization.n_owned_nodes()),
                    model.solid.discretization.node_positions,
                    model.added_mass.mass,
                    model.added_mass.river};
        for (const auto &load : model.loads)
          load.second->add_steady_force(water.pressure);
        for (unsigned int slot = 0; slot < model.terms.nodes.size(); ++slot)
          water.masses[model.terms.nodes[slot]] = model.terms.added_mass[slot];
        return water;
      }


      static void
      compare(const std::string  &name,
              const Water        &along_y,
              const Water        &turned,
              const Tensor<2, 3> &rotation,
              Verdicts           &verdicts)
      {
        // the order of the nodes depends on their places
        const auto tree        = pack_rtree_of_indices(turned.places);
        double     of_pressure = 0., pressure = 0., of_mass = 0., mass = 0.,
               of_place = 0.;
        for (unsigned int node = 0; node < along_y.masses.size(); ++node)
          {
            const Point<3>     place(rotation * along_y.places[node]);
            const unsigned int other =
              *tree.qbegin(boost::geometry::index::nearest(place, 1));
            keep_largest(of_place, place.distance(turned.places[other]));
            Tensor<1, 3> force, force_there;
            for (unsigned int d = 0; d < 3; ++d)
              {
                force[d]       = along_y.pressure.local_element(3 * node + d);
                force_there[d] = turned.pressure.local_element(3 * other + d);
              }
            keep_largest(of_pressure, (rotation * force - force_there).norm());
            keep_largest(pressure, force.norm());
            const Tensor<2, 3> there(turned.masses[other]);
            keep_largest(of_mass,
                         (rotation * Tensor<2, 3>(along_y.masses[node]) *
                            transpose(rotation) -
                          there)
                           .norm());
            keep_largest(mass, along_y.masses[node].norm());
          }
        verdicts.is_true(name + "there is water", pressure > 0. && mass > 0.);
        verdicts.below(name + "places of the nodes [m]", of_place, 1e-9);
        verdicts.below(name + "forces of the pressure",
                       of_pressure / pressure,
                       1e-9);
        verdicts.below(name + "added masses", of_mass / mass, 1e-9);
        verdicts.below(name + "mass along the river",
                       turned.mass / along_y.mass - 1.,
                       1e-9);
        verdicts.below(name + "direction of the river",
                       (rotation * along_y.river - turned.river).norm(),
                       1e-9);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<WaterOnTurnedDam>
      registered("water on turned dam", "A river of any direction.");
  } // namespace
} // namespace Voussoir
