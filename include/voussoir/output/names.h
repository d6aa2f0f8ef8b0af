#ifndef voussoir_output_names_h
#define voussoir_output_names_h

#include <voussoir/grid/grid.h>

#include <deal.II/lac/vector.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  class Contact;

  /**
   * The table of names behind the numbers in all results. The number of a name
   * is its index in the list of its kind, from zero. VTU files have the numbers
   * as fields and the lists beside them (see `write_vtu`), CSV files have their
   * columns in this order, and summary.json has the table as "names".
   */
  struct ResultNames
  {
    /**
     * @param material_names in the order of the section "Materials"
     * @param contact        null if there are no interfaces
     */
    ResultNames(const std::vector<std::string> &material_names,
                const Grid                     &grid,
                const Contact                  *contact);

    std::vector<std::string> materials;
    std::vector<std::string> cell_sets;  // of the mesh, by name, with blocks
    std::vector<std::string> face_sets;  // of the mesh, by name
    std::vector<std::string> interfaces; // in the order of their section

    /** Names behind the numbers of the state of a contact point. */
    static const std::vector<std::string> &
    interface_states();

    /** The lists by kind. */
    nlohmann::json
    json() const;
  };

  /** Index of a name in a list that contains the name. */
  unsigned int
  number_of(const std::string &name, const std::vector<std::string> &names);

  /**
   * For each active cell the number of the smallest of these cell sets that it
   * lies in, which is its block if it has one; -1 if it lies in none, and for
   * cells of other ranks. Called on all ranks.
   */
  dealii::Vector<float>
  smallest_cell_sets(const Grid &grid, const std::vector<std::string> &names);
} // namespace Voussoir

#endif
