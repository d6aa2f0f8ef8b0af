#include <voussoir/fem/internal_force.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Calls run(material, begin, end) for the runs of batches of one material.
    template <typename Run>
    void
    for_each_run(const std::vector<unsigned int> &material_of_batch,
                 const unsigned int               first,
                 const unsigned int               last,
                 const Run                       &run)
    {
      for (unsigned int begin = first; begin < last;)
        {
          unsigned int end = begin + 1;
          while (end < last &&
                 material_of_batch[end] == material_of_batch[begin])
            ++end;
          run(material_of_batch[begin], begin, end);
          begin = end;
        }
    }


    using CellLoop =
      std::function<void(const Discretization::MatrixFree &,
                         Vector &,
                         const Vector &,
                         const std::pair<unsigned int, unsigned int> &)>;

    // What a cell loop does: run(matrix_free, dst, src, material, begin, end)
    // for the runs of batches of one material.
    template <typename Run>
    CellLoop
    on_runs(const std::vector<unsigned int> &material_of_batch, const Run &run)
    {
      return [&](const Discretization::MatrixFree            &matrix_free,
                 Vector                                      &dst,
                 const Vector                                &src,
                 const std::pair<unsigned int, unsigned int> &range) {
        for_each_run(material_of_batch,
                     range.first,
                     range.second,
                     [&](const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
                       run(matrix_free, dst, src, material, begin, end);
                     });
      };
    }
  } // namespace


  InternalForce::InternalForce(const Discretization &discretization,
                               const std::vector<const CellKernel *> &kernels)
    : discretization(discretization)
    , kernels(kernels)
  {
    for (unsigned int m = 0; m < kernels.size(); ++m)
      histories.emplace_back(discretization, m, kernels[m]->n_history());
  }


  bool
  InternalForce::uniform_damping() const
  {
    for (const CellKernel *kernel : kernels)
      if (kernel->damping_factor() != kernels[0]->damping_factor())
        return false;
    return true;
  }


  double
  InternalForce::damping_factor() const
  {
    return kernels[0]->damping_factor();
  }


  void
  InternalForce::sweep(Vector          &force,
                       const Vector    &displacement,
                       const Vector    *memory,
                       const Vector    &undamped,
                       const double     time_step,
                       const RangeWork &before,
                       const RangeWork &after)
  {
    const auto run = [&](const auto        &matrix_free,
                         Vector            &dst,
                         const Vector      &src,
                         const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
      if (uses_memory && !histories[material].empty())
        kernels[material]->add_response(matrix_free,
                                        dst,
                                        src,
                                        memory,
                                        undamped,
                                        begin,
                                        end,
                                        histories[material],
                                        time_step);
      else
        kernels[material]->add_force(matrix_free, dst, src, memory, begin, end);
    };
    const CellLoop cells = on_runs(discretization.material_of_batch, run);

    // The library overlaps the exchange of one source vector with the cell
    // work; the others are exchanged beforehand.
    const bool reads_undamped =
      &undamped != &displacement && uses_memory && has_memory();
    if (reads_undamped)
      undamped.update_ghost_values();
    if (memory == nullptr)
      discretization.matrix_free.cell_loop(
        cells, force, displacement, before, after);
    else
      {
        before(0, force.locally_owned_size());
        memory->update_ghost_values();
        discretization.matrix_free.cell_loop(
          cells, force, displacement, {}, after);
        memory->zero_out_ghost_values();
      }
    if (reads_undamped)
      undamped.zero_out_ghost_values();
  }


  void
  InternalForce::apply(Vector       &force,
                       const Vector &displacement,
                       const Vector *memory) const
  {
    if (memory != nullptr)
      memory->update_ghost_values();
    const auto run = [&](const auto        &matrix_free,
                         Vector            &dst,
                         const Vector      &src,
                         const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
      kernels[material]->add_force(matrix_free, dst, src, memory, begin, end);
    };
    discretization.matrix_free.cell_loop(
      on_runs(discretization.material_of_batch, run),
      force,
      displacement,
      true);
    if (memory != nullptr)
      memory->zero_out_ghost_values();
  }


  void
  InternalForce::respond(Vector &force, const Vector &displacement)
  {
    sweep(force,
          displacement,
          nullptr,
          displacement,
          // the laws follow at once
          std::numeric_limits<double>::max(),
          [&](const unsigned int begin, const unsigned int end) {
            std::fill(force.begin() + begin, force.begin() + end, 0.);
          },
          {});
  }


  bool
  InternalForce::has_memory() const
  {
    return std::any_of(kernels.begin(), kernels.end(), [](const auto *kernel) {
      return kernel->n_history() > 0;
    });
  }


  void
  InternalForce::set_static_state(const Vector &displacement,
                                  const Vector &temperature)
  {
    if (displacement.size() == 0)
      return;
    displacement.update_ghost_values();
    temperature.update_ghost_values();
    for_each_run(discretization.material_of_batch,
                 0,
                 discretization.matrix_free.n_cell_batches(),
                 [&](const unsigned int material,
                     const unsigned int begin,
                     const unsigned int end) {
                   PointHistory &history = histories[material];
                   if (history.empty())
                     return;
                   if (!history.has_offset)
                     history.make_offsets();
                   kernels[material]->set_offset(discretization.matrix_free,
                                                 history,
                                                 displacement,
                                                 temperature,
                                                 begin,
                                                 end);
                 });
    displacement.zero_out_ghost_values();
    temperature.zero_out_ghost_values();
  }


  void
  InternalForce::add_thermal_force(Vector       &force,
                                   const Vector &temperature) const
  {
    const auto run = [&](const auto        &matrix_free,
                         Vector            &dst,
                         const Vector      &src,
                         const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
      kernels[material]->add_thermal_force(matrix_free, dst, src, begin, end);
    };
    discretization.matrix_free.cell_loop(
      on_runs(discretization.material_of_batch, run), force, temperature);
  }


  double
  InternalForce::sum(
    const std::vector<const Vector *>               &read,
    const std::function<double(const unsigned int,
                               const unsigned int,
                               const unsigned int)> &evaluate) const
  {
    for (const Vector *vector : read)
      if (!vector->has_ghost_elements())
        vector->update_ghost_values();
    double sum = 0.;
    for_each_run(discretization.material_of_batch,
                 0,
                 discretization.matrix_free.n_cell_batches(),
                 [&](const unsigned int material,
                     const unsigned int begin,
                     const unsigned int end) {
                   sum += evaluate(material, begin, end);
                 });
    for (const Vector *vector : read)
      vector->zero_out_ghost_values();
    return Utilities::MPI::sum(sum, discretization.grid.communicator());
  }


  double
  InternalForce::stored_energy(const Vector &displacement,
                               const Vector &u_static,
                               const Vector &moved,
                               const Vector &moved_before) const
  {
    std::vector<const Vector *> read{&displacement, &moved, &moved_before};
    if (u_static.size() > 0)
      read.push_back(&u_static);
    return sum(read,
               [&](const unsigned int material,
                   const unsigned int begin,
                   const unsigned int end) {
                 const CellKernel   &kernel  = *kernels[material];
                 const PointHistory &history = histories[material];
                 double              energy =
                   0.5 * kernel.work(discretization.matrix_free,
                                     moved,
                                     moved_before,
                                     begin,
                                     end,
                                     history,
                                     CellKernel::Inelastic::not_at_all);
                 if (!history.empty())
                   energy += kernel.inelastic_energy(discretization.matrix_free,
                                                     history,
                                                     displacement,
                                                     u_static,
                                                     begin,
                                                     end);
                 return energy;
               });
  }


  double
  InternalForce::dissipated() const
  {
    double energy = 0.;
    for (const PointHistory &history : histories)
      energy += history.dissipated;
    return energy;
  }


  double
  InternalForce::damping_work(const Vector &u, const Vector &v) const
  {
    return sum({&u, &v},
               [&](const unsigned int material,
                   const unsigned int begin,
                   const unsigned int end) {
                 const CellKernel &kernel = *kernels[material];
                 return kernel.damping_factor() *
                        kernel.work(discretization.matrix_free,
                                    u,
                                    v,
                                    begin,
                                    end,
                                    histories[material],
                                    CellKernel::Inelastic::by_damping_share);
               });
  }
} // namespace Voussoir
