#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/lanczos.h>
#include <voussoir/fem/stable_step.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A start vector that is the same on any number of ranks and has a part in
    // every mode.
    void
    fill_start(const Discretization &discretization, Vector &vector)
    {
      for (unsigned int node = 0; node < discretization.n_owned_nodes(); ++node)
        {
          const Point<3> &p = discretization.node_positions[node];
          for (unsigned int d = 0; d < 3; ++d)
            vector.local_element(3 * node + d) =
              std::sin(1e3 * p[0] + 2e3 * p[1] + 3e3 * p[2] + 1.7 * d);
        }
    }


    /**
     * The dt at which limit(dt) = dt, or just below. The ratio (dt/limit)^2 is
     * dt^2 times an eigenvalue over 4, and grows with dt, at least in
     * proportion. So if it is below one at dt, it is above one at limit^2/dt,
     * and vice versa: each limit bounds the dt from both sides.
     *
     * @param dt the first to try
     */
    double
    fixed_point(double dt, const std::function<double(const double)> &limit)
    {
      constexpr double tolerance = 1e-5;
      double lower = 0., upper = std::numeric_limits<double>::infinity(),
             last = 0., last_distance = 0.;
      while (upper > (1. + tolerance) * lower)
        {
          const double reached = limit(dt);
          lower = std::max(lower, std::min(dt, reached * reached / dt));
          upper = std::min(upper, std::max(dt, reached * reached / dt));

          // secant of the logarithms, or bisection
          const double distance = std::log(reached / dt);
          const double slope =
            last > 0. ? (distance - last_distance) / std::log(dt / last) : -1.;
          const double next = dt * std::exp(-distance / slope);
          last              = dt;
          last_distance     = distance;
          dt = next > lower && next < upper ? next : std::sqrt(lower * upper);
        }
      return lower;
    }
  } // namespace


  double
  stable_step(const Discretization &discretization,
              const InternalForce  &force,
              const LumpedMass     &mass,
              const StepLimits     &limits)
  {
    Vector memory = discretization.create_vector(), start(memory),
           stiffer(memory);
    fill_start(discretization, start);
    const auto limit = [&](const double dt) {
      const double gamma = limits.stiffening ? limits.stiffening(dt) : 0.;
      const auto   apply = [&](Vector &dst, const Vector &src) {
        memory.equ(gamma, src);
        stiffer.equ(1. + 2. * limits.mesh_viscosity / dt, src);
        force.apply(dst,
                    {src, stiffer, SweepInput::Damping::by_material, &memory});
        if (limits.add_diagonal)
          limits.add_diagonal(dst, src, dt);
      };
      return 2. / std::sqrt(largest_eigenvalue(
                    start, mass.inverse, apply, discretization.reproducible));
    };
    const double first = limits.guess > 0. ?
                           limits.guess :
                           limit(std::numeric_limits<double>::max());
    return limits.depend_on_step() ? fixed_point(first, limit) : first;
  }


  ElementSteps::ElementSteps(const Discretization      &discretization,
                             const InternalForce       &force,
                             const std::vector<double> &density)
    : smallest(std::numeric_limits<double>::max())
  {
    const auto         &matrix_free = discretization.matrix_free;
    const unsigned int  n_batches   = matrix_free.n_cell_batches();
    NodalVolumes        nodal_volumes(discretization);
    std::vector<double> steps;
    const unsigned int  n_nodes =
      discretization.fe.base_element(0).n_dofs_per_cell();
    AlignedVector<Lanes> masses(n_nodes);
    const auto          &lexicographic =
      matrix_free.get_shape_info().lexicographic_numbering;
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        const unsigned int material = discretization.material_of_batch[batch];
        const unsigned int n_lanes =
          matrix_free.n_active_entries_per_cell_batch(batch);
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            const auto &volumes = nodal_volumes.of(
              matrix_free.get_cell_iterator(batch,
                                            std::min(lane, n_lanes - 1)));
            // numbered by component in lexicographic_numbering: its first
            // n_nodes entries are those of the first component
            for (unsigned int i = 0; i < n_nodes; ++i)
              masses[i][lane] =
                density[material] *
                volumes[discretization.fe
                          .system_to_component_index(lexicographic[i])
                          .second];
          }
        const Lanes rates = force.element_eigenvalues(batch, masses);
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          {
            const double step = 2. / std::sqrt(rates[lane]);
            steps.push_back(step);
            if (step < smallest)
              {
                smallest        = step;
                const auto cell = matrix_free.get_cell_iterator(batch, lane);
                place           = cell->center();
                sets            = join(discretization.grid.sets_of(cell), ", ");
              }
          }
      }

    // the first rank prints for the rank that owns the governing cell
    const MPI_Comm communicator = discretization.grid.communicator();
    const auto     all          = Utilities::MPI::all_gather(
      communicator,
      std::make_tuple(smallest, place[0], place[1], place[2], sets));
    const auto least =
      *std::min_element(all.begin(),
                        all.end(),
                        [](const auto &a, const auto &b) {
                          return std::get<0>(a) < std::get<0>(b);
                        });
    smallest = std::get<0>(least);
    place =
      Point<3>(std::get<1>(least), std::get<2>(least), std::get<3>(least));
    sets = std::get<4>(least);

    // bins of 25 % width each
    histogram.resize(12);
    for (const double step : steps)
      ++histogram[std::min<std::size_t>(
        histogram.size() - 1, std::log(step / smallest) / std::log(1.25))];
    histogram = sum_over_ranks(histogram, communicator);
  }


  void
  ElementSteps::print(std::ostream &out) const
  {
    unsigned long long largest = 1;
    for (const auto count : histogram)
      largest = std::max(largest, count);
    out << "Largest stable step of each cell by itself, undamped:\n";
    for (unsigned int bin = 0; bin < histogram.size(); ++bin)
      if (histogram[bin] > 0)
        out << "  " << (bin + 1 < histogram.size() ? "      " : "above ")
            << std::setw(9) << std::setprecision(3) << std::scientific
            << smallest * std::pow(1.25, bin) << " s  " << std::setw(9)
            << histogram[bin] << "  "
            << std::string((50 * histogram[bin] + largest - 1) / largest, '*')
            << '\n';
    out << std::defaultfloat << std::setprecision(4)
        << "  governed by the cell at (" << place << ") m in " << sets << '\n';
  }
} // namespace Voussoir
