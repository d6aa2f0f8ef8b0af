#include "contact_mesh.h"

#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Ranks compute positions to round-off only.
    bool
    lies_before(const ContactCluster &a, const ContactCluster &b)
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (std::abs(a.position[d] - b.position[d]) > 1e-6)
          return a.position[d] < b.position[d];
      return false;
    }
  } // namespace


  std::vector<ContactCluster>
  all_clusters(const CoarseMesh               &mesh,
               const GridParameters           &parameters,
               const unsigned int              degree,
               const std::vector<std::string> &interfaces,
               const MPI_Comm                  communicator)
  {
    const Grid               grid(mesh, parameters, communicator);
    DiscretizationParameters space;
    space.degree = degree;
    const Discretization discretization(grid, space, {});
    const auto mine = find_contact_clusters(discretization, interfaces);
    for (const ContactCluster &cluster : mine)
      AssertThrow(
        discretization.owned_dofs.is_element(3 * cluster.nodes.front()),
        ExcMessage("A cluster is not on the rank of its first node."));
    auto all = join_over_ranks(mine, communicator);
    std::sort(all.begin(), all.end(), lies_before);
    return all;
  }


  double
  difference(const std::vector<ContactCluster> &a,
             const std::vector<ContactCluster> &b)
  {
    if (a.size() != b.size())
      return 1.;
    double result = 0.;
    for (unsigned int c = 0; c < a.size(); ++c)
      {
        if (a[c].nodes.size() != b[c].nodes.size() ||
            a[c].pairs.size() != b[c].pairs.size())
          return 1.;
        keep_largest(result,
                     a[c].position.distance(b[c].position) /
                       (1. + a[c].position.norm()));
        for (unsigned int i = 0; i < a[c].pairs.size(); ++i)
          {
            const ContactPair &p = a[c].pairs[i], &q = b[c].pairs[i];
            if (p.interface != q.interface || p.first != q.first ||
                p.second != q.second)
              return 1.;
            result = std::max({result,
                               (p.normal - q.normal).norm(),
                               std::abs(p.area / q.area - 1.)});
          }
      }
    return result;
  }


  unsigned int
  n_pairs(const std::vector<ContactCluster> &clusters,
          const unsigned int                 interface)
  {
    unsigned int n = 0;
    for (const ContactCluster &cluster : clusters)
      for (const ContactPair &pair : cluster.pairs)
        n += pair.interface == interface;
    return n;
  }


  double
  total_area(const std::vector<ContactCluster> &clusters,
             const unsigned int                 interface)
  {
    double area = 0.;
    for (const ContactCluster &cluster : clusters)
      for (const ContactPair &pair : cluster.pairs)
        area += pair.interface == interface ? pair.area : 0.;
    return area;
  }


  void
  check_ranks(Verdicts                       &verdicts,
              const CoarseMesh               &mesh,
              const GridParameters           &grid,
              const unsigned int              degree,
              const std::vector<std::string> &interfaces,
              const MPI_Comm                  communicator)
  {
    const auto alone =
      all_clusters(mesh, grid, degree, interfaces, MPI_COMM_SELF);
    for (const Partition partition : {Partition::p4est, Partition::metis})
      {
        GridParameters together = grid;
        together.partition      = partition;
        verdicts.below(
          "  degree " + std::to_string(degree) + ", difference to one rank, " +
            option_name(partition),
          difference(
            alone,
            all_clusters(mesh, together, degree, interfaces, communicator)),
          1e-12);
      }
  }


  bool
  is_refused(const std::function<void()> &action, const std::string &words)
  {
    try
      {
        action();
      }
    catch (const UserError &error)
      {
        return std::string(error.what()).find(words) != std::string::npos;
      }
    return false;
  }


  unsigned int
  n_bodies(const CoarseMesh &mesh)
  {
    std::vector<unsigned int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](unsigned int v) {
      while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
      return v;
    };
    for (const auto &cell : mesh.cells)
      for (const unsigned int v : cell)
        parent[root(v)] = root(cell[0]);
    std::set<unsigned int> roots;
    for (unsigned int v = 0; v < parent.size(); ++v)
      roots.insert(root(v));
    return roots.size();
  }
} // namespace Voussoir
