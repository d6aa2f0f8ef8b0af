#include <voussoir/analysis/contributions.h>

namespace Voussoir
{
  using namespace dealii;

  Condensation::Condensation(const AffineConstraints<double> &constraints)
    : constraints(constraints)
  {}


  std::vector<std::pair<types::global_dof_index, double>>
  Condensation::row(const types::global_dof_index unknown) const
  {
    if (!constraints.is_constrained(unknown))
      return {{unknown, 1.}};
    return *constraints.get_constraint_entries(unknown);
  }


  void
  Condensation::operator()(
    const std::vector<types::global_dof_index>        &unknowns,
    const std::function<const FullMatrix<double> &()> &entries,
    const ContributionVisit                           &visit)
  {
    if (std::none_of(unknowns.begin(), unknowns.end(), [this](const auto dof) {
          return constraints.is_constrained(dof);
        }))
      {
        visit({unknowns, entries});
        return;
      }
    left.clear();
    for (const auto unknown : unknowns)
      for (const auto &entry : row(unknown))
        left.push_back(entry.first);
    std::sort(left.begin(), left.end());
    left.erase(std::unique(left.begin(), left.end()), left.end());
    if (left.empty())
      return;
    visit(
      {left, [&]() -> const FullMatrix<double> & {
         transformation.reinit(unknowns.size(), left.size());
         for (unsigned int i = 0; i < unknowns.size(); ++i)
           for (const auto &[dof, weight] : row(unknowns[i]))
             transformation(i,
                            std::lower_bound(left.begin(), left.end(), dof) -
                              left.begin()) += weight;
         product.reinit(unknowns.size(), left.size());
         entries().mmult(product, transformation);
         result.reinit(left.size(), left.size());
         transformation.Tmmult(result, product);
         return result;
       }});
  }


  void
  add_diagonal(Vector              &diagonal,
               const Contributions &contributions,
               const std::shared_ptr<const Utilities::MPI::Partitioner> &layout)
  {
    Vector values(layout);
    contributions([&](const Contribution &contribution) {
      const FullMatrix<double> &entries = contribution.entries();
      for (unsigned int i = 0; i < contribution.unknowns.size(); ++i)
        values(contribution.unknowns[i]) += entries(i, i);
    });
    values.compress(VectorOperation::add);
    for (unsigned int i = 0; i < layout->locally_owned_size(); ++i)
      diagonal.local_element(i) += values.local_element(i);
  }
} // namespace Voussoir
