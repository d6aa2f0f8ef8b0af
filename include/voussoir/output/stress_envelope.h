#ifndef voussoir_output_stress_envelope_h
#define voussoir_output_stress_envelope_h

#include <voussoir/fem/batch_nodes.h>
#include <voussoir/output/filtered_displacement.h>
#include <voussoir/output/law_stress.h>

#include <deal.II/base/quadrature_lib.h>

#include <bitset>

namespace Voussoir
{
  /** Extremes of a cell: largest and smallest principal stress over the run
   *  [Pa], and their times [s]. */
  using StressExtremes = std::array<double, 4>;


  /**
   * Extremes of the principal stresses over the run in each cell, over the
   * points that pictures show: its nodes.
   */
  class StressEnvelope
  {
  public:
    /** @param sets cell sets to sample; none for all cells */
    StressEnvelope(const ObservedRun              &run,
                   const std::vector<std::string> &sets);

    void
    update(const State &state);

    /** Share of the cells that is sampled; all ranks must call this together.
     */
    double
    share_of_cells() const;

    /** Visits each cell that is sampled. */
    void
    for_each_cell(const std::function<void(const Discretization::Cell &,
                                           StressExtremes &)> &visit);

  private:
    /** Whether @p below and @p above lie between @p low and @p high in all
     *  lanes; not if a value is a NaN. */
    static bool
    are_within(const Lanes &below,
               const Lanes &above,
               const Lanes &low,
               const Lanes &high);

    using LaneSet = std::bitset<Lanes::size()>;

    struct Batch
    {
      Batch()
      {
        extremes.fill({{-std::numeric_limits<double>::max(),
                        std::numeric_limits<double>::max(),
                        0.,
                        0.}});
      }

      unsigned int                               number         = 0;
      double                                     damping_factor = 1.;
      LaneSet                                    watched;
      std::array<dealii::Tensor<1, 3, Lanes>, 8> vertices;

      /** Law at a point. */
      const LawStressLanes &
      law(const unsigned int point) const
      {
        return laws[laws.size() == 1 ? 0 : point];
      }

      // of each point, or one where it is the same at all points
      std::vector<LawStressLanes> laws;

      std::array<StressExtremes, Lanes::size()> extremes;
    };

    LaneSet
    lanes_in(const unsigned int       batch,
             const bool               all,
             const std::vector<bool> &tagged) const;

    Batch
    make_batch(const unsigned int number,
               const LaneSet     &watched,
               const bool         is_static,
               BatchNodes        &cells) const;

    /** Strain at a point from the values that @p cells has read. */
    SymmetricTensor3<Lanes>
    strain(const BatchNodes  &cells,
           const Batch       &batch,
           const unsigned int point) const;

    const ObservedRun                 run;
    const Discretization::MatrixFree &matrix_free;
    const dealii::QIterated<3>        points;

    // of each point, in the order of an evaluation, by unit coordinate
    std::vector<std::vector<double>>                 shape_values;
    std::vector<std::vector<dealii::Tensor<1, 3>>>   shape_gradients;
    std::vector<std::array<dealii::Tensor<1, 3>, 8>> vertex_gradients;

    FilteredDisplacement filtered;

    dealii::AlignedVector<Batch> batches;
  };
} // namespace Voussoir

#endif
