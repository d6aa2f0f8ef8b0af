#ifndef voussoir_fem_named_sets_h
#define voussoir_fem_named_sets_h

#include <voussoir/fem/discretization.h>

#include <set>

namespace Voussoir
{
  /**
   * Calls @p visit for each face of this rank in these face sets, set by set.
   * Refuses a list without sets, unknown sets and inner faces, on all ranks
   * together; @p place names the entry in messages, as in `"Face sets" in
   * section "Loads/push"`.
   */
  void
  for_each_face(const Discretization           &discretization,
                const std::vector<std::string> &sets,
                const std::string              &place,
                const std::function<
                  void(const dealii::Triangulation<3>::active_cell_iterator &,
                       const unsigned int face)> &visit);

  /** Refuses, on all ranks together, a face set that the mesh does not have or
   *  that has faces with cells on both sides. */
  void
  check_outer_face_set(const Grid        &grid,
                       const std::string &set,
                       const std::string &place);

  /**
   * Calls @p visit once for each cell of this rank that is in any of these cell
   * sets, or for all cells if there are no sets. Refuses unknown sets; @p place
   * names the entry in messages.
   */
  void
  for_each_cell(const Discretization           &discretization,
                const std::vector<std::string> &sets,
                const std::string              &place,
                const std::function<void(const Discretization::Cell &)> &visit);

  /** Global nodes on the faces of this rank in these face sets, which are
   *  checked as by for_each_face(). */
  std::set<dealii::types::global_dof_index>
  nodes_of_faces(const Discretization           &discretization,
                 const std::vector<std::string> &sets,
                 const std::string              &place);

  /**
   * The owned nodes, in ascending order, that carry the values at the @p nodes
   * of all ranks. Called on all ranks.
   *
   * @param nodes global nodes, hanging ones too
   */
  std::vector<unsigned int>
  owned_carriers(const Discretization &discretization,
                 const std::set<dealii::types::global_dof_index> &nodes);
} // namespace Voussoir

#endif
