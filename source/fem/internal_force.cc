#include <voussoir/fem/internal_force.h>

#include <chrono>
#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Calls run(material, cells) for the runs of batches of one material.
    template <typename Run>
    void
    for_each_run(const Discretization      &discretization,
                 const std::vector<double> &factors,
                 const unsigned int         first,
                 const unsigned int         last,
                 const Run                 &run,
                 Rounding                  *rounding         = nullptr,
                 const bool                 single_precision = false)
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
                        discretization.has_one_point(material),
                        factors[material],
                        discretization.reproducible,
                        rounding,
                        single_precision && !discretization.matrix_free
                                               .single_corners.expired()});
          begin = end;
        }
    }


    // Vectors whose ghost values arrive while cells are computed.
    using Sources = std::vector<Vector *>;

    using CellLoop =
      std::function<void(const dealii::MatrixFree<3, double, Lanes> &,
                         Vector &,
                         const Sources &,
                         const std::pair<unsigned int, unsigned int> &)>;


    // The library wants them not const, but changes their ghost values only.
    Sources
    sources(const std::vector<const Vector *> &vectors)
    {
      Sources result;
      for (const Vector *vector : vectors)
        result.push_back(const_cast<Vector *>(vector));
      return result;
    }


    // A cell loop: run(material, cells, dst) for the runs of batches of one
    // material.
    template <typename Run>
    CellLoop
    on_runs(const Discretization      &discretization,
            const std::vector<double> &factors,
            const Run                 &run,
            Rounding                  *rounding         = nullptr,
            const bool                 single_precision = false)
    {
      return
        [&,
         rounding,
         single_precision](const dealii::MatrixFree<3, double, Lanes> &,
                           Vector &dst,
                           const Sources &,
                           const std::pair<unsigned int, unsigned int> &range) {
          for_each_run(
            discretization,
            factors,
            range.first,
            range.second,
            [&](const unsigned int material, const CellRange &cells) {
              run(material, cells, dst);
            },
            rounding,
            single_precision);
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
    MaterialMemory memory(discretization, widths);
    for (unsigned int m = 0; m < kernels.size(); ++m)
      if (kernels[m]->cracks_along_planes() && discretization.has_one_point(m))
        memory.of(m)->make_planes();
    return memory;
  }


  double
  InternalForce::limit_of_forces(const double strain) const
  {
    double modulus = 0.;
    for (unsigned int m = 0; m < kernels.size(); ++m)
      modulus = std::max(modulus, factors[m] * kernels[m]->wave_modulus());
    return strain * modulus * discretization.longest_edge *
           discretization.longest_edge;
  }


  namespace
  {
    /** Largest owned entry of a rank, or @p enough if it is not below that. */
    double
    largest_entry(const Vector &vector, const double enough)
    {
      constexpr unsigned int at_once = 1024;
      const unsigned int     size    = vector.locally_owned_size();
      double                 largest = 0.;
      for (unsigned int first = 0; first < size && largest < enough;
           first += at_once)
        for (unsigned int i = first; i < std::min(first + at_once, size); ++i)
          largest = std::max(largest, std::abs(vector.local_element(i)));
      return std::min(largest, enough);
    }
  } // namespace


  double
  InternalForce::limit_of_sweep(const SweepInput &input) const
  {
    // beyond this strain linear kinematics do not hold
    constexpr double largest_strain = 1. / 16.;
    const double     limit          = limit_of_forces(largest_strain);
    if (input.bound == nullptr)
      return limit;

    // quanta of a strained cell are too coarse for a motion with little strain
    const double enough =
      std::ldexp(largest_strain * discretization.longest_edge, -20);
    const auto         &parts = input.bound->parts;
    std::vector<double> largest(parts.size());
    double              motion = 0.;
    for (unsigned int i = 0; i < parts.size() && motion < enough; ++i)
      if (const auto [vector, factor] = parts[i]; factor > 0.)
        {
          largest[i] = factor * largest_entry(*vector, enough / factor);
          motion += largest[i];
        }
    // each by itself: the sum of a rank depends on its cells
    Utilities::MPI::max(largest, discretization.grid.communicator(), largest);
    motion = std::accumulate(largest.begin(), largest.end(), 0.);
    if (motion >= enough)
      return limit;
    double s = 1.;
    for (const CellKernel *kernel : kernels)
      s = std::max(s, kernel->damping_factor());
    // |u_e| <= sqrt(24) max |u| ; fixed nodes, which have no mass here, have
    // stiffness like the others
    const double stiffness = 100. * input.bound->mass.linfty_norm() /
                             (input.bound->time_step * input.bound->time_step);
    return std::min(limit, stiffness * s * motion);
  }


  bool
  InternalForce::sweep(Vector           &force,
                       const SweepInput &input,
                       MaterialMemory   &memory,
                       const RangeWork  &before,
                       const RangeWork  &after,
                       double           *seconds) const
  {
    using Damping = SweepInput::Damping;
    const auto run =
      [&](const unsigned int material, const CellRange &cells, Vector &dst) {
        if (PointHistory *history = memory.of(material))
          kernels[material]->add_response(cells, input, dst, *history);
        else
          kernels[material]->add_force(cells, input, dst);
      };
    Rounding rounding(discretization.reproducible ? limit_of_sweep(input) : 0.);
    const CellLoop of_cells =
      on_runs(discretization,
              factors,
              run,
              discretization.reproducible ? &rounding : nullptr,
              input.single_precision);

    using Clock = std::chrono::steady_clock;
    std::chrono::duration<double> time_of_cells{};

    const CellLoop loop = [&](const auto    &matrix_free,
                              Vector        &dst,
                              const Sources &src,
                              const auto    &range) {
      const auto start = Clock::now();
      of_cells(matrix_free, dst, src, range);
      time_of_cells += Clock::now() - start;
    };

    // the initial value of a sum must be in quanta, too
    const auto begin_sums = [&](const unsigned int begin,
                                const unsigned int end) {
      before(begin, end);
      if (discretization.reproducible)
        rounding(force.begin() + begin, force.begin() + end);
    };

    std::vector<const Vector *> read{&input.filtered};
    if (input.damping != Damping::none && !memory.empty())
      read.push_back(&input.displacement);
    if (input.damping != Damping::by_material)
      discretization.matrix_free.cell_loop(
        loop, force, sources(read), begin_sums, after);
    else
      {
        begin_sums(0, force.locally_owned_size());
        read.push_back(input.damping_memory);
        discretization.matrix_free.cell_loop(
          loop, force, sources(read), {}, after);
      }
    if (seconds != nullptr)
      *seconds += time_of_cells.count();
    return !rounding.exceeded();
  }


  void
  InternalForce::apply(Vector &force, const SweepInput &input) const
  {
    std::vector<const Vector *> read{&input.filtered};
    if (input.damping == SweepInput::Damping::by_material)
      read.push_back(input.damping_memory);
    const auto run =
      [&](const unsigned int material, const CellRange &cells, Vector &dst) {
        kernels[material]->add_force(cells, input, dst);
      };
    const auto loop = [&](Rounding *rounding) {
      discretization.matrix_free.cell_loop(
        on_runs(discretization, factors, run, rounding, input.single_precision),
        force,
        sources(read),
        true);
    };
    if (!discretization.reproducible)
      loop(nullptr);
    else
      {
        const double longest = discretization.longest_edge;
        double       motion  = 0.;
        for (const Vector *vector : read)
          motion += vector->linfty_norm();
        force = 0.;
        for (bool exceeded = motion > 0.; exceeded; motion *= 256.)
          {
            Rounding rounding(limit_of_forces(motion / longest));
            loop(&rounding);
            exceeded =
              Utilities::MPI::logical_or(rounding.exceeded(),
                                         discretization.grid.communicator());
          }
      }
  }


  void
  InternalForce::apply(Vector &force, const Vector &displacement) const
  {
    apply(force, SweepInput::undamped(displacement));
  }


  void
  InternalForce::respond(Vector         &force,
                         const Vector   &displacement,
                         MaterialMemory &memory) const
  {
    sweep(force,
          SweepInput::undamped(displacement),
          memory,
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
                 factors,
                 0,
                 discretization.matrix_free.n_cell_batches(),
                 [&](const unsigned int material, const CellRange &cells) {
                   if (PointHistory *history = memory.of(material))
                     work(*kernels[material], cells, *history);
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
                         PointHistory     &history) {
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
                        PointHistory     &history) {
                       kernel.hand_over(cells, history);
                     });
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
                         PointHistory     &history) {
                       kernel.set_static_state(cells,
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
    const auto run =
      [&](const unsigned int material, const CellRange &cells, Vector &dst) {
        kernels[material]->add_thermal_force(cells, dst, temperature);
      };
    discretization.matrix_free.cell_loop(on_runs(discretization, factors, run),
                                         force,
                                         sources({&temperature}));
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
    for_each_run(
      discretization,
      factors,
      0,
      discretization.matrix_free.n_cell_batches(),
      [&](const unsigned int material, const CellRange &cells) {
        sum += evaluate(material, cells);
      },
      nullptr,
      discretization.single_precision);
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
                                                 motion,
                                                 memory.of(material));
      });
  }


  CellRange
  InternalForce::cells_of(const unsigned int batch) const
  {
    const unsigned int material = discretization.material_of_batch[batch];
    return {discretization.matrix_free,
            batch,
            batch + 1,
            discretization.has_one_point(material),
            factors[material]};
  }


  Lanes
  InternalForce::stabilisation_energy(const unsigned int  batch,
                                      const DampedMotion &motion,
                                      const PointHistory &history) const
  {
    return kernels[discretization.material_of_batch[batch]]
      ->stabilisation_energy(cells_of(batch), motion, history);
  }


  SplitStress
  InternalForce::elastic_stress(const unsigned int  batch,
                                const Vector       &displacement,
                                const PointHistory *history) const
  {
    return kernels[discretization.material_of_batch[batch]]->elastic_stress(
      cells_of(batch), displacement, history);
  }


  InelasticEnergy
  InternalForce::inelastic_energy(const Vector         &displacement,
                                  const MaterialMemory &memory,
                                  const InitialState   &initial,
                                  const Damping        &damping) const
  {
    const bool has_static_state = initial.displacement.size() > 0;
    std::vector<const Vector *> read{&displacement};
    if (has_static_state)
      read.push_back(&initial.displacement);
    return sum<InelasticEnergy>(
      read, [&](const unsigned int material, const CellRange &cells) {
        const PointHistory *history = memory.of(material);
        if (history == nullptr)
          return InelasticEnergy();
        return kernels[material]->inelastic_energy(cells,
                                                   {displacement,
                                                    has_static_state,
                                                    initial.displacement,
                                                    initial.material_memory.of(
                                                      material),
                                                    damping.branch_stiffness()},
                                                   *history);
      });
  }


  double
  InternalForce::elastic_work(const Vector         &u,
                              const Vector         &v,
                              const MaterialMemory &memory,
                              const bool            by_damping_factor) const
  {
    const double of_rank =
      sum<double>({&u, &v},
                  [&](const unsigned int material, const CellRange &cells) {
                    const CellKernel &kernel = *kernels[material];
                    return (by_damping_factor ? kernel.damping_factor() : 1.) *
                           kernel.work(cells, u, v, memory.of(material));
                  });
    return Utilities::MPI::sum(of_rank, discretization.grid.communicator());
  }


  Lanes
  InternalForce::element_eigenvalues(const unsigned int          batch,
                                     const AlignedVector<Lanes> &masses) const
  {
    return kernels[discretization.material_of_batch[batch]]
      ->element_eigenvalues(cells_of(batch), masses);
  }
} // namespace Voussoir
