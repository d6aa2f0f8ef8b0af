#ifndef voussoir_tests_contact_mesh_h
#define voussoir_tests_contact_mesh_h

#include <voussoir/constraints/contact_clusters.h>

#include <functional>
#include <string>

#include "check.h"

namespace Voussoir
{
  /** The clusters of all ranks, ordered by position. */
  std::vector<ContactCluster>
  all_clusters(const CoarseMesh               &mesh,
               const GridParameters           &grid,
               const unsigned int              degree,
               const std::vector<std::string> &interfaces,
               const MPI_Comm                  communicator);

  /** The largest difference in positions, areas and normals, relative to the
   *  size of these; 1 if nodes or pairs differ. */
  double
  difference(const std::vector<ContactCluster> &a,
             const std::vector<ContactCluster> &b);

  unsigned int
  n_pairs(const std::vector<ContactCluster> &clusters,
          const unsigned int                 interface);

  double
  total_area(const std::vector<ContactCluster> &clusters,
             const unsigned int                 interface);

  /** All ranks with either partition against one rank by itself. */
  void
  check_ranks(Verdicts                       &verdicts,
              const CoarseMesh               &mesh,
              const GridParameters           &grid,
              const unsigned int              degree,
              const std::vector<std::string> &interfaces,
              const MPI_Comm                  communicator);

  /** Whether a UserError is thrown whose text holds @p words. */
  bool
  is_refused(const std::function<void()> &action, const std::string &words);

  /** Bodies that have no vertex in common. */
  unsigned int
  n_bodies(const CoarseMesh &mesh);
} // namespace Voussoir

#endif
