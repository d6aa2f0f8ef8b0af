#ifndef voussoir_grid_grid_h
#define voussoir_grid_grid_h

#include <voussoir/base/option.h>
#include <voussoir/mesh/coarse_mesh.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/distributed/tria_base.h>

#include <functional>
#include <memory>

namespace Voussoir
{
  enum class Partition
  {
    p4est,
    metis
  };

  inline OptionNames<Partition>
  option_names(const Partition)
  {
    return {{Partition::p4est, "p4est"}, {Partition::metis, "METIS"}};
  }


  /** The entries of the section "Mesh" that do not depend on where it comes
   *  from. */
  struct GridParameters
  {
    unsigned int global_refinement = 0;
    std::string  local_refinement;
    Partition    partition = Partition::p4est;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /**
   * The distributed triangulation with its named sets.
   *
   * The sets are those of the coarse mesh; refined cells and faces belong to
   * the sets of the coarse cell or face they lie in. Set names are checked when
   * they are looked up, with the known names in the message.
   */
  class Grid
  {
  public:
    using Triangulation = dealii::parallel::DistributedTriangulationBase<3>;
    using Cell          = dealii::Triangulation<3>::cell_iterator;

    /**
     * @param cost_of_cell relative cost of a cell of the set with this index in
     *   cell_set_names(), used to balance the ranks
     */
    Grid(const CoarseMesh                                &mesh,
         const GridParameters                            &parameters,
         const std::function<double(const unsigned int)> &cost_of_coarse_cell,
         const MPI_Comm                                   communicator);

    const Triangulation &
    triangulation() const;

    MPI_Comm
    communicator() const;

    /** Whether the cell lies in the named cell set. */
    bool
    in_cell_set(const Cell &cell, const std::string &name) const;

    /** Whether this face of the cell lies in the named face set. */
    bool
    in_face_set(const Cell        &cell,
                const unsigned int face,
                const std::string &name) const;

    /** Calls @p visit for each locally owned cell and face of the set. */
    void
    for_each_face(const std::string &name,
                  const std::function<
                    void(const dealii::Triangulation<3>::active_cell_iterator &,
                         const unsigned int)> &visit) const;

    const std::vector<std::string> &
    cell_set_names() const;

    const std::vector<std::string> &
    face_set_names() const;

    /** Refuses a name that is no cell set; @p place says where it was read. */
    void
    check_cell_set(const std::string &name, const std::string &place) const;

    /** Refuses a name that is no face set; @p place says where it was read. */
    void
    check_face_set(const std::string &name, const std::string &place) const;

    /** Cells per rank (smallest, mean, largest), for the log. */
    std::string
    describe_balance() const;

    /** Index in the coarse mesh of the coarse cell that a cell lies in. */
    static unsigned int
    coarse_cell(const Cell &cell);

    /**
     * A number for a cell that does not depend on the partition: its coarse
     * cell and the path of children below it.
     */
    static std::uint64_t
    global_key(const Cell &cell);

  private:
    void
    create_p4est(const CoarseMesh                                &coarse,
                 const GridParameters                            &parameters,
                 const std::function<double(const unsigned int)> &cost);

    void
    create_metis(const CoarseMesh                                &coarse,
                 const GridParameters                            &parameters,
                 const std::function<double(const unsigned int)> &cost);

    void
    refine(dealii::Triangulation<3> &triangulation,
           const GridParameters     &parameters) const;

    MPI_Comm                       mpi_communicator;
    std::unique_ptr<Triangulation> mesh;

    std::vector<std::string> cell_sets, face_sets;
    // by coarse cell: the sets it is in, and those of its faces
    std::vector<std::vector<unsigned char>> sets_of_cell;
    struct FaceInSet
    {
      unsigned char face;
      unsigned int  set;
    };
    std::vector<std::vector<FaceInSet>> sets_of_faces;
  };
} // namespace Voussoir

#endif
