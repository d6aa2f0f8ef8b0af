#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/loads/load.h>
#include <voussoir/loads/time_factor.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class PointLoad : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Point", point, "Where it acts, x, y, z [m].");
        prm.add_parameter("Force",
                          force,
                          "Its components x, y, z [N]." +
                            usually(Usual::force));
        factor.declare(prm, "Time function", "Factor on the force.");
      }

      void
      prepare(const LoadedModel &model,
              NodalTerms        &terms,
              const std::string &place) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        if (model.file.given(place + "/Force").empty())
          throw UserError("Section \"" + place +
                          "\" has no \"Force\"; give its components, or leave "
                          "the load out.");
        const PointWeights weights(model.discretization,
                                   {{"load", point}},
                                   "\"Point\" in section \"" + place + "\"");
        for (const auto &item : weights.items)
          shares.emplace_back(terms.add_node(item.node), item.weight);
      }

      void
      add_forces(const double time, NodalForces &forces) override
      {
        const double now = factor(time);
        for (const auto &[slot, weight] : shares)
          forces[slot] += now * weight * force;
      }

    private:
      Point<3>     point;
      Tensor<1, 3> force;
      TimeFactor   factor;

      std::vector<std::pair<unsigned int, double>> shares;
    };

    const Registry<Load>::Add<PointLoad>
      registered("point load", "A force at a point, over time.");
  } // namespace
} // namespace Voussoir
