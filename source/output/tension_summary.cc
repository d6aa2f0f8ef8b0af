#include <voussoir/output/tension_summary.h>

namespace Voussoir
{
  using namespace dealii;

  void
  TensionSummary::add(const StressExtremes &extremes,
                      const Point<3>       &where,
                      const double          volume,
                      const bool            beside_another)
  {
    if (extremes[0] > most.stress)
      most = {extremes[0], extremes[2], where};
    if (!beside_another)
      away = std::max(away, extremes[0]);
    cells.push_back(extremes[0]);
    cells.push_back(volume);
  }


  nlohmann::json
  TensionSummary::json(const MPI_Comm communicator) const
  {
    Cell largest = most;
    for (const Cell &one : Utilities::MPI::all_gather(communicator, most))
      if (one.stress > largest.stress)
        largest = one;
    nlohmann::json result{
      {"largest principal stress [MPa]", 1e-6 * largest.stress},
      {"at the time [s]", largest.time},
      {"in the cell at [m]",
       {largest.where[0], largest.where[1], largest.where[2]}},
      {"not exceeded in 95 % of the volume [MPa]",
       1e-6 * percentile(communicator)}};
    const double elsewhere = Utilities::MPI::max(away, communicator);
    if (elsewhere > nothing)
      result["in cells that touch no other material [MPa]"] = 1e-6 * elsewhere;
    return result;
  }


  double
  TensionSummary::percentile(const MPI_Comm communicator) const
  {
    const auto volume_above = [&](const double stress) {
      double volume = 0.;
      for (std::size_t i = 0; i < cells.size(); i += 2)
        if (cells[i] > stress)
          volume += cells[i + 1];
      return Utilities::MPI::sum(volume, communicator);
    };
    const double volume = volume_above(nothing);
    double       lower = -nothing, upper = nothing;
    for (std::size_t i = 0; i < cells.size(); i += 2)
      {
        lower = std::min(lower, cells[i]);
        upper = std::max(upper, cells[i]);
      }
    lower                  = Utilities::MPI::min(lower, communicator);
    upper                  = Utilities::MPI::max(upper, communicator);
    constexpr double share = 0.05;
    for (unsigned int i = 0; i < 50 && lower < upper; ++i)
      {
        const double middle = lower + 0.5 * (upper - lower);
        (volume_above(middle) <= share * volume ? upper : lower) = middle;
      }
    double of_cell = nothing;
    for (std::size_t i = 0; i < cells.size(); i += 2)
      if (cells[i] <= upper)
        of_cell = std::max(of_cell, cells[i]);
    return Utilities::MPI::max(of_cell, communicator);
  }
} // namespace Voussoir
