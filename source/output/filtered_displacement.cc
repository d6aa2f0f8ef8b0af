#include <voussoir/output/filtered_displacement.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Vector
    vector_with(const StressModel &model, const IndexSet &needed)
    {
      const auto &all =
        *model.discretization.matrix_free.get_vector_partitioner();
      const auto partitioner = std::make_shared<Utilities::MPI::Partitioner>(
        all.locally_owned_range(), needed, all.get_mpi_communicator());
      return Vector(partitioner);
    }
  } // namespace


  FilteredDisplacement::FilteredDisplacement(const StressModel &model)
    : FilteredDisplacement(model,
                           model.discretization.create_vector(),
                           model.discretization.owned_dofs)
  {}


  FilteredDisplacement::FilteredDisplacement(const StressModel &model,
                                             const IndexSet    &needed)
    : FilteredDisplacement(model, vector_with(model, needed), needed)
  {}


  FilteredDisplacement
  FilteredDisplacement::for_cells(const StressModel &model,
                                  const IndexSet    &needed)
  {
    return {model, model.discretization.create_vector(), needed};
  }


  void
  FilteredDisplacement::add_range(const unsigned int begin,
                                  const unsigned int end)
  {
    constexpr unsigned int length = 1024;
    for (unsigned int first = begin; first < end; first += length)
      ranges.emplace_back(first, std::min(first + length, end));
  }


  FilteredDisplacement::FilteredDisplacement(const StressModel &model,
                                             Vector           &&layout,
                                             const IndexSet    &needed)
    : damping(model.damping)
    , maxwell(model.damping, model.time_step)
    , uniform(
        model.internal_force.uniform_damping() ||
        (damping.n_branches() == 0 && damping.stiffness_coefficient == 0.))
    , factor(uniform ? model.internal_force.damping_factor() : 1.)
    , u(std::move(layout))
    , w(uniform ? Vector() : u)
  {
    const auto &partitioner = *u.get_partitioner();
    // entries that this rank needs, and ghosts of other ranks
    std::vector<bool> wanted(u.locally_owned_size(), false);
    for (const auto index : needed)
      if (partitioner.in_local_range(index))
        wanted[partitioner.global_to_local(index)] = true;
    for (const auto &[begin, end] : partitioner.import_indices())
      std::fill(wanted.begin() + begin, wanted.begin() + end, true);
    for (auto begin = wanted.begin(); begin != wanted.end();)
      {
        begin          = std::find(begin, wanted.end(), true);
        const auto end = std::find(begin, wanted.end(), false);
        add_range(begin - wanted.begin(), end - wanted.begin());
        begin = end;
      }
  }


  void
  FilteredDisplacement::update(const State &state)
  {
    u.zero_out_ghost_values();
    w.zero_out_ghost_values();
    const double *displacement = state.displacement.begin(),
                 *v            = state.velocity.begin();
    double      *filtered = u.begin(), *memory = uniform ? filtered : w.begin();
    const double share     = uniform ? factor : 1.,
                 viscosity = damping.mesh_viscosity,
                 beta      = share * damping.stiffness_coefficient;
    for (const auto &[begin, end] : ranges)
      {
        if (!uniform)
          std::fill(memory + begin, memory + end, 0.);
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          filtered[i] = displacement[i] + viscosity * v[i];
#pragma GCC ivdep
        for (unsigned int i = begin; i < end; ++i)
          memory[i] += beta * v[i];
        for (unsigned int k = 0; k < state.memory.size(); ++k)
          {
            const double *branch = state.memory[k].begin();
            const double  decay  = share * maxwell.decay[k],
                         gain    = share * maxwell.gain[k];
#pragma GCC ivdep
            for (unsigned int i = begin; i < end; ++i)
              memory[i] += decay * branch[i] + gain * v[i];
          }
      }
    u.update_ghost_values();
    if (!uniform)
      w.update_ghost_values();
  }


  const Vector &
  FilteredDisplacement::displacement() const
  {
    return u;
  }


  const Vector *
  FilteredDisplacement::memory() const
  {
    return uniform ? nullptr : &w;
  }


  unsigned int
  FilteredDisplacement::entry(const types::global_dof_index global) const
  {
    return u.get_partitioner()->global_to_local(global);
  }


  Vector
  FilteredDisplacement::entries_of(const Vector &vector) const
  {
    Vector result(u);
    result.zero_out_ghost_values();
    result.copy_locally_owned_data_from(vector);
    result.update_ghost_values();
    return result;
  }
} // namespace Voussoir
