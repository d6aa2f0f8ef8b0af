#ifndef voussoir_analysis_contributions_h
#define voussoir_analysis_contributions_h

#include <voussoir/fem/discretization.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>

namespace Voussoir
{
  /** One contribution to a symmetric matrix, such as that of a cell. */
  struct Contribution
  {
    /** Global numbers, of other ranks, too; none is constrained. */
    const std::vector<dealii::types::global_dof_index> &unknowns;

    /** Computes the entries between them. */
    const std::function<const dealii::FullMatrix<double> &()> &entries;
  };

  using ContributionVisit = std::function<void(const Contribution &)>;

  /** A matrix that is nowhere as a whole: visits the contributions of this
   *  rank. */
  using Contributions = std::function<void(const ContributionVisit &visit)>;


  /** Contributions in terms of the unknowns that constraints leave. */
  class Condensation
  {
  public:
    explicit Condensation(const dealii::AffineConstraints<double> &constraints);

    /** Visits C^T A C, where C gives all unknowns from those that are left; not
     *  if none is. */
    void
    operator()(
      const std::vector<dealii::types::global_dof_index>        &unknowns,
      const std::function<const dealii::FullMatrix<double> &()> &entries,
      const ContributionVisit                                   &visit);

  private:
    /** The unknowns that are left, with the row of C that belongs to one. */
    std::vector<std::pair<dealii::types::global_dof_index, double>>
    row(const dealii::types::global_dof_index unknown) const;

    const dealii::AffineConstraints<double>     &constraints;
    std::vector<dealii::types::global_dof_index> left;
    dealii::FullMatrix<double> transformation, product, result;
  };


  /** Adds the diagonal of the matrix to the owned entries of a vector.
   *
   *  @param layout has all unknowns of the contributions */
  void
  add_diagonal(
    Vector              &diagonal,
    const Contributions &contributions,
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout);
} // namespace Voussoir

#endif
