#include <voussoir/fem/point_history.h>

namespace Voussoir
{
  using namespace dealii;

  PointHistory::PointHistory(const Discretization &discretization,
                             const unsigned int    material,
                             const unsigned int    width)
    : width(width)
  {
    if (width == 0)
      return;
    const auto &matrix_free = discretization.matrix_free;
    n_points                = matrix_free.get_quadrature().size();
    slot_of_batch.assign(matrix_free.n_cell_batches(),
                         numbers::invalid_unsigned_int);
    item_of_cell.assign(discretization.grid.triangulation().n_active_cells(),
                        numbers::invalid_unsigned_int);
    unsigned int n_slots = 0;
    for (unsigned int batch = 0; batch < matrix_free.n_cell_batches(); ++batch)
      {
        if (discretization.material_of_batch[batch] != material)
          continue;
        slot_of_batch[batch] = n_slots++;
        Lanes length         = 1.;
        for (unsigned int lane = 0;
             lane < matrix_free.n_active_entries_per_cell_batch(batch);
             ++lane)
          {
            const auto cell = matrix_free.get_cell_iterator(batch, lane);
            length[lane] = std::cbrt(cell->measure()) / discretization.degree;
            item_of_cell[cell->active_cell_index()] = places.size();
            places.push_back({cell, {batch, lane}});
          }
        lengths.push_back(length);
      }
    numbers.resize(std::size_t(n_slots) * n_points * width);
    damping_shares.resize(n_slots * n_points, Lanes(1.));
    active.resize(n_slots * n_points, 0);
  }


  bool
  PointHistory::empty() const
  {
    return width == 0;
  }


  void
  PointHistory::make_offsets()
  {
    offsets.resize(active.size());
    static_strains.resize(active.size());
    has_offset = true;
  }


  void
  PointHistory::mark_start()
  {
    dissipated = 0.;
    if (std::count(active.begin(), active.end(), 1) > 0)
      at_start = numbers;
  }


  const Lanes *
  PointHistory::values_at_start(const unsigned int batch,
                                const unsigned int q) const
  {
    return at_start.empty() ? nullptr :
                              at_start.data() + width * index(batch, q);
  }


  const std::vector<std::pair<Discretization::Cell, PointHistory::Place>> &
  PointHistory::cells() const
  {
    return places;
  }


  PointHistory::Place
  PointHistory::place_of(const Discretization::Cell &cell) const
  {
    return places[item_of_cell[cell->active_cell_index()]].second;
  }


  std::vector<double>
  PointHistory::read(const Place &place, const unsigned int q) const
  {
    std::vector<double> result;
    const Lanes        *source = values(place.batch, q);
    for (unsigned int i = 0; i < width; ++i)
      result.push_back(source[i][place.lane]);
    return result;
  }


  KeyedValues
  PointHistory::checkpoint_values()
  {
    // with the damping share
    const unsigned int n_numbers = n_points * (width + 1);
    packed.resize(places.size() * n_numbers);
    exchange(false);
    KeyedValues values{n_numbers, {}};
    for (unsigned int i = 0; i < places.size(); ++i)
      values.items.emplace_back(Grid::global_key(places[i].first),
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
    for (const auto &place : places)
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const auto [batch, lane] = place.second;
          bool is_new              = true;
          for (unsigned int i = 0; i < width; ++i)
            {
              trade(values(batch, q)[i][lane]);
              is_new = is_new && values(batch, q)[i][lane] == 0.;
            }
          if (!is_new)
            activate(batch, q);
          trade(damping_shares[index(batch, q)][lane]);
        }
  }
} // namespace Voussoir
