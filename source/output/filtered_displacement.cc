#include <voussoir/output/filtered_displacement.h>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    Vector
    vector_with(const ObservedModel &model, const IndexSet &needed)
    {
      const auto &all =
        *model.discretization.matrix_free.get_vector_partitioner();
      const auto partitioner = std::make_shared<Utilities::MPI::Partitioner>(
        all.locally_owned_range(), needed, all.get_mpi_communicator());
      return Vector(partitioner);
    }
  } // namespace


  FilteredDisplacement::FilteredDisplacement(const ObservedModel &model)
    : FilteredDisplacement(model, model.discretization.create_vector())
  {
    nodes.resize(u.locally_owned_size() / 3);
    std::iota(nodes.begin(), nodes.end(), 0);
  }


  FilteredDisplacement::FilteredDisplacement(const ObservedModel &model,
                                             const IndexSet      &needed)
    : FilteredDisplacement(model, vector_with(model, needed))
  {
    const auto &partitioner = *u.get_partitioner();
    // for this rank and for those whose ghosts they are
    std::vector<bool> wanted(u.locally_owned_size() / 3, false);
    for (const auto index : needed)
      if (partitioner.in_local_range(index))
        wanted[partitioner.global_to_local(index) / 3] = true;
    for (const auto &[begin, end] : partitioner.import_indices())
      for (unsigned int i = begin; i < end; ++i)
        wanted[i / 3] = true;
    for (unsigned int node = 0; node < wanted.size(); ++node)
      if (wanted[node])
        nodes.push_back(node);
  }


  FilteredDisplacement::FilteredDisplacement(const ObservedModel &model,
                                             Vector             &&layout)
    : damping(model.damping)
    , maxwell(model.damping, model.time_step)
    , uniform(
        model.internal_force.uniform_damping() ||
        (damping.n_branches() == 0 && damping.stiffness_coefficient == 0.))
    , factor(uniform ? model.internal_force.damping_factor() : 1.)
    , u(std::move(layout))
    , w(uniform ? Vector() : u)
  {}


  void
  FilteredDisplacement::update(const State &state)
  {
    u.zero_out_ghost_values();
    w.zero_out_ghost_values();
    const auto &[decay, gain] = maxwell;
    std::vector<const double *> branches;
    for (const Vector &branch : state.memory)
      branches.push_back(branch.begin());
    const double *displacement = state.displacement.begin(),
                 *velocity     = state.velocity.begin();
    for (const unsigned int node : nodes)
      for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
        {
          const double v      = velocity[i];
          double       memory = damping.stiffness_coefficient * v;
          for (unsigned int k = 0; k < branches.size(); ++k)
            memory += decay[k] * branches[k][i] + gain[k] * v;
          double &filtered = u.local_element(i);
          filtered         = displacement[i] + damping.mesh_viscosity * v;
          if (uniform)
            filtered += factor * memory;
          else
            w.local_element(i) = memory;
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
