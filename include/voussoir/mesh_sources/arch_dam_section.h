#ifndef voussoir_mesh_sources_arch_dam_section_h
#define voussoir_mesh_sources_arch_dam_section_h

#include <voussoir/mesh_sources/arch_dam_shape.h>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Voussoir
{
  /** Extent of the rock around a dam, and growth of its cells outwards. */
  struct RockGrading
  {
    double extent;       // over the height of the dam
    double growth;       // size ratio of successive cells
    double largest_cell; // at which they stop growing [m]
  };

  /**
   * Quadrilaterals on the developed section across the canyon: arc length s
   * along the crest and elevation z [m], inside and outside of the canyon.
   *
   * They come from a grid of columns and rows in which the contour of the
   * canyon runs along the rows or diagonally through cells, which fall into
   * triangles; all cells are then halved in both directions, and a layer of
   * quadrilaterals is added on each side of the contour. One row can be made
   * level, as the surface of a reservoir, and one row in each bank be moved
   * onto a plane, the base plane of a wedge of rock.
   */
  class ArchDamCrossSection
  {
  public:
    /** A row that lies on a plane inside a bank, from the point where a column
     *  meets the contour to an upright column. */
    struct Ledge
    {
      std::string place;     // of its entries, to be named in messages
      double elevation = 0.; // of its foot at the dam's middle; 0 for none [m]
      double width     = 0.; // wanted [m]
      double laid      = 0.; // actual width, along the crest [m]
      double length    = 0.; // of the plane, downstream of the dam [m]
      dealii::Tensor<1, 2> slope; // by which it rises along x and y [-]

      // columns at its two ends, and its row; -1 if there is none
      int foot_column = -1, side_column = -1, row = -1;

      dealii::Point<2> foot; // x, y at the dam's middle [m]

      bool
      dips() const
      {
        return slope.norm() > 0.;
      }

      /** Elevation of its plane. */
      double
      level(const dealii::Point<2> &x) const
      {
        return elevation + slope * (x - foot);
      }
    };

    /**
     * @param n_blocks          between the abutments at the crest
     * @param columns_per_block columns of the grid
     * @param row_height        wanted for its rows [m]; 0 for the columns'
     *   width. Rows are higher where a bank rises more over a column.
     * @param rock              whose columns and rows grow; each is halved
     *   later
     * @param water_level       wanted for the surface of a reservoir [m]; 0
     *                          for no reservoir
     * @param ledges            wanted in the right and the left bank
     */
    ArchDamCrossSection(const ArchDamSections      &sections,
                        const double                height,
                        const unsigned int          n_blocks,
                        const unsigned int          columns_per_block,
                        const double                row_height,
                        const RockGrading          &rock,
                        const double                water_level,
                        const std::array<Ledge, 2> &ledges);

    struct Vertex
    {
      double s, z;
      int    column; // -1 between two columns
    };

    struct Quad
    {
      std::array<unsigned int, 4> vertices;      // counterclockwise for s, z
      unsigned int                column;        // on its right-bank side
      int                         half_row;      // from below; inside only
      bool                        inside;        // of the canyon
      double                      width, height; // wanted [m]
    };

    /** Position of a ledge in one layer of the sweep. */
    struct LedgeLine
    {
      double                              foot;  // s [m]
      std::function<double(const double)> level; // elevation by s [m]
    };

    /** The mesh at the middle of the dam. */
    std::vector<Vertex> vertices;
    std::vector<Quad>   quads;

    /** Height of the dam's quadrilaterals, which is half of a row's, and their
     *  mean length along the crest [m]. */
    std::pair<double, double>
    height_and_length() const;

    /** Elevations of the dam's rows of quadrilaterals from base to crest [m],
     *  the first of which has the half_row first_half_row(). Next to the banks
     *  and to the surface of a reservoir they bend. */
    std::vector<double>
    elevations() const;

    int
    first_half_row() const
    {
      return 2 * base_row;
    }

    /** The line of a ledge at the middle of the dam. */
    LedgeLine
    middle_line(const unsigned int bank) const;

    /**
     * Moves vertices near @p lines, of both banks, onto them, and the others so
     * that the quadrilaterals are little distorted. Vertices on the contour
     * stay on it, and with @p in_dam vertices of joints stay in their columns.
     */
    void
    follow(const std::array<LedgeLine, 2> &lines,
           const bool                      in_dam,
           std::vector<Vertex>            &moved) const;

    /** Throws UserError, which names a ledge, if quadrilaterals in its bank are
     *  nearly flat. */
    void
    check_shapes(const std::vector<Vertex> &moved) const;

    /** Columns of the crest's two ends, and the last one; the first is 0. */
    int first_dam_column, last_dam_column, last_column;

    /** The surface of the reservoir: it covers the quadrilaterals inside the
     *  canyon with a lower half_row; -1 without reservoir. */
    int surface_row = -1;

    /** Ledges in the right and the left bank. */
    std::array<Ledge, 2> ledges;

  private:
    void
    place_columns(const unsigned int n_dam_columns, const RockGrading &rock);

    /** Moves the columns of a bank so that one meets the foot of its ledge. */
    void
    place_foot(Ledge &ledge, const int bank);

    void
    place_rows(const double wanted, const RockGrading &rock);

    void
    step_rows();

    void
    follow_contour();

    void
    lay_surface(const double water_level);

    /** @param bank -1 for the right one, 1 for the left */
    void
    lay_ledge(Ledge &ledge, const int bank);

    void
    make_quads();

    void
    subdivide(const std::vector<unsigned int> &corners,
              const unsigned int               column,
              const unsigned int               row,
              const bool                       inside);

    unsigned int
    middle(const unsigned int a, const unsigned int b);

    /** Adds a layer of quadrilaterals on each side of the contour. */
    void
    line_contour();

    // Edge e of a quadrilateral runs from its vertex e to the next.
    struct Side
    {
      unsigned int quad, edge;
    };

    /** Adds a layer between the @p sides, all on the contour, and the vertices
     *  beyond them, @p inside of the canyon or in the rock. */
    void
    add_layer(const std::vector<Side> &sides, const bool inside);

    /** Whether the layer at @p v grows towards its neighbour @p u. */
    bool
    layer_leads(const unsigned int v,
                const unsigned int u,
                const bool         inside) const;

    /** A new vertex between @p v and a vertex @p beyond. */
    unsigned int
    copy_vertex(const unsigned int v,
                const unsigned int beyond,
                const bool         inside);

    [[noreturn]] void
    refuse_daylight(const Ledge &ledge, const double distance) const;

    /** Moves vertices to where the quadrilaterals are least distorted.
     *
     *  @param joint_stays whether vertices in the columns of joints stay there
     */
    void
    smooth(const std::array<LedgeLine, 2> &lines,
           const std::vector<bool>        &joint_stays,
           const unsigned int              n_steps,
           std::vector<Vertex>            &moved) const;

    /** The ends of the crest, of ledges and of the rock stay where they are,
     *  and so do vertices of joints where they are fixed. */
    bool
    may_move_along(const unsigned int       vertex,
                   const std::vector<bool> &joint_stays) const;

    bool
    may_move_up(const unsigned int vertex, const double z) const;

    const ArchDamSections &sections;
    const double           height;
    const int              columns_per_block;

    // The grid: s and contour elevation of the columns, elevation of the rows.
    std::vector<double> columns, contour, rows;
    int                 base_row;

    // The row of each column that lies on the contour.
    std::vector<int> contour_rows;

    // The reservoir's surface: elevation, and columns at which it is level.
    double              surface_level = 0.;
    std::pair<int, int> surface_columns;

    std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
    std::vector<bool> on_contour, on_surface, on_ledge, in_canyon;
  };
} // namespace Voussoir

#endif
