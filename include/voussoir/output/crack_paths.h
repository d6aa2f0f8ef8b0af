#ifndef voussoir_output_crack_paths_h
#define voussoir_output_crack_paths_h

#include <voussoir/fem/discretization.h>

#include <bitset>

namespace Voussoir
{
  /** A path through cracked cells from one face to the other. */
  struct CrackPath
  {
    double           opening = 0.; // the smallest along the path [mm]
    dealii::Point<3> where;        // its place [m]
  };


  /**
   * Paths through cracked cells from one face of a dam to the other. A cell
   * cracks by eighths, one at each corner. Eighths of one cell are neighbours
   * unless they lie across its middle; eighths of two cells are neighbours if
   * an edge of both cells begins in their corner.
   *
   * Each rank connects its own eighths in the order of their openings
   * (Kruskal's algorithm) and sends the connections between edges that it
   * shares with other ranks, and the two faces: the data exchanged grow with
   * the cracks at the borders of the ranks, not with those inside.
   */
  class CrackPaths
  {
  public:
    using Cell = Discretization::Cell;

    /**
     * @param touching corners of each owned cell that lie on the two faces
     */
    CrackPaths(const Discretization                             &discretization,
               const std::vector<std::array<std::bitset<8>, 2>> &touching);

    /** Number of a cracked cell, in the order of the first calls; its eighths
     *  are numbered from eight times this number on. */
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
    /** An edge of the mesh: its first vertex, and its direction in thousandths,
     *  as edges of cells of other sizes may begin at the same vertex. */
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

    /** Two edges, or faces, connected by eighths of one rank. */
    struct Joint
    {
      double                opening; // of the narrowest eighth [mm]
      std::array<double, 3> where;   // its place [m]
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

    // by number; the direction is `nowhere` if no other rank can have the edge
    std::vector<Edge> shared_edges;
  };
} // namespace Voussoir

#endif
