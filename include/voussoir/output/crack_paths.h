#ifndef voussoir_output_crack_paths_h
#define voussoir_output_crack_paths_h

#include <voussoir/fem/discretization.h>

#include <bitset>

namespace Voussoir
{
  /** A path through cracked cells from one face to the other. */
  struct CrackPath
  {
    double           opening = 0.; // smallest opening along it [mm]
    dealii::Point<3> where;        // that is [m]
  };


  /**
   * Paths through cracked cells from one face of a dam to the other. A cell
   * cracks by eighths, one at each corner. Eighths of one cell are next to each
   * other unless they lie across its middle, those of two cells if an edge of
   * both begins in their corner.
   *
   * Each rank joins its own eighths in the order of their openings (Kruskal's
   * algorithm) and passes on the joints between edges that it shares with
   * others, and the two faces: what is exchanged grows with the cracks at the
   * borders of the ranks, not with those within.
   */
  class CrackPaths
  {
  public:
    using Cell = Discretization::Cell;

    /**
     * @param touching of each owned cell, which corners lie on the two faces
     */
    CrackPaths(const Discretization                             &discretization,
               const std::vector<std::array<std::bitset<8>, 2>> &touching);

    /** Number of a cracked cell, in the order in which they were first asked
     *  for; its eighths have the numbers from eight times that on. */
    unsigned int
    number_of(const Cell &cell);

    /** Eighths of all cells that have a number. */
    unsigned int
    n_eighths() const;

    /**
     * The path on which the smallest opening is largest, if that is above
     * @p least; else an opening of zero. All ranks must call this together.
     *
     * @param openings of the eighths [mm]
     */
    CrackPath
    widest(const std::vector<double> &openings, const double least) const;

  private:
    /** An edge of the mesh: where it begins, and its direction in thousandths,
     *  as those of cells of other size begin there too. */
    struct Edge
    {
      dealii::types::global_dof_index node;
      std::array<int, 3>              direction;

      bool
      operator<(const Edge &other) const
      {
        return std::tie(node, direction) <
               std::tie(other.node, other.direction);
      }
    };

    /** Two edges, or faces, that are joined by eighths of one rank. */
    struct Joint
    {
      double                opening; // of the narrowest of them [mm]
      std::array<double, 3> where;   // that is [m]
      std::array<Edge, 2>   ends;
    };

    struct CrackedCell
    {
      std::array<std::array<unsigned int, 3>, 8> edges; // by their numbers
      std::array<dealii::Point<3>, 8>            corners;
      std::array<std::bitset<8>, 2>              touching;
    };

    std::vector<Joint>
    own_joints(const std::vector<double> &openings, const double least) const;

    const Discretization                             &discretization;
    const std::vector<std::array<std::bitset<8>, 2>> &touching;

    std::vector<bool>            is_shared; // vertices, with other ranks
    std::vector<unsigned int>    number_of_cell;
    std::vector<CrackedCell>     cells;
    std::map<Edge, unsigned int> number_of_edge;

    // by their numbers; `nowhere` unless another rank may have them
    std::vector<Edge> shared_edges;
  };
} // namespace Voussoir

#endif
