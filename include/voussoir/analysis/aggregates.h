#ifndef voussoir_analysis_aggregates_h
#define voussoir_analysis_aggregates_h

#include <voussoir/analysis/contributions.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

namespace Voussoir
{
  /**
   * Coarse space of a multigrid method, of aggregates of strongly connected
   * nodes of a rank (Vanek, Mandel and Brezina 1996). Each moves in the modes
   * of the near-kernel. Its matrix is summed up from the contributions to the
   * fine one, which nobody needs.
   */
  class Aggregates
  {
  public:
    /** Sets the values of the near-kernel at an owned node: a row for each of
     *  its components, a column for each mode. */
    using NearKernel = std::function<void(const unsigned int node,
                                          dealii::FullMatrix<double> &)>;

    /**
     * @param layout of the unknowns, with all those of the contributions
     * @param constrained  owned entries
     * @param n_components of a node, whose entries follow each other
     * @param n_modes      of the near-kernel, the motions that cost no energy
     *   where nothing is fixed
     */
    Aggregates(
      const Contributions &contributions,
      const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout,
      const std::vector<unsigned int> &constrained,
      const unsigned int               n_components,
      const unsigned int               n_modes,
      const NearKernel                &near_kernel);

    const unsigned int n_modes;

    /** P^T A P with the prolongation P. */
    const dealii::TrilinosWrappers::SparseMatrix &
    matrix() const;

    /** The near-kernel by coarse unknowns, mode after mode. */
    const std::vector<double> &
    near_kernel() const;

    /** A zero vector of the coarse unknowns. */
    Vector
    create_vector() const;

    /** coarse = P^T fine */
    void
    restrict_to(Vector &coarse, const Vector &fine) const;

    /** fine += P coarse */
    void
    add_prolongated(Vector &fine, const Vector &coarse) const;

  private:
    /** Each mode in turn, orthonormal in each aggregate. */
    void
    find_prolongation(const std::vector<unsigned int> &constrained,
                      const NearKernel                &near_kernel);

    void
    sum_up(const Contributions &contributions);

    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    const unsigned int        n_components;
    std::vector<unsigned int> aggregate; // of each owned node
    unsigned int              n_aggregates = 0;
    dealii::IndexSet          owned; // coarse unknowns

    // of each mode, in the layout of the fine unknowns
    std::vector<dealii::LinearAlgebra::distributed::Vector<float>> prolongation;
    std::vector<unsigned int>              unused; // coarse unknowns
    std::vector<double>                    coarse_near_kernel;
    dealii::TrilinosWrappers::SparseMatrix coarse_matrix;
  };
} // namespace Voussoir

#endif
