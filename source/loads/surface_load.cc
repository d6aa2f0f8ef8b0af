#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/loads/face_forces.h>
#include <voussoir/loads/load.h>
#include <voussoir/loads/time_factor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class SurfaceLoad : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets", face_sets, "Face sets it acts on.");
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
      prepare(const LoadedModel &model,
              NodalTerms        &terms,
              const std::string &place) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        if (model.file.given(place + "/Traction").empty() &&
            model.file.given(place + "/Pressure").empty())
          throw UserError("Section \"" + place +
                          "\" has neither a \"Traction\" nor a \"Pressure\"; "
                          "give one of them, or leave the load out.");
        for (const auto &[node, force] :
             face_forces(model.discretization,
                         split_list(face_sets),
                         "\"Face sets\" in section \"" + place + "\"",
                         [&](const Point<3> &, const Tensor<1, 3> &normal) {
                           return traction - pressure * normal;
                         }))
          shares.emplace_back(terms.add_node(node), force);
      }

      void
      add_forces(const double time, NodalForces &forces) override
      {
        const double now = factor(time);
        for (const auto &[slot, force] : shares)
          forces[slot] += now * force;
      }

    private:
      std::string  face_sets;
      Tensor<1, 3> traction;
      double       pressure = 0.;
      TimeFactor   factor;

      std::vector<std::pair<unsigned int, Tensor<1, 3>>> shares;
    };

    const Registry<Load>::Add<SurfaceLoad>
      registered("surface load", "A traction or pressure on faces, over time.");
  } // namespace
} // namespace Voussoir
