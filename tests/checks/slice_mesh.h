#ifndef voussoir_tests_slice_mesh_h
#define voussoir_tests_slice_mesh_h

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace Voussoir
{
  /** A slice of hexahedra, one cell thick, in columns i and rows j; k = 0, 1
   * are its sides. Sets are counted from one. */
  class SliceMesh
  {
  public:
    SliceMesh(const unsigned int columns, const unsigned int rows)
      : columns(columns)
      , rows(rows)
    {}

    /** Parts the first columns below row j; before any cell is added. */
    void
    cut(const unsigned int columns, const unsigned int j)
    {
      cut_columns = columns;
      cut_row     = j;
    }

    void
    add_cell(const unsigned int set, const unsigned int i, const unsigned int j)
    {
      std::vector<unsigned int> corners = side(i, j, 0);
      for (const unsigned int corner : side(i, j, 1))
        corners.push_back(corner);
      add("5", set, corners);
    }

    /** Adds the face of a cell on a side. */
    void
    add_side(const unsigned int set,
             const unsigned int i,
             const unsigned int j,
             const unsigned int k)
    {
      add("3", set, side(i, j, k));
    }

    /** Adds the face of column i below row j. */
    void
    add_level(const unsigned int set,
              const unsigned int i,
              const unsigned int j)
    {
      add("3",
          set,
          {node(i, j, 0), node(i + 1, j, 0), node(i + 1, j, 1), node(i, j, 1)});
    }

    /** Adds the face of row j to the left of column i. */
    void
    add_upright(const unsigned int set,
                const unsigned int i,
                const unsigned int j)
    {
      add("3",
          set,
          {node(i, j, 0), node(i, j, 1), node(i, j + 1, 1), node(i, j + 1, 0)});
    }

    /** Adds the faces below the first row and above the last one. */
    void
    add_bottom_and_top(const unsigned int bottom, const unsigned int top)
    {
      for (unsigned int i = 0; i < columns; ++i)
        {
          add_level(bottom, i, 0);
          add_level(top, i, rows);
        }
    }

    /** Adds the faces at both ends of the rows from this one on. */
    void
    add_ends(const unsigned int set, const unsigned int first_row)
    {
      for (unsigned int j = first_row; j < rows; ++j)
        for (const unsigned int i : {0u, columns})
          add_upright(set, i, j);
    }

    /**
     * Writes the mesh in version 2.2 of Gmsh's format.
     *
     * @param sets      dimension and name of each
     * @param thickness [m]
     * @param position  x and z [m] of the nodes in column i and row j
     */
    template <typename Position>
    void
    write(const std::string                                       &name,
          const std::vector<std::pair<unsigned int, std::string>> &sets,
          const double                                             thickness,
          const Position &position) const
    {
      std::ofstream file(name);
      file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n"
           << sets.size() << '\n';
      for (unsigned int s = 0; s < sets.size(); ++s)
        file << sets[s].first << ' ' << s + 1 << " \"" << sets[s].second
             << "\"\n";
      file << "$EndPhysicalNames\n$Nodes\n"
           << 2 * ((columns + 1) * (rows + 1) + cut_columns) << '\n';
      const auto write_nodes = [&](const unsigned int i,
                                   const unsigned int j,
                                   const unsigned int first) {
        const auto [x, z] = position(i, j);
        for (unsigned int k = 0; k < 2; ++k)
          file << first + k << ' ' << x << ' ' << -(thickness * k) << ' ' << z
               << '\n';
      };
      for (unsigned int j = 0; j <= rows; ++j)
        for (unsigned int i = 0; i <= columns; ++i)
          write_nodes(i, j, node(i, j, 0));
      for (unsigned int i = 0; i < cut_columns; ++i)
        write_nodes(i, cut_row, above_cut(i, 0));
      file << "$EndNodes\n$Elements\n" << elements.size() << '\n';
      for (const std::string &element : elements)
        file << element << '\n';
      file << "$EndElements\n";
    }

  private:
    unsigned int
    node(const unsigned int i, const unsigned int j, const unsigned int k) const
    {
      return 1 + (j * (columns + 1) + i) * 2 + k;
    }

    unsigned int
    above_cut(const unsigned int i, const unsigned int k) const
    {
      return 1 + ((columns + 1) * (rows + 1) + i) * 2 + k;
    }

    std::vector<unsigned int>
    side(const unsigned int i, const unsigned int j, const unsigned int k) const
    {
      const auto lower = [&](const unsigned int i) {
        return j == cut_row && i < cut_columns ? above_cut(i, k) :
                                                 node(i, j, k);
      };
      return {lower(i), lower(i + 1), node(i + 1, j + 1, k), node(i, j + 1, k)};
    }

    void
    add(const std::string               &kind,
        const unsigned int               set,
        const std::vector<unsigned int> &nodes)
    {
      std::ostringstream text;
      text << elements.size() + 1 << ' ' << kind << " 2 " << set << ' ' << set;
      for (const unsigned int number : nodes)
        text << ' ' << number;
      elements.push_back(text.str());
    }

    const unsigned int       columns, rows;
    unsigned int             cut_columns = 0, cut_row = 0;
    std::vector<std::string> elements;
  };
} // namespace Voussoir

#endif
