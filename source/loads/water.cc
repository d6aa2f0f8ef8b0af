#include <voussoir/base/error.h>
#include <voussoir/loads/face_forces.h>
#include <voussoir/loads/load.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** p = rho g h. */
    class Water : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets",
                          face_sets,
                          "Face sets it presses on; one load for each side of "
                          "the dam, and the canyon by choice.");
        prm.add_parameter("Level",
                          level,
                          "Elevation of the water surface [m]; must be given.");
        prm.add_parameter("Density",
                          density,
                          "Of the water [kg/m3].",
                          Patterns::Double(0.));
        prm.add_parameter("Gravity",
                          gravity,
                          "Acceleration of gravity [m/s2].",
                          Patterns::Double(0.));
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
                          "\" has no \"Level\"; give the elevation of the "
                          "water surface [m].");
        forces =
          depth_pressure_forces(model.discretization,
                                split_list(face_sets),
                                "\"Face sets\" in section \"" + place + "\"",
                                level,
                                density * gravity);
      }

      void
      add_steady_force(Vector &force) const override
      {
        add_to(force, forces);
      }

    private:
      std::string             face_sets = "upstream face";
      double                  level     = 0.;
      double                  density   = 1000.;
      double                  gravity   = 9.81;
      std::vector<NodalForce> forces;
    };

    const Registry<Load>::Add<Water>
      registered("water",
                 "Hydrostatic pressure of the reservoir or tailwater.");
  } // namespace
} // namespace Voussoir
