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
    place              = history->place_of(cell);
    const auto &points = model.discretization.points(number).get_points();
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


  bool
  LawStress::is_always_elastic() const
  {
    return history == nullptr;
  }


  const Material &
  LawStress::law() const
  {
    return *material;
  }


  namespace
  {
    SymmetricTensor<2, 3>
    lane_of(const SymmetricTensor3<Lanes> &tensor, const unsigned int lane)
    {
      SymmetricTensor<2, 3> one;
      for (unsigned int c = 0; c < 6; ++c)
        one.access_raw_entry(c) = tensor.access_raw_entry(c)[lane];
      return one;
    }


    void
    set_lane(SymmetricTensor3<Lanes>     &tensor,
             const unsigned int           lane,
             const SymmetricTensor<2, 3> &one)
    {
      for (unsigned int c = 0; c < 6; ++c)
        tensor.access_raw_entry(c)[lane] = one.access_raw_entry(c);
    }
  } // namespace


  void
  LawStressLanes::set(const unsigned int lane, const LawStress &law)
  {
    const ElasticConstants elastic = law.law().elastic_constants();
    laws[lane]                     = law;
    lame_lambda[lane]              = elastic.lame_lambda();
    shear_modulus[lane]            = elastic.shear_modulus();
    all_are_elastic =
      all_are_elastic && law.law().isotropic() && law.is_always_elastic();
  }


  void
  LawStressLanes::set_initial(const SymmetricTensor3<Lanes> &strain,
                              const Lanes                   &temperature)
  {
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      if (laws[lane])
        set_lane(offset,
                 lane,
                 laws[lane]->law().strain_of_law({},
                                                 lane_of(strain, lane),
                                                 temperature[lane]));
  }


  SymmetricTensor3<Lanes>
  LawStressLanes::operator()(const SymmetricTensor3<Lanes> &strain) const
  {
    const SymmetricTensor3<Lanes> of_law = strain + offset;
    SymmetricTensor3<Lanes>       result = 2. * shear_modulus * of_law;
    const Lanes                   mean   = lame_lambda * trace(of_law);
    for (unsigned int d = 0; d < 3; ++d)
      result[d][d] += mean;
    if (all_are_elastic)
      return result;
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      if (laws[lane] && (!laws[lane]->law().isotropic() ||
                         !laws[lane]->is_elastic(lane_of(result, lane))))
        set_lane(result, lane, (*laws[lane])(lane_of(of_law, lane), {}, 0.));
    return result;
  }
} // namespace Voussoir
