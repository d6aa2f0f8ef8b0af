#include <voussoir/output/law_stress.h>

namespace Voussoir
{
  using namespace dealii;

  LawStress::LawStress(const ObservedModel        &model,
                       const Discretization::Cell &cell,
                       const Point<3>             &unit)
  {
    const unsigned int number = model.material_of_cell(cell);
    material                  = model.materials[number];
    history                   = model.material_memory.of(number);
    if (history == nullptr)
      return;
    place = history->place_of(cell);
    const auto &points =
      model.discretization.matrix_free.get_quadrature().get_points();
    for (unsigned int i = 1; i < points.size(); ++i)
      // of equally near ones the first, whatever the round-off
      if (points[i].distance(unit) < points[q].distance(unit) - 1e-10)
        q = i;
  }


  SymmetricTensor<2, 3>
  LawStress::operator()(const SymmetricTensor<2, 3> &strain,
                        const SymmetricTensor<2, 3> &initial_strain,
                        const double                 temperature) const
  {
    const auto strain_of_law =
      material->strain_of_law(strain, initial_strain, temperature);
    const auto elastic = material->stress(strain_of_law);
    if (is_elastic(elastic))
      return elastic;
    const double band = history->band(place, q);
    const double width =
      band > 0. ? band : history->bands(place.batch).widest[place.lane];
    std::vector<double> memory = history->read(place, q);
    return material->respond(strain_of_law, memory.data(), {width, 0.}).stress;
  }


  bool
  LawStress::is_elastic(const SymmetricTensor<2, 3> &elastic_stress) const
  {
    return history == nullptr ||
           (history->band(place, q) == 0. &&
            material->load_level(
              elastic_stress, history->bands(place.batch).widest[place.lane]) <=
              1.);
  }
} // namespace Voussoir
