#include <voussoir/base/error.h>
#include <voussoir/materials/point_test.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

namespace Voussoir
{
  using namespace dealii;

  const std::array<std::string, 6> &
  PointTest::component_names()
  {
    static const std::array<std::string, 6> names{
      {"xx", "yy", "zz", "xy", "xz", "yz"}};
    return names;
  }


  PointTest::PointTest(const Material &material,
                       const double    element_length,
                       const double    time_step)
    : material(material)
    , situation{element_length, time_step}
    , history(material.n_history())
  {}


  void
  PointTest::advance(const Controls &controls)
  {
    const SymmetricTensor3<double> strain_before = strain,
                                   stress_before = stress;
    std::vector<unsigned int> unknown; // components of given stress
    for (unsigned int i = 0; i < 6; ++i)
      if (controls[i].is_strain)
        strain.access_raw_entry(i) = controls[i].value;
      else
        unknown.push_back(i);

    const double modulus   = material.elastic_constants().young_modulus;
    const auto   stress_at = [&](const SymmetricTensor3<double> &at) {
      std::vector<double> copy = history;
      return material.respond(at, copy.data(), situation).stress;
    };
    const auto miss = [&](const SymmetricTensor3<double> &at) {
      const auto             now = stress_at(at);
      dealii::Vector<double> result(unknown.size());
      for (unsigned int k = 0; k < unknown.size(); ++k)
        result(k) =
          now.access_raw_entry(unknown[k]) - controls[unknown[k]].value;
      return result;
    };

    // Newton's method with differences; steps are halved where the residual
    // does not fall
    dealii::Vector<double> residual = miss(strain);
    const double           goal     = 1e-10 * modulus * 1e-4;
    for (unsigned int iteration = 0;
         !unknown.empty() && residual.l2_norm() > goal;
         ++iteration)
      {
        if (iteration == 100)
          throw UserError("The material test finds no strain that gives the "
                          "prescribed stresses; the material may have lost its "
                          "strength. Control the strain of the failing "
                          "component instead.");
        FullMatrix<double> tangent(unknown.size(), unknown.size());
        // small against the residual and away from the prescribed stress, where
        // a law may have a kink
        const double size =
          std::max(1e-14, std::min(1e-9, 0.1 * residual.l2_norm() / modulus));
        for (unsigned int k = 0; k < unknown.size(); ++k)
          {
            const double difference        = residual(k) < 0. ? -size : size;
            SymmetricTensor3<double> moved = strain;
            moved.access_raw_entry(unknown[k]) += difference;
            const auto changed = miss(moved);
            for (unsigned int l = 0; l < unknown.size(); ++l)
              tangent(l, k) = (changed(l) - residual(l)) / difference;
            tangent(k, k) +=
              1e-8 * modulus; // where the point has lost all stiffness
          }
        tangent.gauss_jordan();
        dealii::Vector<double> change(unknown.size());
        tangent.vmult(change, residual);
        const SymmetricTensor3<double> start = strain;
        for (double share = 1.; share > 1e-3; share *= 0.5)
          {
            strain = start;
            for (unsigned int k = 0; k < unknown.size(); ++k)
              strain.access_raw_entry(unknown[k]) -= share * change(k);
            const auto now = miss(strain);
            if (now.l2_norm() < residual.l2_norm() || share < 2e-3)
              {
                residual = now;
                break;
              }
          }
      }

    const auto response = material.respond(strain, history.data(), situation);
    stress              = response.stress;
    dissipated += response.dissipation;
    stored = 0.5 * (response.stress * response.elastic_strain);
    work += 0.5 * (stress + stress_before) * (strain - strain_before);
  }


  std::vector<double>
  PointTest::outputs() const
  {
    return material.outputs(history.data(), situation.element_length);
  }
} // namespace Voussoir
