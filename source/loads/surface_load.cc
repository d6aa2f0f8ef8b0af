#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/loads/face_forces.h>
#include <voussoir/loads/forces_over_time.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class SurfaceLoad : public ForcesOverTime
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets",
                          face_sets,
                          "Face sets on which the load acts.");
        prm.add_parameter("Traction",
                          traction,
                          "Force per area, x, y, z [Pa]." +
                            usually(Usual::pressure));
        prm.add_parameter("Pressure",
                          pressure,
                          "Pressure against the surface [Pa]." +
                            usually(Usual::pressure));
        factor.declare(prm, "Time function", "Factor on the load.");
      }

      void
      prepare(const Solid         &solid,
              const ParameterFile &file,
              const std::string   &place,
              Log &) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        if (file.given(place + "/Traction").empty() &&
            file.given(place + "/Pressure").empty())
          throw UserError("Section \"" + place +
                          "\" has neither a \"Traction\" nor a \"Pressure\"; "
                          "give one of them, or leave the load out.");
        for (const auto &[node, force] :
             face_forces(solid.discretization,
                         split_list(face_sets),
                         "\"Face sets\" in section \"" + place + "\"",
                         [&](const Point<3> &, const Tensor<1, 3> &normal) {
                           return traction - pressure * normal;
                         }))
          nodal_forces.emplace_back(node, force);
      }

    private:
      std::string  face_sets;
      Tensor<1, 3> traction;
      double       pressure = 0.;
    };

    const Registry<Load>::Add<SurfaceLoad>
      registered_surface_load("surface load",
                              "A traction or pressure on faces, over time.");
  } // namespace
} // namespace Voussoir
