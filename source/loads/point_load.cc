#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/loads/forces_over_time.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class PointLoad : public ForcesOverTime
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Point",
                          point,
                          "Point at which the force acts, x, y, z [m].");
        prm.add_parameter("Force",
                          force,
                          "Components x, y, z of the force [N]." +
                            usually(Usual::force));
        factor.declare(prm, "Time function", "Factor on the force.");
      }

      void
      prepare(const Solid         &solid,
              const ParameterFile &file,
              const std::string   &place,
              Log &) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        if (file.given(place + "/Force").empty())
          throw UserError("Section \"" + place +
                          "\" has no \"Force\"; give its components, or leave "
                          "the load out.");
        const PointWeights weights(solid.discretization,
                                   {{"load", point}},
                                   "\"Point\" in section \"" + place + "\"");
        for (const auto &item : weights.items)
          nodal_forces.emplace_back(item.node, item.weight * force);
      }

    private:
      Point<3>     point;
      Tensor<1, 3> force;
    };

    const Registry<Load>::Add<PointLoad>
      registered_point_load("point load", "A force at a point, over time.");
  } // namespace
} // namespace Voussoir
