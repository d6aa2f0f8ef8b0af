#include <voussoir/materials/isotropic_elasticity.h>
#include <voussoir/output/law_stress.h>

namespace Voussoir
{
  using namespace dealii;

  LawStress::LawStress(const StressModel          &model,
                       const Discretization::Cell &cell,
                       const Point<3>             &unit)
  {
    const unsigned int number = model.discretization.grid.material(cell);
    material                  = model.materials[number];
    history                   = model.material_memory.of(number);
    k                         = model.internal_force.factor_of(number);
    if (history == nullptr)
      return;
    place              = model.discretization.place_of(cell);
    const auto &points = model.discretization.points(number).get_points();
    for (unsigned int i = 1; i < points.size(); ++i)
      // the first one of equally near points, independent of round-off
      if (points[i].distance(unit) < points[q].distance(unit) - 1e-10)
        q = i;
  }


  SymmetricTensor<2, 3>
  LawStress::operator()(const SymmetricTensor<2, 3> &elastic_strain) const
  {
    if (is_active())
      return history->stress(place, q);
    const auto elastic = material->stress(elastic_strain);
    if (is_elastic(elastic))
      return elastic;
    std::vector<double> memory = history->read(place, q);
    return material->respond(elastic_strain, memory.data(), {widest_band(), 0.})
      .stress;
  }


  SymmetricTensor<2, 3>
  LawStress::elastic_strain(const SymmetricTensor<2, 3> &filtered,
                            const SymmetricTensor<2, 3> &initial_strain,
                            const double                 temperature) const
  {
    const auto strain =
      material->elastic_strain(filtered, initial_strain, temperature, k);
    if (history == nullptr || is_active())
      return strain;
    // The law of the static state limits this stress, and stress is handed
    // over.
    const auto elastic =
      material->elastic_strain(initial_strain, initial_strain, temperature, k);
    const Material &at_rest = material->at_rest();
    if (&at_rest == material ||
        at_rest.yield_ratio(material->stress(elastic), widest_band()) <= 1.)
      return strain;
    IsotropicElasticity elasticity;
    elasticity.young_modulus   = material->elastic_constants().young_modulus;
    elasticity.poisson_ratio   = material->elastic_constants().poisson_ratio;
    std::vector<double> memory = history->read(place, q);
    const auto          stress =
      at_rest
        .respond(elasticity.young_modulus /
                   at_rest.elastic_constants().young_modulus * elastic,
                 memory.data(),
                 {widest_band(), 0.})
        .stress;
    auto handed_over = elasticity.strain(stress);
    // up to the peak of compression the law of the run takes a part of it, too
    for (unsigned int i = 0; i < 40; ++i)
      {
        const auto missing = stress - (*this)(handed_over);
        if (missing.norm() <= 1e-9 * stress.norm())
          break;
        handed_over += elasticity.strain(missing);
      }
    return strain - elastic + handed_over;
  }


  bool
  LawStress::is_elastic(const SymmetricTensor<2, 3> &elastic_stress) const
  {
    return history == nullptr ||
           (!is_active() &&
            material->yield_ratio(elastic_stress, widest_band()) <= 1.);
  }


  bool
  LawStress::is_active() const
  {
    return history != nullptr && history->band(place, q) > 0.;
  }


  const ActivePoint *
  LawStress::active_lanes() const
  {
    return history != nullptr && history->is_active(place.batch, q) ?
             &history->active_point(place.batch, q) :
             nullptr;
  }


  bool
  LawStress::is_lane_beside(const LawStress &other) const
  {
    return history == other.history && place.batch == other.place.batch &&
           q == other.q;
  }


  double
  LawStress::widest_band() const
  {
    return history == nullptr ? 0. :
                                history->bands(place.batch).widest[place.lane];
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


  double
  LawStress::stress_factor() const
  {
    return k;
  }


  namespace
  {
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
    const bool             is_first =
      std::none_of(laws.begin(), laws.end(), [](const auto &one) {
        return one.has_value();
      });
    common = law.law().isotropic() && (is_first || common == &law.law()) ?
               &law.law() :
               nullptr;
    for (const auto &other : laws)
      are_in_one_batch =
        are_in_one_batch && (!other || law.is_lane_beside(*other));
    laws[lane]           = law;
    bands[lane]          = law.widest_band();
    lame_lambda[lane]    = elastic.lame_lambda();
    shear_modulus[lane]  = elastic.shear_modulus();
    stress_factor[lane]  = law.stress_factor();
    damping_factor[lane] = law.law().damping_factor();
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
                 laws[lane]->elastic_strain({},
                                            lane_of(strain, lane),
                                            temperature[lane]));
  }


  SymmetricTensor3<Lanes>
  LawStressLanes::operator()(const SymmetricTensor3<Lanes> &filtered) const
  {
    const SymmetricTensor3<Lanes> of_law = stress_factor * filtered + offset;
    SymmetricTensor3<Lanes>       result = 2. * shear_modulus * of_law;
    const Lanes                   mean   = lame_lambda * trace(of_law);
    for (unsigned int d = 0; d < 3; ++d)
      result[d][d] += mean;
    if (all_are_elastic)
      return result;
    if (common == nullptr)
      {
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          if (laws[lane] && (!laws[lane]->law().isotropic() ||
                             !laws[lane]->is_elastic(lane_of(result, lane))))
            set_lane(result, lane, (*laws[lane])(lane_of(of_law, lane)));
        return result;
      }
    Lanes ratio = common->yield_ratio(result, bands);
    if (are_in_one_batch)
      take_active_lanes(ratio, result);
    else
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (laws[lane] && laws[lane]->is_active())
          {
            set_lane(result, lane, (*laws[lane])(lane_of(of_law, lane)));
            ratio[lane] = 0.;
          }
    if (any_above(ratio, 1.))
      {
        const SymmetricTensor3<Lanes> beyond =
          common->stress_of_elastic_points(of_law, bands);
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          if (laws[lane] && ratio[lane] > 1.)
            set_lane(result, lane, lane_of(beyond, lane));
      }
    return result;
  }


  void
  LawStressLanes::take_active_lanes(Lanes                   &ratio,
                                    SymmetricTensor3<Lanes> &stress) const
  {
    const auto         law   = std::find_if(laws.begin(),
                                  laws.end(),
                                  [](const auto &one) { return one; });
    const ActivePoint *point = (*law)->active_lanes();
    if (point == nullptr)
      return;
    const auto where_elastic = [&](const Lanes &elastic, const Lanes &active) {
      return compare_and_apply_mask<SIMDComparison::equal>(point->band,
                                                           Lanes(0.),
                                                           elastic,
                                                           active);
    };
    const SymmetricTensor3<Lanes> of_point = point->total_stress();
    for (unsigned int c = 0; c < 6; ++c)
      stress.access_raw_entry(c) =
        where_elastic(stress.access_raw_entry(c), of_point.access_raw_entry(c));
    ratio = where_elastic(ratio, 0.);
  }


  const Lanes &
  LawStressLanes::damping_factors() const
  {
    return damping_factor;
  }
} // namespace Voussoir
