#include "crack_line.h"

#include <deque>
#include <filesystem>

#include "check.h"
#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  double
  angle_of_cracks(const Simulation                            &simulation,
                  const std::function<bool(const Point<3> &)> &counts)
  {
    const Solid                             &solid = simulation.model.solid;
    std::vector<std::pair<Point<3>, double>> cracks;
    double                                   widest = 0.;
    for (unsigned int m = 0; m < solid.materials.size(); ++m)
      {
        const PointHistory *history =
          simulation.run.state.material_memory.of(m);
        if (history == nullptr)
          continue;
        for (const auto &[cell, place] : history->cells())
          if (const double band = history->band(place, 0);
              band > 0. && counts(cell->center()))
            {
              const double opening =
                solid.materials[m]->outputs(history->read(place, 0).data(),
                                            band)[2];
              Point<3> point;
              for (unsigned int d = 0; d < 3; ++d)
                point[d] = history->planes_of(place.batch).point[d][place.lane];
              cracks.emplace_back(point, opening);
              keep_largest(widest, opening);
            }
      }
    double w = 0., x = 0., z = 0., xx = 0., xz = 0.;
    for (const auto &[point, opening] : cracks)
      if (!(opening < 0.05 * widest))
        {
          const double weight = std::sqrt(opening);
          w += weight;
          x += weight * point[0];
          z += weight * point[2];
          xx += weight * point[0] * point[0];
          xz += weight * point[0] * point[2];
        }
    return std::atan((w * xz - x * z) / (w * xx - x * x)) * 180. / numbers::PI;
  }


  Pull
  march_under_pull(Simulation &simulation, const double window)
  {
    Run                            &run = simulation.run;
    const std::vector<unsigned int> pulled =
      run.equation.projections[0]->nodes();
    const unsigned int steps = std::ceil(window / run.time_step.length);
    Pull               pull{0., 0.};
    double             sum = 0.;
    std::deque<double> forces;
    while (run.state.step < run.n_steps())
      {
        run.scheme.step(run.state);
        double force = 0.;
        for (const unsigned int node : pulled)
          force += run.scheme.support_force(run.state, node)[2];
        force =
          Utilities::MPI::sum(force, simulation.run.model.grid.communicator());
        forces.push_back(force);
        sum += force;
        if (forces.size() > steps)
          {
            sum -= forces.front();
            forces.pop_front();
          }
        pull.last = std::abs(sum) / steps;
        keep_largest(pull.largest, pull.last);
      }
    return pull;
  }


  std::string
  entry_of_mesh(const std::string                              &name,
                const std::function<void(const std::string &)> &write,
                const MPI_Comm                                  communicator)
  {
    const std::string file = std::filesystem::current_path() / name;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      write(file);
    MPI_Barrier(communicator);
    return "Mesh/file/File=" + file;
  }


  double
  largest_standing_pull(const ParameterFile &file,
                        const std::string   &mesh_entry,
                        const double         first,
                        const double         step,
                        const MPI_Comm       communicator)
  {
    double stress = first;
    while (
      stands(file.with({mesh_entry,
                        vector_entry("Loads/pull/Traction",
                                     Tensor<1, 3>({0., 0., 1e6 * stress}))}),
             communicator))
      stress += step;
    return stress - 0.5 * step;
  }


  double
  fastest_in_steps(Run &run)
  {
    double fastest = 0.;
    for (unsigned int i = 0; i < 200; ++i)
      {
        run.scheme.step(run.state);
        keep_largest(fastest, largest_entry(run.state.velocity));
      }
    return fastest;
  }
} // namespace Voussoir
