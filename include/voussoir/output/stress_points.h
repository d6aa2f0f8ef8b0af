#ifndef voussoir_output_stress_points_h
#define voussoir_output_stress_points_h

#include <voussoir/output/filtered_displacement.h>
#include <voussoir/output/law_stress.h>

namespace Voussoir
{
  /**
   * Stress at chosen points of this rank's cells. The data of the mesh for a
   * point are stored as weights of nodes, so that a sample needs nothing else.
   */
  class StressPoints
  {
  public:
    /** A place in an owned cell. */
    struct Place
    {
      Discretization::Cell cell;
      dealii::Point<3>     unit; // in the reference cell
    };

    /** Each place is a point. */
    StressPoints(const StressModel &model, const std::vector<Place> &places);

    /** The stress of a point is the sum over the places whose entry in
     *  @p point_of_place it is. */
    StressPoints(const StressModel               &model,
                 const std::vector<Place>        &places,
                 const std::vector<unsigned int> &point_of_place,
                 const unsigned int               n_points);

    /** Stress of the equation of motion at each point [Pa]; all ranks must call
     *  this together. */
    const std::vector<dealii::SymmetricTensor<2, 3>> &
    evaluate(const State &state);

  private:
    /** Weights of nodes: in each lane that of one node of the sample in this
     *  lane. */
    struct Weight
    {
      std::array<unsigned int, Lanes::size()> entries; // of the node's x
      dealii::Tensor<1, 3, Lanes>             gradient;
    };

    /** Samples that are evaluated at once, one for each lane. */
    struct Group
    {
      std::size_t    end_of_weights = 0;
      LawStressLanes laws;
    };

    SymmetricTensor3<Lanes>
    strain(const unsigned int group, const Vector &displacement) const;

    std::unique_ptr<FilteredDisplacement> filtered;

    std::vector<Weight>       weights;
    std::vector<Group>        groups;
    std::vector<unsigned int> point_of_sample;

    std::vector<dealii::SymmetricTensor<2, 3>> stress;
  };

  /** Gradients in space of the reference cell's coordinates at a point: row d
   *  is that of coordinate d [1/m]. */
  dealii::Tensor<2, 3>
  inverse_jacobian(const Grid::Cell &cell, const dealii::Point<3> &unit);
} // namespace Voussoir

#endif
