#ifndef voussoir_output_tension_summary_h
#define voussoir_output_tension_summary_h

#include <voussoir/output/stress_envelope.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** The largest tension of the cells of a material, for the summary. */
  class TensionSummary
  {
  public:
    void
    add(const StressExtremes   &extremes,
        const dealii::Point<3> &where,
        const double            volume,
        const bool              beside_another);

    /** All ranks must call this together. */
    nlohmann::json
    json(const MPI_Comm communicator) const;

  private:
    static constexpr double nothing = -std::numeric_limits<double>::max();

    struct Cell
    {
      double           stress = nothing, time = 0.;
      dealii::Point<3> where;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &stress &time &where;
      }
    };

    /** The least stress of a cell that is exceeded in at most 5 % of the
     *  volume. Found by bisection, so that no rank stores the cells of all
     *  ranks. */
    double
    percentile(const MPI_Comm communicator) const;

    Cell                most;
    double              away = nothing; // [Pa]
    std::vector<double> cells;          // stress [Pa] and volume [m3] of each
  };
} // namespace Voussoir

#endif
