#ifndef voussoir_output_face_mesh_h
#define voussoir_output_face_mesh_h

#include <voussoir/files/vtu_file.h>
#include <voussoir/output/stress_points.h>

#include <map>

namespace Voussoir
{
  /** The surface mesh of some face sets. */
  class FaceMesh
  {
  public:
    /**
     * @param sets      face sets, each checked: at least one, and of the mesh
     * @param place     names the entry with them
     * @param kind      their name in VTU files, "face_set" or "interface"
     * @param all_names of that kind, which give the sets their numbers there
     */
    FaceMesh(const Discretization           &discretization,
             const std::vector<std::string> &sets,
             const std::string              &place,
             const std::string              &kind,
             const std::vector<std::string> &all_names);

    MPI_Comm
    communicator() const;

    /** Nodes of the owned faces; a node of two sets counts twice. */
    unsigned int
    n_nodes() const;

    const dealii::Point<3> &
    position(const unsigned int node) const;

    /** Whether faces are level somewhere, where arch and cantilever have no
     *  direction. All ranks must call this together. */
    bool
    is_level() const;

    /** Refuses level faces; @p place names the entry with them. All ranks must
     *  call this together. */
    void
    check_not_level(const std::string &place) const;

    /** Directions of arch, along the horizontal, and cantilever, along the
     *  steepest line, at a node. */
    std::array<dealii::Tensor<1, 3>, 2>
    arch_and_cantilever(const unsigned int node) const;

    /** Part of an owned face between four neighbouring nodes, in lexicographic
     *  order of the directions of the face. */
    struct Quadrilateral
    {
      unsigned int                set;
      std::array<unsigned int, 4> nodes;
    };

    /** All quadrilaterals. */
    std::vector<Quadrilateral>
    quadrilaterals() const;

    /** The corner of each cell with a face at a node, and the node. */
    const std::vector<StressPoints::Place> &
    places() const;

    const std::vector<unsigned int> &
    nodes_of_places() const;

    /** A vector of @p width numbers for each node, with ghosts. */
    Vector
    make_vector(const unsigned int width) const;

    /** Replaces sums over the places of each node on this rank by the means
     * over all its places, @p width numbers a node; all ranks must call this
     * together.
     *  @param work of make_vector() */
    void
    mean_over_places(Vector              &work,
                     const unsigned int   width,
                     std::vector<double> &values) const;

    /** Numbers of the nodes for a checkpoint, by the name of the set.
     *
     *  @param values @p width numbers of each node
     *  @param what   follows the name */
    std::map<std::string, KeyedValues>
    keyed_values(std::vector<double> &values,
                 const unsigned int   width,
                 const std::string   &what = "") const;

    using SetAndNode = std::pair<unsigned int, dealii::types::global_dof_index>;

    /** Set and global node of each node. */
    const std::vector<SetAndNode> &
    sets_and_nodes() const;

    /**
     * Writes values of the nodes as one VTU file into the folder of a run, with
     * the numbers of the sets and their names. All ranks must call this
     * together.
     *
     * @param fields names of the values
     * @param values @p fields.size() numbers for each node
     * @param name   of the file in the output folder, without extension
     * @param time   [s]
     * @param texts  further texts for the file
     * @return its name in the output folder; empty if it cannot be written
     */
    std::string
    write(const ObservedRun              &run,
          const std::vector<std::string> &fields,
          const std::vector<double>      &values,
          const std::string              &name,
          const double                    time,
          const std::vector<VtuText>     &texts = {}) const;

  private:
    /** A place in an owned cell, by a key that does not depend on the ranks,
     *  and its node. */
    struct Key
    {
      unsigned int  set;
      std::uint64_t key;
      unsigned int  node;
    };

    using NodeNumbers = std::map<SetAndNode, unsigned int>;

    /** Nodes and positions gathered in a loop over the faces. */
    struct Places
    {
      NodeNumbers nodes;

      /** Of each node the number of places and the sum of their outward unit
       *  normals. */
      std::vector<double> normals;
    };

    /** Adds the nodes of a face in lexicographic order. */
    void
    add_face(const unsigned int          set,
             const Discretization::Cell &cell,
             const unsigned int          face,
             Places                     &places);

    /** Means over the places of each node, of all ranks. */
    void
    find_normals(const std::vector<double> &normals_of_nodes);

    /** Sums @p width numbers of each node over the ranks that hold it. */
    void
    sum_over_holders(Vector                    &sums,
                     const unsigned int         width,
                     const std::vector<double> &values) const;

    /** Agrees with the other ranks on numbers for the nodes. */
    void
    number_nodes(const NodeNumbers &nodes, const unsigned int n_sets);

    const Discretization          &discretization;
    const std::string              kind;
    const std::vector<std::string> all_names;
    std::vector<unsigned int>      number_of_set; // in all_names

    std::vector<dealii::Point<3>>     positions;
    std::vector<dealii::Tensor<1, 3>> normals; // outward, mean
    std::vector<unsigned int>         n_places_of_node;
    std::vector<StressPoints::Place>  all_places;
    std::vector<unsigned int>         node_of_place;
    std::vector<Key>                  place_keys;
    std::vector<SetAndNode>           set_and_node;
    std::vector<unsigned int>         set_of_face;

    // numbers of the nodes that are the same on all ranks
    std::vector<dealii::types::global_dof_index> numbers;
    dealii::types::global_dof_index n_numbers, first_owned, n_owned;

    std::vector<unsigned int> entries; // of the nodes in a vector
  };

  /**
   * The stress at the nodes of a face mesh: the mean over the cells with a face
   * of the set at the node, each evaluated at the node itself. For trilinear
   * cells the strain along the face is constant in each cell, so that the mean
   * is the central difference, of second order; extrapolation from the 2x2x2
   * Gauss points would give the same values. Across the face the cell's own
   * strain is kept: with it the stresses balance the loads.
   */
  class FaceStress
  {
  public:
    /** @param mesh must live as long as this */
    FaceStress(const StressModel &model, const FaceMesh &mesh);

    /** Stress of the equation of motion at each node [Pa]; all ranks must call
     *  this together. */
    const std::vector<dealii::SymmetricTensor<2, 3>> &
    evaluate(const State &state);

  private:
    const FaceMesh                            &mesh;
    StressPoints                               points;
    Vector                                     sums;
    std::vector<double>                        components;
    std::vector<dealii::SymmetricTensor<2, 3>> means;
  };
} // namespace Voussoir

#endif
