#ifndef voussoir_mesh_mesh_check_h
#define voussoir_mesh_mesh_check_h

#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/mpi.h>

#include <string>

namespace Voussoir
{
  /** No coordinate of a mesh is larger, in whatever unit. */
  constexpr double largest_coordinate = 1e12;

  /**
   * Throw UserError, with a sentence that begins with @p where, if the mesh is
   * empty, has coordinates that are no finite numbers, cells that name a vertex
   * twice, or two vertices at one place, duplicate cells, inverted or tangled
   * cells, cells that overlap across a common face or without one, or faces
   * with more than two cells. @p remedy says what to do about tangled cells.
   */
  void
  check_mesh(const CoarseMesh  &mesh,
             const std::string &where,
             const std::string &remedy = "improve the mesh there");

  /**
   * Throw UserError, with a sentence that begins with @p place, if so many
   * cells need more memory than @p machines have.
   */
  void
  check_size(const double       n_cells,
             const unsigned int degree,
             const std::string &place,
             const double       machines = 1.);

  /** The same for p4est, with which each rank holds so many cells before
   *  refinement. */
  void
  check_copies(const double n_cells, const MPI_Comm communicator);
} // namespace Voussoir

#endif
