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
           << 2 * (columns + 1) * (rows + 1) << '\n';
      for (unsigned int j = 0; j <= rows; ++j)
        for (unsigned int i = 0; i <= columns; ++i)
          for (unsigned int k = 0; k < 2; ++k)
            {
              const auto [x, z] = position(i, j);
              file << node(i, j, k) << ' ' << x << ' ' << -(thickness * k)
                   << ' ' << z << '\n';
            }
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

    std::vector<unsigned int>
    side(const unsigned int i, const unsigned int j, const unsigned int k) const
    {
      return {node(i, j, k),
              node(i + 1, j, k),
              node(i + 1, j + 1, k),
              node(i, j + 1, k)};
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
    std::vector<std::string> elements;
  };
} // namespace Voussoir

#endif
