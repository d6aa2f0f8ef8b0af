#include <voussoir/analysis/aggregates.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // connections weaker than this, relative to both diagonals, are none
    constexpr double weak = 0.02;


    /** The owned nodes of a contribution, and which of them each unknown
     *  belongs to. */
    class OwnNodes
    {
    public:
      OwnNodes(const Utilities::MPI::Partitioner &layout,
               const unsigned int                 n_components)
        : layout(layout)
        , n_components(n_components)
      {}

      void
      find(const std::vector<types::global_dof_index> &unknowns)
      {
        nodes.clear();
        places.clear();
        for (const auto unknown : unknowns)
          {
            places.push_back(numbers::invalid_unsigned_int);
            if (!layout.in_local_range(unknown))
              continue;
            const unsigned int node =
              layout.global_to_local(unknown) / n_components;
            const auto found = std::find(nodes.begin(), nodes.end(), node);
            places.back()    = found - nodes.begin();
            if (found == nodes.end())
              nodes.push_back(node);
          }
      }

      std::vector<types::global_dof_index> nodes;
      std::vector<unsigned int>            places;

    private:
      const Utilities::MPI::Partitioner &layout;
      const unsigned int                 n_components;
    };


    SparsityPattern
    connections(const Contributions &contributions,
                OwnNodes            &own,
                const unsigned int   n_nodes)
    {
      DynamicSparsityPattern pattern(n_nodes, n_nodes);
      contributions([&](const Contribution &contribution) {
        own.find(contribution.unknowns);
        std::sort(own.nodes.begin(), own.nodes.end());
        for (const auto node : own.nodes)
          pattern.add_entries(node, own.nodes.begin(), own.nodes.end(), true);
      });
      SparsityPattern result;
      result.copy_from(pattern);
      return result;
    }


    /** Sums of what the contributions have between two nodes. */
    SparseMatrix<float>
    strengths(const SparsityPattern &pattern,
              const Contributions   &contributions,
              OwnNodes              &own)
    {
      SparseMatrix<float> result(pattern);
      FullMatrix<float>   block;
      contributions([&](const Contribution &contribution) {
        own.find(contribution.unknowns);
        const FullMatrix<double> &entries = contribution.entries();
        block.reinit(own.nodes.size(), own.nodes.size());
        for (unsigned int i = 0; i < own.places.size(); ++i)
          for (unsigned int j = 0; j < own.places.size(); ++j)
            if (own.places[i] != numbers::invalid_unsigned_int &&
                own.places[j] != numbers::invalid_unsigned_int)
              block(own.places[i], own.places[j]) += std::abs(entries(i, j));
        result.add(own.nodes, block);
      });
      return result;
    }


    /** Aggregate of each node; none of those without entries. */
    std::vector<unsigned int>
    find_aggregates(const SparseMatrix<float> &strength,
                    unsigned int              &n_aggregates)
    {
      constexpr unsigned int    none = numbers::invalid_unsigned_int;
      std::vector<unsigned int> aggregate(strength.m(), none);
      n_aggregates = 0;
      // calls visit(node, strength) for the strong connections
      const auto for_each_neighbor = [&](const unsigned int i,
                                         const auto        &visit) {
        for (auto entry = strength.begin(i); entry != strength.end(i); ++entry)
          {
            const unsigned int j     = entry->column();
            const double       value = entry->value();
            if (j != i && value * value > weak * weak *
                                            double(strength.diag_element(i)) *
                                            strength.diag_element(j))
              visit(j, value);
          }
      };
      // with all neighbours, where none of them is taken
      const auto begin_at = [&](const unsigned int i) {
        aggregate[i] = n_aggregates;
        for_each_neighbor(i, [&](const unsigned int j, const double) {
          if (aggregate[j] == none)
            aggregate[j] = n_aggregates;
        });
        ++n_aggregates;
      };
      const auto is_left = [&](const unsigned int i) {
        return aggregate[i] == none && strength.diag_element(i) > 0.f;
      };
      for (unsigned int i = 0; i < aggregate.size(); ++i)
        {
          bool is_free = is_left(i);
          for_each_neighbor(i, [&](const unsigned int j, const double) {
            is_free = is_free && aggregate[j] == none;
          });
          if (is_free)
            begin_at(i);
        }
      // the others where they are connected most strongly
      const auto                     first = aggregate;
      std::map<unsigned int, double> sum;
      for (unsigned int i = 0; i < aggregate.size(); ++i)
        if (is_left(i))
          {
            sum.clear();
            for_each_neighbor(i, [&](const unsigned int j, const double value) {
              if (first[j] != none)
                sum[first[j]] += value;
            });
            double largest = 0.;
            for (const auto &[candidate, value] : sum)
              if (value > largest)
                {
                  largest      = value;
                  aggregate[i] = candidate;
                }
          }
      for (unsigned int i = 0; i < aggregate.size(); ++i)
        if (is_left(i))
          begin_at(i);
      return aggregate;
    }
  } // namespace


  Aggregates::Aggregates(
    const Contributions                                      &contributions,
    const std::shared_ptr<const Utilities::MPI::Partitioner> &layout,
    const std::vector<unsigned int>                          &constrained,
    const unsigned int                                        n_components,
    const unsigned int                                        n_modes,
    const NearKernel                                         &near_kernel)
    : n_modes(n_modes)
    , layout(layout)
    , n_components(n_components)
  {
    {
      OwnNodes              own(*layout, n_components);
      const SparsityPattern pattern =
        connections(contributions,
                    own,
                    layout->locally_owned_size() / n_components);
      aggregate =
        find_aggregates(strengths(pattern, contributions, own), n_aggregates);
    }
    // Trilinos wants unknowns on each rank
    n_aggregates            = std::max(n_aggregates, 1U);
    const auto owned_by_all = Utilities::MPI::create_ascending_partitioning(
      layout->get_mpi_communicator(), n_modes * n_aggregates);
    owned = owned_by_all[Utilities::MPI::this_mpi_process(
      layout->get_mpi_communicator())];
    find_prolongation(constrained, near_kernel);
    sum_up(contributions);
  }


  void
  Aggregates::find_prolongation(const std::vector<unsigned int> &constrained,
                                const NearKernel                &near_kernel)
  {
    const unsigned int        n_nodes = aggregate.size();
    std::vector<bool>         is_constrained(n_components * n_nodes);
    std::vector<unsigned int> begin(n_aggregates + 1), nodes(n_nodes);
    for (const unsigned int i : constrained)
      is_constrained[i] = true;
    for (unsigned int c = 0; c < n_modes; ++c)
      prolongation.emplace_back(layout);
    coarse_near_kernel.resize(n_modes * n_modes * n_aggregates);

    // the nodes of each aggregate one after the other
    std::iota(nodes.begin(), nodes.end(), 0);
    nodes.erase(std::remove_if(nodes.begin(),
                               nodes.end(),
                               [&](const unsigned int node) {
                                 return aggregate[node] ==
                                        numbers::invalid_unsigned_int;
                               }),
                nodes.end());
    std::stable_sort(nodes.begin(),
                     nodes.end(),
                     [&](const unsigned int a, const unsigned int b) {
                       return aggregate[a] < aggregate[b];
                     });
    for (const unsigned int node : nodes)
      ++begin[aggregate[node] + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());

    FullMatrix<double>               of_node(n_components, n_modes);
    std::vector<std::vector<double>> modes(n_modes);
    for (unsigned int a = 0; a < n_aggregates; ++a)
      {
        for (auto &mode : modes)
          mode.clear();
        for (unsigned int k = begin[a]; k < begin[a + 1]; ++k)
          {
            near_kernel(nodes[k], of_node);
            for (unsigned int d = 0; d < n_components; ++d)
              for (unsigned int c = 0; c < n_modes; ++c)
                modes[c].push_back(is_constrained[n_components * nodes[k] + d] ?
                                     0. :
                                     of_node(d, c));
          }
        // modes = orthonormal ones times a triangular matrix
        for (unsigned int c = 0; c < n_modes; ++c)
          {
            std::vector<double> &mode  = modes[c];
            const auto           entry = [&](const unsigned int b) -> double           &{
              return coarse_near_kernel[(c * n_aggregates + a) * n_modes + b];
            };
            const auto product = [&](const std::vector<double> &other) {
              return std::inner_product(mode.begin(),
                                        mode.end(),
                                        other.begin(),
                                        0.);
            };
            const double size = std::sqrt(product(mode));
            // again, as once is not to round-off
            for (unsigned int time = 0; time < 2; ++time)
              for (unsigned int b = 0; b < c; ++b)
                {
                  const double share = product(modes[b]);
                  entry(b) += share;
                  for (unsigned int i = 0; i < mode.size(); ++i)
                    mode[i] -= share * modes[b][i];
                }
            const double left = std::sqrt(product(mode));
            // as of a single node, which does not rotate
            const bool is_used = left > 1e-8 * size;
            entry(c)           = is_used ? left : 0.;
            if (!is_used)
              unused.push_back(owned.nth_index_in_set(a * n_modes + c));
            for (double &value : mode)
              value = is_used ? value / left : 0.;
            for (unsigned int k = begin[a], i = 0; k < begin[a + 1]; ++k)
              for (unsigned int d = 0; d < n_components; ++d, ++i)
                prolongation[c].local_element(n_components * nodes[k] + d) =
                  mode[i];
          }
      }
  }


  void
  Aggregates::sum_up(const Contributions &contributions)
  {
    // first coarse unknown of each fine one, those of other ranks too
    LinearAlgebra::distributed::Vector<double> first(layout);
    for (unsigned int i = 0; i < layout->locally_owned_size(); ++i)
      {
        const unsigned int a   = aggregate[i / n_components];
        first.local_element(i) = a == numbers::invalid_unsigned_int ?
                                   0. :
                                   owned.nth_index_in_set(n_modes * a);
      }
    first.update_ghost_values();
    IndexSet rows = owned, aggregates(owned.size() / n_modes);
    for (unsigned int i = layout->locally_owned_size();
         i < layout->locally_owned_size() + layout->n_ghost_indices();
         ++i)
      rows.add_range(first.local_element(i), first.local_element(i) + n_modes);
    for (auto row = rows.begin_intervals(); row != rows.end_intervals(); ++row)
      aggregates.add_range(*row->begin() / n_modes, row->last() / n_modes + 1);
    for (auto &mode : prolongation)
      mode.update_ghost_values();

    // those of a contribution, and where they begin for each of its unknowns
    std::vector<types::global_dof_index> coarse;
    std::vector<unsigned int>            fine, begin;
    const auto                           find_coarse =
      [&](const std::vector<types::global_dof_index> &unknowns) {
        coarse.clear();
        fine.clear();
        begin.clear();
        for (const auto unknown : unknowns)
          {
            fine.push_back(layout->global_to_local(unknown));
            const types::global_dof_index number =
              first.local_element(fine.back());
            const auto found = std::find(coarse.begin(), coarse.end(), number);
            begin.push_back(found - coarse.begin());
            if (found == coarse.end())
              for (unsigned int c = 0; c < n_modes; ++c)
                coarse.push_back(number + c);
          }
      };
    DynamicSparsityPattern               neighbors(aggregates.size(),
                                     aggregates.size(),
                                     aggregates);
    std::vector<types::global_dof_index> of_contribution;
    contributions([&](const Contribution &contribution) {
      find_coarse(contribution.unknowns);
      of_contribution.clear();
      for (unsigned int i = 0; i < coarse.size(); i += n_modes)
        of_contribution.push_back(coarse[i] / n_modes);
      std::sort(of_contribution.begin(), of_contribution.end());
      for (const auto a : of_contribution)
        neighbors.add_entries(a,
                              of_contribution.begin(),
                              of_contribution.end(),
                              true);
    });
    TrilinosWrappers::SparsityPattern pattern(
      owned, owned, rows, layout->get_mpi_communicator(), 27 * n_modes);
    for (const auto a : aggregates)
      {
        coarse.clear();
        for (auto b = neighbors.begin(a); b != neighbors.end(a); ++b)
          for (unsigned int c = 0; c < n_modes; ++c)
            coarse.push_back(b->column() * n_modes + c);
        for (unsigned int c = 0; c < n_modes; ++c)
          pattern.add_entries(a * n_modes + c,
                              coarse.begin(),
                              coarse.end(),
                              true);
      }
    for (const auto i : unused)
      pattern.add(i, i);
    pattern.compress();
    coarse_matrix.reinit(pattern);

    FullMatrix<double> product, result;
    contributions([&](const Contribution &contribution) {
      find_coarse(contribution.unknowns);
      const FullMatrix<double> &entries = contribution.entries();
      product.reinit(fine.size(), coarse.size());
      result.reinit(coarse.size(), coarse.size());
      for (unsigned int j = 0; j < fine.size(); ++j)
        for (unsigned int c = 0; c < n_modes; ++c)
          {
            const double value = prolongation[c].local_element(fine[j]);
            for (unsigned int i = 0; i < fine.size(); ++i)
              product(i, begin[j] + c) += entries(i, j) * value;
          }
      for (unsigned int i = 0; i < fine.size(); ++i)
        for (unsigned int c = 0; c < n_modes; ++c)
          {
            const double value = prolongation[c].local_element(fine[i]);
            for (unsigned int j = 0; j < coarse.size(); ++j)
              result(begin[i] + c, j) += value * product(i, j);
          }
      coarse_matrix.add(coarse, result, false);
    });
    for (const auto i : unused)
      coarse_matrix.add(i, i, 1.);
    coarse_matrix.compress(VectorOperation::add);
    for (auto &mode : prolongation)
      mode.zero_out_ghost_values();
  }


  const TrilinosWrappers::SparseMatrix &
  Aggregates::matrix() const
  {
    return coarse_matrix;
  }


  const std::vector<double> &
  Aggregates::near_kernel() const
  {
    return coarse_near_kernel;
  }


  Vector
  Aggregates::create_vector() const
  {
    return Vector(owned, layout->get_mpi_communicator());
  }


  void
  Aggregates::restrict_to(Vector &coarse, const Vector &fine) const
  {
    coarse = 0.;
    for (unsigned int node = 0, i = 0; node < aggregate.size(); ++node)
      for (unsigned int d = 0; d < n_components; ++d, ++i)
        if (aggregate[node] != numbers::invalid_unsigned_int)
          for (unsigned int c = 0; c < n_modes; ++c)
            coarse.local_element(n_modes * aggregate[node] + c) +=
              prolongation[c].local_element(i) * fine.local_element(i);
  }


  void
  Aggregates::add_prolongated(Vector &fine, const Vector &coarse) const
  {
    for (unsigned int node = 0, i = 0; node < aggregate.size(); ++node)
      for (unsigned int d = 0; d < n_components; ++d, ++i)
        if (aggregate[node] != numbers::invalid_unsigned_int)
          for (unsigned int c = 0; c < n_modes; ++c)
            fine.local_element(i) +=
              prolongation[c].local_element(i) *
              coarse.local_element(n_modes * aggregate[node] + c);
  }
} // namespace Voussoir
