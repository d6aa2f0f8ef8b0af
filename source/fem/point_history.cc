#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  using namespace dealii;

  PointHistory::PointHistory(const Discretization &discretization,
                             const unsigned int    material,
                             const unsigned int    width)
    : losses(discretization.reproducible)
    , n_numbers(width)
  {
    if (width == 0)
      return;
    const auto &matrix_free = discretization.matrix_free;
    Points      found;
    found.lanes_are_alone = discretization.reproducible;
    found.per_cell        = discretization.points(material).size();
    found.slot_of_batch.assign(matrix_free.n_cell_batches(),
                               numbers::invalid_unsigned_int);
    unsigned int n_slots = 0;
    for (unsigned int batch = 0; batch < matrix_free.n_cell_batches(); ++batch)
      {
        if (discretization.material_of_batch[batch] != material)
          continue;
        found.slot_of_batch[batch] = n_slots++;
        CrackBands bands;
        for (unsigned int lane = 0;
             lane < matrix_free.n_active_entries_per_cell_batch(batch);
             ++lane)
          {
            const auto cell = matrix_free.get_cell_iterator(batch, lane);
            bands.set_lane(lane, cell, discretization.crack_share);
            found.cells.push_back({cell, {batch, lane}});
          }
        found.bands.push_back(bands);
      }
    active.resize(std::size_t(n_slots) * found.per_cell, 0);
    numbers.resize(width);
    points = std::make_shared<const Points>(std::move(found));
  }


  void
  PointHistory::activate(const unsigned int batch,
                         const unsigned int q,
                         const ActivePoint &point)
  {
    active_points.push_back(point);
    active[index(batch, q)] = active_points.size();
    for (unsigned int i = 0; i < n_numbers; ++i)
      {
        numbers.push_back(numbers[i]);
        numbers[i] = 0.;
      }
  }


  void
  PointHistory::make_static_strains()
  {
    static_strains = std::make_shared<StaticStrains>();
    static_strains->offsets.resize(active.size());
    static_strains->elastic.resize(active.size());
    static_strains->stabilised.resize(planes.size());
  }


  void
  PointHistory::make_planes()
  {
    with_planes = true;
    planes.resize(points->bands.size());
  }


  void
  PointHistory::take_over_released(const unsigned int batch)
  {
    Lanes &released = planes_of(batch).released;
    if (is_active(batch, 0))
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (tips_of(batch).run_on[lane] > 0.)
          released[lane] =
            std::max(released[lane], 1. - active_point(batch, 0).share[lane]);
    stabilised_static(batch).released = released;
  }


  const std::vector<std::pair<Discretization::Cell, PointHistory::Place>> &
  PointHistory::cells() const
  {
    return points->cells;
  }


  SymmetricTensor<2, 3>
  PointHistory::stress(const Place &place, const unsigned int q) const
  {
    const ActivePoint &point = active_point(place.batch, q);
    return lane_of(point.total_stress(), place.lane);
  }


  SymmetricTensor<2, 3>
  PointHistory::inelastic_strain(const Place       &place,
                                 const unsigned int q,
                                 const double       young_modulus,
                                 const double       poisson_ratio) const
  {
    const ActivePoint          &point  = active_point(place.batch, q);
    const SymmetricTensor<2, 3> stress = lane_of(point.stress, place.lane);
    return lane_of(point.law_strain, place.lane) -
           1. / young_modulus *
             ((1. + poisson_ratio) * stress -
              poisson_ratio * trace(stress) * unit_symmetric_tensor<3>());
  }


  std::vector<double>
  PointHistory::read(const Place &place, const unsigned int q) const
  {
    std::vector<double> result;
    const Lanes        *source = values(place.batch, q);
    for (unsigned int i = 0; i < n_numbers; ++i)
      result.push_back(source[i][place.lane]);
    return result;
  }


  namespace
  {
    // Calls visit(Lanes &) for each internal variable of a point beside those
    // of its law, and returns their number.
    template <typename Visitor>
    unsigned int
    for_each_number(ActivePoint &point, const Visitor &visit)
    {
      unsigned int n         = 0;
      const auto   visit_one = [&](Lanes &number) {
        visit(number);
        ++n;
      };
      for (Lanes *number :
           {&point.band, &point.share, &point.impact, &point.filter_imbalance})
        visit_one(*number);
      for (unsigned int d = 0; d < 3; ++d)
        visit_one(point.normal[d]);
      for (SymmetricTensor3<Lanes> *tensor : {&point.strain,
                                              &point.law_strain,
                                              &point.plastic,
                                              &point.stress,
                                              &point.filter})
        for (unsigned int i = 0; i < 6; ++i)
          visit_one(tensor->access_raw_entry(i));
      return n;
    }


    unsigned int
    n_of_planes()
    {
      PlanesOfBatch planes;
      unsigned int  n = 0;
      planes.for_each_number([&](const Lanes &) { ++n; });
      return n;
    }


    unsigned int
    n_of_active_point()
    {
      ActivePoint point;
      return for_each_number(point, [](const Lanes &) {});
    }
  } // namespace


  void
  ActivePoint::forget_elastic()
  {
    const Lanes known = band;
    if (std::all_of(known.begin(), known.end(), [](const double width) {
          return width > 0.;
        }))
      return;
    const double intact = ActivePoint().share[0];
    for_each_number(*this, [&](Lanes &number) {
      number = compare_and_apply_mask<SIMDComparison::equal>(
        known, Lanes(0.), Lanes(&number == &share ? intact : 0.), number);
    });
  }


  KeyedValues
  PointHistory::checkpoint_values()
  {
    KeyedValues values{2 + (has_planes() ? n_of_planes() : 0) +
                         n_points() * (n_numbers + 1 + n_of_active_point()),
                       {},
                       [this](const std::size_t cell, double *row) {
                         pack(points->cells[cell].second, row);
                       },
                       [this](const std::size_t cell, const double *row) {
                         unpack(points->cells[cell].second, row);
                       }};
    for (const auto &cell : points->cells)
      values.items.emplace_back(Grid::global_key(cell.first), nullptr);
    return values;
  }


  void
  PointHistory::pack(const Place &place, double *row)
  {
    const unsigned int batch = place.batch, lane = place.lane;
    // a row of a cell as it began is zero
    const TipsOfBatch tip = tips.empty() ? TipsOfBatch() : tips_of(batch);
    *row++                = tip.strength[lane] == 1. ? 0. : tip.strength[lane];
    *row++                = tip.run_on[lane];
    if (has_planes())
      planes_of(batch).for_each_number(
        [&](const Lanes &number) { *row++ = number[lane]; });
    for (unsigned int q = 0; q < n_points(); ++q)
      {
        for (unsigned int i = 0; i < n_numbers; ++i)
          *row++ = values(batch, q)[i][lane];
        *row++ = imbalances.empty() ? 0. : imbalances[index(batch, q)][lane];
        // points of batches that are elastic leave zeros
        if (is_active(batch, q) &&
            (!lanes_are_alone() || active_point(batch, q).band[lane] > 0.))
          {
            ActivePoint point = active_point(batch, q);
            for_each_number(point, [&](const Lanes &number) {
              *row++ = number[lane];
            });
          }
        else
          {
            std::fill_n(row, n_of_active_point(), 0.);
            row += n_of_active_point();
          }
      }
  }


  void
  PointHistory::unpack(const Place &place, const double *row)
  {
    const unsigned int batch = place.batch, lane = place.lane;
    const double       strength = *row++, run_on = *row++;
    if (strength != 0.)
      tips_of(batch).strength[lane] = strength;
    if (run_on != 0.)
      tips_of(batch).run_on[lane] = run_on;
    if (has_planes())
      planes_of(batch).for_each_number(
        [&](Lanes &number) { number[lane] = *row++; });
    for (unsigned int q = 0; q < n_points(); ++q)
      {
        const double *numbers_of_law = row;
        row += n_numbers;
        if (*row != 0. || !imbalances.empty())
          imbalance(batch, q)[lane] = *row;
        ++row;
        const double *end = row + n_of_active_point();
        if (std::any_of(row, end, [](const double x) { return x != 0.; }))
          {
            if (!is_active(batch, q))
              activate(batch, q, ActivePoint());
            for (unsigned int i = 0; i < n_numbers; ++i)
              values(batch, q)[i][lane] = numbers_of_law[i];
            for_each_number(active_point(batch, q),
                            [&](Lanes &number) { number[lane] = *row++; });
          }
        row = end;
      }
  }


  MaterialMemory::MaterialMemory(const Discretization &discretization,
                                 const std::vector<unsigned int> &widths)
  {
    for (unsigned int m = 0; m < widths.size(); ++m)
      histories.emplace_back(discretization, m, widths[m]);
  }


  PointHistory *
  MaterialMemory::of(const unsigned int material)
  {
    return material < histories.size() && !histories[material].empty() ?
             &histories[material] :
             nullptr;
  }


  const PointHistory *
  MaterialMemory::of(const unsigned int material) const
  {
    return material < histories.size() && !histories[material].empty() ?
             &histories[material] :
             nullptr;
  }


  void
  MaterialMemory::take_tips(const MaterialMemory &other)
  {
    for (unsigned int m = 0; m < histories.size(); ++m)
      histories[m].take_tips(other.histories[m]);
  }


  bool
  MaterialMemory::empty() const
  {
    return std::all_of(histories.begin(),
                       histories.end(),
                       [](const PointHistory &history) {
                         return history.empty();
                       });
  }


  PointLosses
  MaterialMemory::losses() const
  {
    PointLosses sum;
    for (const PointHistory &history : histories)
      sum += history.losses;
    return sum;
  }


  void
  MaterialMemory::set_losses(const PointLosses &losses)
  {
    for (PointHistory &history : histories)
      history.losses = PointLosses(history.losses.material.is_exact());
    if (!histories.empty())
      histories[0].losses += losses;
  }
} // namespace Voussoir
