#include <voussoir/fem/internal_force.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Calls run(material, cells) for the runs of batches of one material.
    template <typename Run>
    void
    for_each_run(const Discretization &discretization,
                 const unsigned int    first,
                 const unsigned int    last,
                 const Run            &run)
    {
      const auto &material_of_batch = discretization.material_of_batch;
      for (unsigned int begin = first; begin < last;)
        {
          unsigned int end = begin + 1;
          while (end < last &&
                 material_of_batch[end] == material_of_batch[begin])
            ++end;
          const unsigned int material = material_of_batch[begin];
          run(material,
              CellRange{discretization.matrix_free,
                        begin,
                        end,
                        discretization.has_one_point(material)});
          begin = end;
        }
    }


    using CellLoop =
      std::function<void(const Discretization::MatrixFree &,
                         Vector &,
                         const Vector &,
                         const std::pair<unsigned int, unsigned int> &)>;

    // What a cell loop does: run(material, cells, dst, src) for the runs of
    // batches of one material.
    template <typename Run>
    CellLoop
    on_runs(const Discretization &discretization, const Run &run)
    {
      return [&](const Discretization::MatrixFree &,
                 Vector                                      &dst,
                 const Vector                                &src,
                 const std::pair<unsigned int, unsigned int> &range) {
        for_each_run(discretization,
                     range.first,
                     range.second,
                     [&](const unsigned int material, const CellRange &cells) {
                       run(material, cells, dst, src);
                     });
      };
    }
  } // namespace


  InternalForce::InternalForce(const Discretization &discretization,
                               const std::vector<const CellKernel *> &kernels,
                               const std::vector<double>             &factors)
    : discretization(discretization)
    , kernels(kernels)
    , factors(factors)
  {}


  InternalForce
  InternalForce::with(const std::vector<double> &other_factors) const
  {
    return {discretization, kernels, other_factors};
  }


  double
  InternalForce::factor_of(const unsigned int material) const
  {
    return factors[material];
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


  bool
  InternalForce::has_memory() const
  {
    return std::any_of(kernels.begin(), kernels.end(), [](const auto *kernel) {
      return kernel->n_history() > 0;
    });
  }


  MaterialMemory
  InternalForce::new_memory() const
  {
    std::vector<unsigned int> widths;
    for (const CellKernel *kernel : kernels)
      widths.push_back(kernel->n_history());
    return {discretization, widths};
  }


  void
  InternalForce::sweep(Vector          &force,
                       const Vector    &displacement,
                       const Vector    *damping_memory,
                       const Vector    &undamped,
                       MaterialMemory  &memory,
                       const PointStep &step,
                       const RangeWork &before,
                       const RangeWork &after) const
  {
    const auto run = [&](const unsigned int material,
                         const CellRange   &cells,
                         Vector            &dst,
                         const Vector      &src) {
      if (PointHistory *history = memory.of(material))
        kernels[material]->add_response(cells,
                                        factors[material],
                                        dst,
                                        src,
                                        damping_memory,
                                        undamped,
                                        *history,
                                        step);
      else
        kernels[material]->add_force(
          cells, factors[material], dst, src, damping_memory);
    };
    const CellLoop loop = on_runs(discretization, run);

    // The library overlaps the exchange of one source vector with the cell
    // work; the others are exchanged beforehand.
    const bool reads_undamped = &undamped != &displacement && !memory.empty();
    if (reads_undamped)
      undamped.update_ghost_values();
    if (damping_memory == nullptr)
      discretization.matrix_free.cell_loop(
        loop, force, displacement, before, after);
    else
      {
        before(0, force.locally_owned_size());
        damping_memory->update_ghost_values();
        discretization.matrix_free.cell_loop(
          loop, force, displacement, {}, after);
        damping_memory->zero_out_ghost_values();
      }
    if (reads_undamped)
      undamped.zero_out_ghost_values();
  }


  void
  InternalForce::apply(Vector       &force,
                       const Vector &displacement,
                       const Vector *damping_memory) const
  {
    if (damping_memory != nullptr)
      damping_memory->update_ghost_values();
    const auto run = [&](const unsigned int material,
                         const CellRange   &cells,
                         Vector            &dst,
                         const Vector      &src) {
      kernels[material]->add_force(
        cells, factors[material], dst, src, damping_memory);
    };
    discretization.matrix_free.cell_loop(on_runs(discretization, run),
                                         force,
                                         displacement,
                                         true);
    if (damping_memory != nullptr)
      damping_memory->zero_out_ghost_values();
  }


  void
  InternalForce::respond(Vector         &force,
                         const Vector   &displacement,
                         MaterialMemory &memory) const
  {
    sweep(force,
          displacement,
          nullptr,
          displacement,
          memory,
          // the laws follow at once
          {std::numeric_limits<double>::max()},
          [&](const unsigned int begin, const unsigned int end) {
            std::fill(force.begin() + begin, force.begin() + end, 0.);
          },
          {});
  }


  template <typename Work>
  void
  InternalForce::for_each_history(MaterialMemory &memory,
                                  const Work     &work) const
  {
    for_each_run(discretization,
                 0,
                 discretization.matrix_free.n_cell_batches(),
                 [&](const unsigned int material, const CellRange &cells) {
                   if (PointHistory *history = memory.of(material))
                     work(*kernels[material],
                          cells,
                          *history,
                          factors[material]);
                 });
  }


  void
  InternalForce::make_static_strains(MaterialMemory &memory) const
  {
    for (unsigned int m = 0; m < kernels.size(); ++m)
      if (PointHistory *history = memory.of(m))
        history->make_static_strains();
  }


  void
  InternalForce::set_thermal_strain(const Vector   &temperature,
                                    MaterialMemory &memory) const
  {
    temperature.update_ghost_values();
    make_static_strains(memory);
    for_each_history(memory,
                     [&](const CellKernel &kernel,
                         const CellRange  &cells,
                         PointHistory     &history,
                         const double) {
                       kernel.set_thermal_strain(cells, history, temperature);
                     });
    temperature.zero_out_ghost_values();
  }


  void
  InternalForce::hand_over(MaterialMemory &memory) const
  {
    for_each_history(memory,
                     [](const CellKernel &kernel,
                        const CellRange  &cells,
                        PointHistory     &history,
                        const double) { kernel.hand_over(cells, history); });
  }


  void
  InternalForce::set_static_state(const Vector   &displacement,
                                  const Vector   &temperature,
                                  MaterialMemory &memory) const
  {
    if (displacement.size() == 0)
      return;
    displacement.update_ghost_values();
    temperature.update_ghost_values();
    make_static_strains(memory);
    for_each_history(memory,
                     [&](const CellKernel &kernel,
                         const CellRange  &cells,
                         PointHistory     &history,
                         const double      stress_factor) {
                       kernel.set_static_state(cells,
                                               stress_factor,
                                               history,
                                               displacement,
                                               temperature);
                     });
    displacement.zero_out_ghost_values();
    temperature.zero_out_ghost_values();
  }


  void
  InternalForce::add_thermal_force(Vector       &force,
                                   const Vector &temperature) const
  {
    const auto run = [&](const unsigned int material,
                         const CellRange   &cells,
                         Vector            &dst,
                         const Vector      &src) {
      kernels[material]->add_thermal_force(cells, factors[material], dst, src);
    };
    discretization.matrix_free.cell_loop(on_runs(discretization, run),
                                         force,
                                         temperature);
  }


  template <typename Sum>
  Sum
  InternalForce::sum(
    const std::vector<const Vector *>                               &read,
    const std::function<Sum(const unsigned int, const CellRange &)> &evaluate)
    const
  {
    for (const Vector *vector : read)
      if (!vector->has_ghost_elements())
        vector->update_ghost_values();
    Sum sum{};
    for_each_run(discretization,
                 0,
                 discretization.matrix_free.n_cell_batches(),
                 [&](const unsigned int material, const CellRange &cells) {
                   sum += evaluate(material, cells);
                 });
    for (const Vector *vector : read)
      vector->zero_out_ghost_values();
    return sum;
  }


  ElasticEnergy
  InternalForce::elastic_energy(const DampedMotion &motion,
                                MaterialMemory     &memory) const
  {
    std::vector<const Vector *> read{&motion.displacement,
                                     &motion.velocity,
                                     &motion.velocity_before};
    for (const Vector &branch : motion.memory)
      read.push_back(&branch);
    return sum<ElasticEnergy>(
      read, [&](const unsigned int material, const CellRange &cells) {
        return kernels[material]->elastic_energy(cells,
                                                 factors[material],
                                                 motion,
                                                 memory.of(material));
      });
  }


  InelasticEnergy
  InternalForce::inelastic_energy(const Vector         &displacement,
                                  const MaterialMemory &memory,
                                  const InitialState   &initial,
                                  const Damping        &damping) const
  {
    std::vector<const Vector *> read{&displacement};
    if (initial.displacement.size() > 0)
      read.push_back(&initial.displacement);
    return sum<InelasticEnergy>(
      read, [&](const unsigned int material, const CellRange &cells) {
        const PointHistory *history = memory.of(material);
        if (history == nullptr)
          return InelasticEnergy();
        return kernels[material]->inelastic_energy(cells,
                                                   factors[material],
                                                   damping.branch_stiffness(),
                                                   *history,
                                                   displacement,
                                                   initial.material_memory.of(
                                                     material),
                                                   initial.displacement);
      });
  }


  double
  InternalForce::elastic_work(const Vector         &u,
                              const Vector         &v,
                              const MaterialMemory &memory,
                              const bool            by_damping_factor) const
  {
    const double of_rank = sum<double>(
      {&u, &v}, [&](const unsigned int material, const CellRange &cells) {
        const CellKernel &kernel = *kernels[material];
        return (by_damping_factor ? kernel.damping_factor() : 1.) *
               kernel.work(cells, factors[material], u, v, memory.of(material));
      });
    return Utilities::MPI::sum(of_rank, discretization.grid.communicator());
  }


  Lanes
  InternalForce::element_eigenvalues(const unsigned int          batch,
                                     const AlignedVector<Lanes> &masses) const
  {
    const unsigned int material = discretization.material_of_batch[batch];
    return kernels[material]->element_eigenvalues({discretization.matrix_free,
                                                   batch,
                                                   batch + 1,
                                                   discretization.has_one_point(
                                                     material)},
                                                  factors[material],
                                                  masses);
  }
} // namespace Voussoir
