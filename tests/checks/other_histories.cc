#include "check.h"
#include "csv_table.h"
#include "histories.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Displacements at points over the whole run against the table of another
     * program: times, then x, y and z of each point, with the motion of a rigid
     * base. tests/data/arch_dam_newmark.py computes the reference.
     */
    class OtherHistories : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Points", points, "Named points of the table.");
        prm.add_parameter("Table", table, "Relative to the parameter file.");
        prm.add_parameter("Tolerance", tolerance, "Difference over peak.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto motion     = parameters->ground_motion.build(file.folder());
        const bool moves_base =
          parameters->wave.enters_through == WaveEntrance::rigid_base;
        const CsvTable other(file.folder() + "/" + table);
        const auto     places    = parse_points(points, "\"Points\"");
        const auto     histories = run_and_record(*simulation, places);
        const auto    &times     = histories.times;

        for (unsigned int p = 0; p < places.size(); ++p)
          for (unsigned int d = 0; d < 3; ++d)
            {
              double error = 0., peak = 0.;
              for (std::size_t i = 1; i < other.lines.size(); ++i)
                {
                  const double t     = std::stod(other.lines[i].at(0));
                  const auto   after = std::size_t(
                    std::lower_bound(times.begin(), times.end(), t - 1e-9) -
                    times.begin());
                  if (after == 0 || after == times.size())
                    continue;
                  const double share =
                    (t - times[after - 1]) / (times[after] - times[after - 1]);
                  const double value =
                    (1. - share) * histories.displacement[p][after - 1][d] +
                    share * histories.displacement[p][after][d] +
                    (moves_base ? motion[d]->displacement(t) : 0.);
                  const double reference =
                    std::stod(other.lines[i].at(1 + 3 * p + d));
                  keep_largest(peak, std::abs(reference));
                  keep_largest(error, std::abs(value - reference));
                }
              std::ostringstream name;
              name << places[p].name << ", "
                   << "xyz"[d] << ": difference over peak";
              verdicts.below(name.str(), error / peak, tolerance);
            }
      }

    private:
      std::string points, table;
      double      tolerance = 0.02;
    };

    // Reference: other program
    const Registry<Check>::Add<OtherHistories>
      registered("histories of another program",
                 "Displacements over time against a table.");
  } // namespace
} // namespace Voussoir
