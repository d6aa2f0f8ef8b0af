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
  } // namespace


  InternalForce::InternalForce(const Discretization &discretization,
                               const std::vector<const CellKernel *> &kernels)
    : discretization(discretization)
    , kernels(kernels)
  {}


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
                       const RangeWork &before,
                       const RangeWork &after) const
  {
    const std::function<void(const Discretization::MatrixFree &,
                             Vector &,
                             const Vector &,
                             const std::pair<unsigned int, unsigned int> &)>
      cells = [&](const Discretization::MatrixFree            &matrix_free,
                  Vector                                      &dst,
                  const Vector                                &src,
                  const std::pair<unsigned int, unsigned int> &range) {
        for_each_run(discretization.material_of_batch,
                     range.first,
                     range.second,
                     [&](const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
                       kernels[material]->add_force(
                         matrix_free, dst, src, memory, begin, end);
                     });
      };

    // The library overlaps the exchange of one source vector with the cell
    // work; a second one is exchanged beforehand.
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
  }


  void
  InternalForce::apply(Vector &force, const Vector &displacement) const
  {
    sweep(force,
          displacement,
          nullptr,
          [&](const unsigned int begin, const unsigned int end) {
            std::fill(force.begin() + begin, force.begin() + end, 0.);
          },
          {});
  }


  void
  InternalForce::add_thermal_force(Vector       &force,
                                   const Vector &temperature) const
  {
    discretization.matrix_free.cell_loop<Vector, Vector>(
      [&](const auto                                  &matrix_free,
          Vector                                      &dst,
          const Vector                                &src,
          const std::pair<unsigned int, unsigned int> &range) {
        for_each_run(discretization.material_of_batch,
                     range.first,
                     range.second,
                     [&](const unsigned int material,
                         const unsigned int begin,
                         const unsigned int end) {
                       kernels[material]->add_thermal_force(
                         matrix_free, dst, src, begin, end);
                     });
      },
      force,
      temperature);
  }


  double
  InternalForce::work(const Vector &u,
                      const Vector &v,
                      const bool    with_damping_factors) const
  {
    u.update_ghost_values();
    if (&u != &v)
      v.update_ghost_values();
    double sum = 0.;
    for_each_run(
      discretization.material_of_batch,
      0,
      discretization.matrix_free.n_cell_batches(),
      [&](const unsigned int material,
          const unsigned int begin,
          const unsigned int end) {
        sum +=
          (with_damping_factors ? kernels[material]->damping_factor() : 1.) *
          kernels[material]->work(discretization.matrix_free, u, v, begin, end);
      });
    u.zero_out_ghost_values();
    if (&u != &v)
      v.zero_out_ghost_values();
    return Utilities::MPI::sum(sum, discretization.grid.communicator());
  }
} // namespace Voussoir
