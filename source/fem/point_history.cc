#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  using namespace dealii;

  PointHistory::PointHistory(const Discretization &discretization,
                             const unsigned int    material,
                             const unsigned int    width)
    : n_numbers(width)
  {
    if (width == 0)
      return;
    const auto &matrix_free = discretization.matrix_free;
    Points      found;
    found.per_cell = matrix_free.get_quadrature().size();
    found.slot_of_batch.assign(matrix_free.n_cell_batches(),
                               numbers::invalid_unsigned_int);
    found.item_of_cell.assign(
      discretization.grid.triangulation().n_active_cells(),
      numbers::invalid_unsigned_int);
    unsigned int n_slots = 0;
    for (unsigned int batch = 0; batch < matrix_free.n_cell_batches(); ++batch)
      {
        if (discretization.material_of_batch[batch] != material)
          continue;
        found.slot_of_batch[batch] = n_slots++;
        Lanes length               = 1.;
        for (unsigned int lane = 0;
             lane < matrix_free.n_active_entries_per_cell_batch(batch);
             ++lane)
          {
            const auto cell = matrix_free.get_cell_iterator(batch, lane);
            length[lane]    = element_length_of(cell, discretization.degree);
            found.item_of_cell[cell->active_cell_index()] = found.cells.size();
            found.cells.push_back({cell, {batch, lane}});
          }
        found.lengths.push_back(length);
      }
    const std::size_t n_points = std::size_t(n_slots) * found.per_cell;
    numbers.resize(n_points * width);
    damping_shares.resize(n_points, Lanes(1.));
    active.resize(n_points, 0);
    points = std::make_shared<const Points>(std::move(found));
  }


  double
  PointHistory::element_length_of(const Grid::Cell  &cell,
                                  const unsigned int degree)
  {
    return std::cbrt(cell->measure()) / degree;
  }


  void
  PointHistory::make_static_strains()
  {
    static_strains = std::make_shared<StaticStrains>();
    static_strains->offsets.resize(active.size());
    static_strains->elastic.resize(active.size());
  }


  const std::vector<std::pair<Discretization::Cell, PointHistory::Place>> &
  PointHistory::cells() const
  {
    return points->cells;
  }


  PointHistory::Place
  PointHistory::place_of(const Discretization::Cell &cell) const
  {
    return points->cells[points->item_of_cell[cell->active_cell_index()]]
      .second;
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


  KeyedValues
  PointHistory::checkpoint_values()
  {
    // with the damping share
    const unsigned int of_cell = n_points() * (n_numbers + 1);
    packed.resize(points->cells.size() * of_cell);
    exchange(false);
    KeyedValues values{of_cell, {}};
    for (unsigned int i = 0; i < points->cells.size(); ++i)
      values.items.emplace_back(Grid::global_key(points->cells[i].first),
                                packed.data() + i * values.width);
    return values;
  }


  void
  PointHistory::load()
  {
    exchange(true);
    packed.clear();
  }


  void
  PointHistory::exchange(const bool load)
  {
    auto       item  = packed.begin();
    const auto trade = [&](double &number) {
      if (load)
        number = *item++;
      else
        *item++ = number;
    };
    for (const auto &place : points->cells)
      for (unsigned int q = 0; q < n_points(); ++q)
        {
          const auto [batch, lane] = place.second;
          bool is_new              = true;
          for (unsigned int i = 0; i < n_numbers; ++i)
            {
              trade(values(batch, q)[i][lane]);
              is_new = is_new && values(batch, q)[i][lane] == 0.;
            }
          if (!is_new)
            activate(batch, q);
          trade(damping_shares[index(batch, q)][lane]);
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


  bool
  MaterialMemory::empty() const
  {
    return std::all_of(histories.begin(),
                       histories.end(),
                       [](const PointHistory &history) {
                         return history.empty();
                       });
  }


  double
  MaterialMemory::dissipated() const
  {
    double energy = 0.;
    for (const PointHistory &history : histories)
      energy += history.dissipated;
    return energy;
  }


  void
  MaterialMemory::set_dissipated(const double energy)
  {
    for (PointHistory &history : histories)
      history.dissipated = 0.;
    if (!histories.empty())
      histories[0].dissipated = energy;
  }
} // namespace Voussoir
