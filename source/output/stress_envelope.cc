#include <voussoir/materials/cell_loops.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/materials/spectral.h>
#include <voussoir/output/stress_envelope.h>

#include <deal.II/fe/fe_tools.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Entries that the evaluation of this rank's cells in these sets reads:
     *  those of their nodes, and of the nodes that constrain hanging nodes. */
    IndexSet
    entries_in(const Discretization           &discretization,
               const std::vector<std::string> &sets)
    {
      const std::vector<bool> tagged = discretization.grid.tags_in(sets);
      IndexSet                entries(discretization.owned_dofs.size());
      for (const auto &cell :
           discretization.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned() &&
            (sets.empty() || tagged[cell->material_id()]))
          for (const auto node : discretization.cell_nodes(cell))
            entries.add_range(3 * node, 3 * node + 3);
      entries.compress();
      IndexSet leading(entries.size());
      for (const auto entry : entries)
        if (const auto *line =
              discretization.constraints.get_constraint_entries(entry))
          for (const auto &[lead, weight] : *line)
            leading.add_index(lead);
      entries.add_indices(leading);
      return entries;
    }
  } // namespace


  StressEnvelope::StressEnvelope(const ObservedRun              &run,
                                 const std::vector<std::string> &sets)
    : run(run)
    , matrix_free(run.solid.discretization.matrix_free)
    , points(QTrapezoid<1>(), run.solid.discretization.degree)
    , filtered(FilteredDisplacement::for_cells(
        run,
        entries_in(run.solid.discretization, sets)))
  {
    const auto &scalar = run.solid.discretization.fe.base_element(0);
    const auto  order  = FETools::lexicographic_to_hierarchic_numbering<3>(
      run.solid.discretization.degree);
    for (const Point<3> &point : points.get_points())
      {
        shape_values.emplace_back();
        shape_gradients.emplace_back();
        vertex_gradients.emplace_back();
        for (const unsigned int j : order)
          {
            shape_values.back().push_back(scalar.shape_value(j, point));
            shape_gradients.back().push_back(scalar.shape_grad(j, point));
          }
        for (unsigned int v = 0; v < 8; ++v)
          vertex_gradients.back()[v] =
            GeometryInfo<3>::d_linear_shape_function_gradient(point, v);
      }
    const bool is_static = run.initial.displacement.size() > 0;
    if (is_static)
      {
        run.initial.displacement.update_ghost_values();
        run.initial.temperature.update_ghost_values();
      }
    BatchNodes              cells(matrix_free);
    const std::vector<bool> tagged = run.solid.grid().tags_in(sets);
    for (unsigned int b = 0; b < matrix_free.n_cell_batches(); ++b)
      {
        const auto watched = lanes_in(b, sets.empty(), tagged);
        if (watched.any())
          batches.push_back(make_batch(b, watched, is_static, cells));
      }
    if (is_static)
      {
        run.initial.displacement.zero_out_ghost_values();
        run.initial.temperature.zero_out_ghost_values();
      }
  }


  void
  StressEnvelope::update(const State &state)
  {
    filtered.update(state);
    const Vector    *memory = filtered.memory();
    const SweepInput input{state.displacement,
                           filtered.displacement(),
                           memory != nullptr ?
                             SweepInput::Damping::by_material :
                             SweepInput::Damping::common,
                           memory};
    BatchNodes       cells(matrix_free);
    for (Batch &batch : batches)
      {
        cells.reinit(batch.number);
        CellKernels::read_filtered(cells, input, batch.damping_factor);
        Lanes high, low;
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            high[lane] = batch.extremes[lane][0];
            low[lane]  = batch.extremes[lane][1];
          }
        for (unsigned int p = 0; p < points.size(); ++p)
          {
            const SymmetricTensor3<Lanes> now =
              batch.law(p)(strain(cells, batch, p));
            const auto [below, above] = principal_bounds(now);
            if (are_within(below, above, low, high))
              continue;
            const auto [largest, smallest] =
              largest_and_smallest_principal(now);
            high = std::max(high, largest);
            low  = std::min(low, smallest);
          }
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            StressExtremes &extremes = batch.extremes[lane];
            // a NaN stays
            if (!(high[lane] <= extremes[0]))
              {
                extremes[0] = high[lane];
                extremes[2] = state.time;
              }
            if (!(low[lane] >= extremes[1]))
              {
                extremes[1] = low[lane];
                extremes[3] = state.time;
              }
          }
      }
  }


  double
  StressEnvelope::share_of_cells() const
  {
    std::size_t n = 0;
    for (const Batch &batch : batches)
      n += batch.watched.count();
    const auto &triangulation = run.solid.grid().triangulation();
    return double(Utilities::MPI::sum(n, triangulation.get_communicator())) /
           double(triangulation.n_global_active_cells());
  }


  void
  StressEnvelope::for_each_cell(
    const std::function<void(const Discretization::Cell &, StressExtremes &)>
      &visit)
  {
    for (Batch &batch : batches)
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        if (batch.watched[lane])
          visit(matrix_free.get_cell_iterator(batch.number, lane),
                batch.extremes[lane]);
  }


  bool
  StressEnvelope::are_within(const Lanes &below,
                             const Lanes &above,
                             const Lanes &low,
                             const Lanes &high)
  {
    bool within = true;
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      within = within && above[lane] <= high[lane] && below[lane] >= low[lane];
    return within;
  }


  StressEnvelope::LaneSet
  StressEnvelope::lanes_in(const unsigned int       batch,
                           const bool               all,
                           const std::vector<bool> &tagged) const
  {
    LaneSet found;
    for (unsigned int lane = 0;
         lane < matrix_free.n_active_entries_per_cell_batch(batch);
         ++lane)
      found[lane] =
        all ||
        tagged[matrix_free.get_cell_iterator(batch, lane)->material_id()];
    return found;
  }


  StressEnvelope::Batch
  StressEnvelope::make_batch(const unsigned int number,
                             const LaneSet     &watched,
                             const bool         is_static,
                             BatchNodes        &cells) const
  {
    Batch batch;
    batch.number  = number;
    batch.watched = watched;
    const unsigned int material =
      run.solid.discretization.material_of_batch[number];
    batch.damping_factor = run.solid.materials[material]->damping_factor();
    // The law of a point depends on its history and its static strain.
    const bool is_common =
      !is_static && run.material_memory.of(material) == nullptr;
    batch.laws.resize(is_common ? 1 : points.size());
    for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
      {
        const bool exists =
          lane < matrix_free.n_active_entries_per_cell_batch(number);
        const auto cell =
          matrix_free.get_cell_iterator(number, exists ? lane : 0);
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            batch.vertices[v][d][lane] = cell->vertex(v)[d];
        if (watched[lane])
          for (unsigned int p = 0; p < batch.laws.size(); ++p)
            batch.laws[p].set(lane, {run, cell, points.point(p)});
      }
    if (!is_static)
      return batch;
    cells.reinit(number);
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        cells.read_dof_values(run.initial.displacement);
        const SymmetricTensor3<Lanes> initial = strain(cells, batch, p);
        cells.read_dof_values(run.initial.temperature);
        Lanes temperature = 0.;
        for (unsigned int j = 0; j < shape_values[p].size(); ++j)
          temperature += shape_values[p][j] * cells.begin_dof_values()[j];
        batch.laws[p].set_initial(initial, temperature);
      }
    return batch;
  }


  SymmetricTensor3<Lanes>
  StressEnvelope::strain(const BatchNodes  &cells,
                         const Batch       &batch,
                         const unsigned int point) const
  {
    Tensor<2, 3, Lanes> jacobian, unit_gradient;
    const Lanes        *values = cells.begin_dof_values();
    if (run.solid.discretization.degree == 1)
      // the edges that meet in the corner
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int end   = point | (1U << k),
                             begin = point & ~(1U << k);
          for (unsigned int d = 0; d < 3; ++d)
            {
              jacobian[d][k] =
                batch.vertices[end][d] - batch.vertices[begin][d];
              unit_gradient[d][k] = values[8 * d + end] - values[8 * d + begin];
            }
        }
    else
      {
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int k = 0; k < 3; ++k)
              jacobian[d][k] +=
                vertex_gradients[point][v][k] * batch.vertices[v][d];
        for (unsigned int d = 0; d < 3; ++d)
          for (const Tensor<1, 3> &gradient : shape_gradients[point])
            {
              for (unsigned int k = 0; k < 3; ++k)
                unit_gradient[d][k] += gradient[k] * *values;
              ++values;
            }
      }
    return symmetrize(unit_gradient * invert(jacobian));
  }
} // namespace Voussoir
