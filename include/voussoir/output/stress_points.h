#ifndef voussoir_output_stress_points_h
#define voussoir_output_stress_points_h

#include <voussoir/output/law_stress.h>

namespace Voussoir
{
  /**
   * Stress at chosen points of this rank's cells. What a point needs of the
   * mesh is kept as weights of nodes, so that a look touches nothing else.
   */
  class StressPoints
  {
  public:
    /** A point of an owned cell. */
    struct Place
    {
      Discretization::Cell cell;
      dealii::Point<3>     unit; // in the reference cell
    };

    StressPoints(const ObservedModel &model, const std::vector<Place> &places);

    /** Total stress at each point [Pa]; all ranks must call this together. */
    const std::vector<dealii::SymmetricTensor<2, 3>> &
    evaluate(const Vector &displacement);

  private:
    struct Weight
    {
      unsigned int         entry; // of the node's x in a vector with ghosts
      dealii::Tensor<1, 3> gradient;
    };

    dealii::SymmetricTensor<2, 3>
    strain(const unsigned int point, const Vector &displacement) const;

    std::vector<Weight>      weights;
    std::vector<std::size_t> end_of_weights; // of each point
    std::vector<LawStress>   laws;           // of each point

    // of each point, if there is a static stage
    std::vector<dealii::SymmetricTensor<2, 3>> initial_strain;
    std::vector<double>                        temperature; // change [K]

    std::vector<dealii::SymmetricTensor<2, 3>> stress;
  };

  /** Gradients in space of the reference cell's coordinates at a point: row d
   *  is that of coordinate d [1/m]. */
  dealii::Tensor<2, 3>
  inverse_jacobian(const Grid::Cell &cell, const dealii::Point<3> &unit);
} // namespace Voussoir

#endif
