// Boundary and materials of a model in the log.

#include <voussoir/driver/model.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  void
  Model::check_source_point(Log &log) const
  {
    const AbsorbingParameters &absorbing = parameters.boundaries.absorbing;
    if (split_list(absorbing.face_sets).empty() ||
        absorbing.type == AbsorbingType::viscous || absorbing.radius > 0.)
      return;
    const auto &[lower, upper] = boundary.extent();
    Tensor<1, 3> outside;
    for (unsigned int d = 0; d < 3; ++d)
      outside[d] = std::max(
        {0., lower[d] - absorbing.source[d], absorbing.source[d] - upper[d]});
    if (outside.norm() > 3. * upper.distance(lower))
      log.warn(
        "\"Source point\" in section \"Boundaries\" is ",
        outside.norm(),
        " m outside the model, which reaches from (",
        lower,
        ") to (",
        upper,
        ") m; springs at this distance from it have hardly any stiffness");
  }


  void
  Model::report_materials(Log &log) const
  {
    const std::vector<double> carried = carried_frequencies(),
                              widest  = widest_crack_bands();
    for (unsigned int m = 0; m < solid.materials.size(); ++m)
      {
        const ElasticConstants c = solid.materials[m]->elastic_constants();
        std::ostringstream     text;
        text << std::setprecision(4) << "Material "
             << parameters.materials.objects[m].first << ": mass "
             << solid.mass.total[m] << " kg, P wave " << c.p_wave_speed()
             << " m/s, S wave " << c.s_wave_speed()
             << " m/s; its largest cells carry waves up to "
             << std::setprecision(2) << carried[m]
             << " Hz with 8 nodes per wavelength";
        log.line(text.str());
        if (const std::string remark = solid.materials[m]->remark(widest[m]);
            !remark.empty())
          log.line("  note: ", remark);
        if (solid.materials[m]->n_history() > 0 &&
            solid.discretization.degree > 2)
          log.line(
            "  note: fracture energies hold in cells of degree 1 and 2; "
            "in cells of a higher degree the energy of a crack deviates from "
            "them.");
      }
  }
} // namespace Voussoir
