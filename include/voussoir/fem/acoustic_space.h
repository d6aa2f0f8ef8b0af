#ifndef voussoir_fem_acoustic_space_h
#define voussoir_fem_acoustic_space_h

#include <voussoir/fem/discretization.h>
#include <voussoir/fem/internal_force.h>

#include <deal.II/fe/fe_q.h>

namespace Voussoir
{
  /**
   * The pressure space of the water, with its own mesh and partition: one
   * unknown per node, elements of the same degree as for the displacement.
   */
  class AcousticSpace
  {
  public:
    using MatrixFree = dealii::MatrixFree<3, double, Lanes>;

    /** Local refinement is not applied to water. */
    AcousticSpace(const CoarseMesh     &mesh,
                  const GridParameters &parameters,
                  const unsigned int    degree,
                  const MPI_Comm        communicator);

    const Grid                 grid;
    const dealii::FE_Q<3>      fe;
    const dealii::MappingQ1<3> mapping;
    dealii::DoFHandler<3>      dof_handler;
    dealii::IndexSet           owned_dofs, relevant_dofs;
    MatrixFree                 matrix_free;

    /** Gauss-Lobatto weight times Jacobian at each node [m3]. */
    Vector volumes;

    /** Position of each owned node [m]. */
    std::vector<dealii::Point<3>> node_positions;

    Vector
    create_vector() const;

    /** A vector whose ghosts are all locally relevant unknowns. */
    Vector
    create_ghosted_vector() const;

    using FacePredicate =
      std::function<bool(const Grid::Cell &, const unsigned int)>;

    /** Gauss-Lobatto weight times Jacobian at each node [m2], on the outer
     *  faces that @p wanted accepts. */
    Vector
    areas(const FacePredicate &wanted) const;

    /**
     * result += integral of grad phi_i . grad source, with @p before and @p
     * after as in InternalForce::sweep().
     */
    void
    sweep(Vector                         &result,
          const Vector                   &source,
          const InternalForce::RangeWork &before,
          const InternalForce::RangeWork &after) const;

    /** A number of each owned node that does not depend on the partition. */
    std::vector<std::uint64_t>
    node_keys() const;
  };
} // namespace Voussoir

#endif
