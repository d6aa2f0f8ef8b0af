#include <voussoir/base/error.h>
#include <voussoir/loads/face_forces.h>
#include <voussoir/loads/load.h>

#include <deal.II/base/numbers.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Rankine's active pressure of a soil without cohesion,
     *  p = gamma' h tan^2(45 deg - phi/2). */
    class Silt : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets",
                          face_sets,
                          "Face sets it presses on, at right angles to them.");
        prm.add_parameter("Level",
                          level,
                          "Elevation of the top of the silt [m]; must be "
                          "given.");
        prm.add_parameter(
          "Buoyant unit weight",
          unit_weight,
          "Weight of the silt under water less its buoyancy [N/m3]; 8e3 to "
          "11e3. The water in it belongs to the load of the water.",
          Patterns::Double(0.));
        prm.add_parameter("Friction angle",
                          friction_angle,
                          "Of the silt [degrees]; 10 to 20, 0 for a liquid.",
                          Patterns::Double(0., 60.));
      }

      bool
      steady() const override
      {
        return true;
      }

      void
      prepare(const LoadedModel &model,
              NodalTerms &,
              const std::string &place) override
      {
        if (model.file.given(place + "/Level").empty())
          throw UserError("Section \"" + place +
                          "\" has no \"Level\"; give the elevation of the top "
                          "of the silt [m].");
        const double root =
          std::tan((45. - 0.5 * friction_angle) * numbers::PI / 180.);
        forces =
          depth_pressure_forces(model.discretization,
                                split_list(face_sets),
                                "\"Face sets\" in section \"" + place + "\"",
                                level,
                                unit_weight * root * root);
      }

      void
      add_steady_force(Vector &force) const override
      {
        add_to(force, forces);
      }

    private:
      std::string             face_sets      = "upstream face";
      double                  level          = 0.;
      double                  unit_weight    = 9e3;
      double                  friction_angle = 15.;
      std::vector<NodalForce> forces;
    };

    const Registry<Load>::Add<Silt>
      registered("silt", "Active pressure of the sediment before the dam.");
  } // namespace
} // namespace Voussoir
