#ifndef voussoir_grid_grid_h
#define voussoir_grid_grid_h

#include <voussoir/grid/grid_parameters.h>
#include <voussoir/grid/partition_counts.h>
#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/distributed/tria_base.h>
#include <deal.II/grid/tria.h>

#include <functional>
#include <map>
#include <memory>

namespace Voussoir
{
  class CellsAndRing;

  /** The longest edge of a cell [m]. */
  double
  longest_edge(const dealii::Triangulation<3>::cell_iterator &cell);

  /** Material and cell sets of a cell. */
  struct CellTag
  {
    unsigned int              material; // number
    std::vector<unsigned int> sets;     // numbers of cell sets, ascending
  };

  /** The cells that "Refine where" has refined; zeros: it is not given. */
  struct RefinementSummary
  {
    unsigned long long before = 0, after = 0;  // cells of the mesh
    unsigned long long chosen = 0;             // before refinement
    unsigned long long fine = 0, too_long = 0; // in the place of these
    double             longest = 0.;           // edge of those [m]
    dealii::Point<3>   lower, upper; // of the box around the chosen ones [m]

    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &before &after &chosen &fine &too_long &longest &lower &upper;
    }
  };

  /**
   * The distributed triangulation with its materials and named sets.
   *
   * Materials and sets are those of the coarse mesh; refined cells and faces
   * belong to the material and the sets of the coarse cell or face they lie in.
   * deal.II's material_id of a cell is the number of its tag: there is one tag
   * for each combination of material and sets that occurs. Set names are
   * checked when they are looked up, with the known names in the message.
   *
   * Cells of a mesh with a chart are refined in its coordinates, and then all
   * vertices are moved to their places in space; hanging ones to the middle of
   * the edge or face they hang on, so that no gap opens beside them.
   */
  class Grid
  {
  public:
    using Triangulation = dealii::parallel::DistributedTriangulationBase<3>;
    using Cell          = dealii::Triangulation<3>::cell_iterator;

    using ActiveCell = dealii::Triangulation<3>::active_cell_iterator;

    struct Materials
    {
      std::vector<unsigned int> of_cell; // number, of each coarse cell
      std::vector<double>       costs;   // of a cell of each, to balance ranks
      std::vector<double>
        longest_edges; // of the edges that cells of each may have [m]

      /** The same where cracks are expected; infinite: any [m]. */
      std::vector<double> crack_edges = {};

      /** Where cracks are expected by another run; null: anywhere. */
      std::shared_ptr<const CellsAndRing> stressed = nullptr;

      /** What a face of each of these face sets costs beside its cell. */
      std::map<std::string, double> face_costs = {};
    };

    /** If METIS or a curve divides the mesh, only the first rank of each
     *  machine needs its cells; the others need the names of its sets and their
     *  faces. */
    Grid(const CoarseMesh     &mesh,
         const GridParameters &parameters,
         const Materials      &materials,
         const MPI_Comm        communicator);

    /** A grid of one material. */
    Grid(const CoarseMesh     &mesh,
         const GridParameters &parameters,
         const MPI_Comm        communicator);

    const Triangulation &
    triangulation() const;

    MPI_Comm
    communicator() const;

    /** Number of a cell's material. */
    unsigned int
    material(const Cell &cell) const
    {
      return all_tags[cell->material_id()].material;
    }

    const std::vector<CellTag> &
    tags() const;

    /** Names of the cell sets that a cell is in. */
    std::vector<std::string>
    sets_of(const Cell &cell) const;

    /** For each tag, whether cells with it are in any of these cell sets. */
    std::vector<bool>
    tags_in(const std::vector<std::string> &cell_sets) const;

    /** A face of a cell of this rank, or of a neighbouring cell. */
    struct Face
    {
      ActiveCell   cell;
      unsigned int face;
    };

    /** Faces of a face set, in the order of the cells and their faces; none if
     *  the mesh has no such set. */
    const std::vector<Face> &
    faces(const std::string &face_set) const;

    /** Whether this face of the cell lies in the named face set. */
    bool
    in_face_set(const ActiveCell  &cell,
                const unsigned int face,
                const std::string &name) const;

    /** Calls @p visit for each locally owned cell and face of the set. */
    void
    for_each_face(const std::string                             &name,
                  const std::function<void(const ActiveCell &,
                                           const unsigned int)> &visit) const;

    /** Number of an active cell among the locally owned ones, from zero, in
     *  their order. */
    unsigned int
    owned_cell(const Cell &cell) const;

    const std::vector<std::string> &
    cell_set_names() const;

    const std::vector<std::string> &
    face_set_names() const;

    /** Refuses a name that is no cell set; @p place names the entry. */
    void
    check_cell_set(const std::string &name, const std::string &place) const;

    /** Refuses a name that is no face set; @p place names the entry. */
    void
    check_face_set(const std::string &name, const std::string &place) const;

    const RefinementSummary &
    refinement() const;

    /** "by p4est", for example. */
    const std::string &
    partition() const;

    /** For the numbers of ranks that the parameters ask for. */
    const std::vector<PartitionCounts> &
    partition_counts() const;

    /** Cells per rank (smallest, mean, largest), for the log. */
    std::string
    describe_balance() const;

    /**
     * A number for a cell that does not depend on the partition: its coarse
     * cell and the path of children below it.
     */
    static std::uint64_t
    global_key(const Cell &cell);

  private:
    /** Numbers of the tags of the coarse cells. */
    std::vector<dealii::types::material_id>
    make_tags(const CoarseMesh                &coarse,
              const std::vector<unsigned int> &materials);

    void
    create_p4est(const CoarseMesh                              &coarse,
                 const std::vector<dealii::types::material_id> &tags,
                 const GridParameters                          &parameters,
                 const Materials                               &materials);

    void
    create_along_curve(const CoarseMesh                              &coarse,
                       const std::vector<dealii::types::material_id> &tags,
                       const GridParameters &parameters,
                       const Materials      &materials);

    /** Sends the tags from the first rank, since others may lack the coarse
     *  cells. */
    void
    share_tags();

    void
    create_metis(const CoarseMesh                              &coarse,
                 const std::vector<dealii::types::material_id> &tags,
                 const GridParameters                          &parameters,
                 const Materials                               &materials);

    /** By the numbers of the active cells, of those that are not artificial. */
    std::vector<double>
    costs_of_active_cells(const dealii::Triangulation<3> &triangulation,
                          const CoarseMesh               &coarse,
                          const Materials                &materials) const;

    /** Counts the partitions by METIS of a mesh that is not distributed, into
     *  the given numbers of ranks; it changes the ranks of the cells.
     *  @param costs of the cells */
    void
    count_by_metis(dealii::Triangulation<3>        &serial,
                   const std::vector<unsigned int> &n_ranks,
                   const std::vector<double>       &costs);

    void
    find_faces(const CoarseMesh &coarse);

    /** Makes the coarse triangulation, in the coordinates of the chart if the
     *  mesh has one. */
    void
    create_coarse(const CoarseMesh                              &coarse,
                  const std::vector<dealii::types::material_id> &tags,
                  dealii::Triangulation<3> &triangulation) const;

    /** @param machines whose memory the mesh must fit into */
    RefinementSummary
    refine(dealii::Triangulation<3> &triangulation,
           const CoarseMesh         &coarse,
           const GridParameters     &parameters,
           const Materials          &materials,
           const double              machines) const;

    using ActiveCells = std::function<bool(const ActiveCell &)>;

    /** Refines own cells, and cells at interfaces so that both sides have the
     *  same faces; returns whether there were any.
     *  @param place names the entry that wants it */
    bool
    refine_cells(dealii::Triangulation<3> &triangulation,
                 const CoarseMesh         &coarse,
                 const ActiveCells        &are_wanted,
                 const std::string        &place,
                 const double              machines) const;

    /** Refines the cells whose edges are too long for their material; returns
     *  whether there were any. */
    bool
    refine_for_waves(dealii::Triangulation<3> &triangulation,
                     const CoarseMesh         &coarse,
                     const Materials          &materials,
                     const double              machines) const;

    RefinementSummary
    refine_where(dealii::Triangulation<3>    &triangulation,
                 const CoarseMesh            &coarse,
                 const RefineWhereParameters &parameters,
                 const Materials             &materials,
                 const double                 machines) const;

    MPI_Comm                       mpi_communicator;
    std::string                    partition_name;
    std::unique_ptr<Triangulation> mesh;

    std::vector<std::string>       cell_sets, face_sets;
    std::vector<CellTag>           all_tags;
    std::vector<std::vector<Face>> faces_of_set; // the last: of no set

    RefinementSummary            refined_where;
    std::vector<PartitionCounts> counts;
  };
} // namespace Voussoir

#endif
