#ifndef voussoir_fem_discretization_h
#define voussoir_fem_discretization_h

#include <voussoir/base/option.h>
#include <voussoir/fem/simd.h>
#include <voussoir/grid/grid.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/matrix_free/matrix_free.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace Voussoir
{
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  enum class QuadratureRule
  {
    gauss,
    gauss_lobatto,
    one_point,
    one_point_where_elastic
  };

  inline OptionNames<QuadratureRule>
  option_names(const QuadratureRule)
  {
    return {{QuadratureRule::gauss, "Gauss"},
            {QuadratureRule::gauss_lobatto, "Gauss-Lobatto"},
            {QuadratureRule::one_point, "one point"},
            {QuadratureRule::one_point_where_elastic,
             "one point where elastic"}};
  }


  /** How contributions of cells and faces to a node are summed. */
  enum class Sums
  {
    as_dealt,
    reproducible
  };

  inline OptionNames<Sums>
  option_names(const Sums)
  {
    return {{Sums::as_dealt, "as dealt"}, {Sums::reproducible, "reproducible"}};
  }


  /** Arithmetic of the internal forces of trilinear cells in the time loop. */
  enum class CellPrecision
  {
    single_precision,
    double_precision
  };

  inline OptionNames<CellPrecision>
  option_names(const CellPrecision)
  {
    return {{CellPrecision::single_precision, "single"},
            {CellPrecision::double_precision, "double"}};
  }


  /** The entries of the section "Discretization". */
  struct DiscretizationParameters
  {
    unsigned int   degree     = 1;
    QuadratureRule quadrature = QuadratureRule::gauss;
    Sums           sums       = Sums::as_dealt;
    CellPrecision  precision  = CellPrecision::double_precision;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether cells have one integration point, of a material with internal
     *  variables or of one without. */
    bool
    one_point(const bool has_memory) const;

    /** Cost of a cell of such a material relative to the others, to balance the
     *  ranks. */
    double
    relative_cost(const bool has_memory) const;

    /** The same of a face of the absorbing boundary, or of one side of an
     *  interface. */
    double
    relative_cost_of_face() const;
  };

  /** A face set on which displacement components are fixed at zero: all three,
   *  the normal one (roller, plane of symmetry), or the two tangential ones
   *  (plane of antisymmetry). */
  struct Support
  {
    enum class Fixed
    {
      all,
      normal,
      tangential
    };

    std::string set;
    Fixed       fixed;
  };

  /**
   * Displacement space, constraints and matrix-free data, built once.
   *
   * The three displacement components of a node have consecutive numbers that
   * start at a multiple of three, so "node i" of a rank means entries 3i, 3i+1,
   * 3i+2 of its vectors, and a global node index is a global degree of freedom
   * divided by three. Nodes are numbered in the order in which the cell loop
   * meets them, which keeps them in the cache.
   */
  class Discretization
  {
  public:
    using Cell = dealii::DoFHandler<3>::active_cell_iterator;

    struct MatrixFree : dealii::MatrixFree<3, double, Lanes>
    {
      /** Whether cells are trilinear: their corners are all the geometry that
       *  they need. */
      bool trilinear = false;

      /** Positions of the nodes, in the layout of vectors with ghost entries
       *  [m]; see BatchNodes::read_corners. */
      dealii::AlignedVector<double> positions;

      /** Corners of the batches that cannot read them from there, and for each
       *  batch its place among these, or an invalid number. Component d of
       *  corner v is entry 8 d + v [m]. */
      using Corners = std::array<Lanes, 24>;
      dealii::AlignedVector<Corners> own_corners;
      std::vector<unsigned int>      place_of_own_corners;

      /** Corners of each batch in single precision, relative to the first one.
       */
      using SingleCorners = dealii::AlignedVector<std::array<HalfSingles, 24>>;

      /** Result of Discretization::single_corners(), as long as a caller holds
       *  it. */
      mutable std::weak_ptr<const SingleCorners> single_corners;

      /** Integration points of cells that have more than one. */
      dealii::Quadrature<3> quadrature;

      /** For each batch of trilinear cells, the first vector entry of each node
       *  in each lane, if nodes can be read and written as a whole; else null.
       *  Four vector entries at once take a third of the time that deal.II
       *  needs entry by entry. */
      std::vector<const unsigned int *> node_entries;

      std::vector<unsigned int> entries; // to which node_entries point
    };

    /**
     * @param has_memory whether the law of each material has internal
     * variables; those beyond the list have none
     */
    Discretization(const Grid                     &grid,
                   const DiscretizationParameters &parameters,
                   const std::vector<Support>     &supports,
                   const std::vector<bool>        &has_memory = {});

    const Grid        &grid;
    const unsigned int degree;
    /** Whether results must not depend on the partition, bit for bit. */
    const bool reproducible;
    /** Whether the time loop computes internal forces in single precision where
     *  it can; the smoother of the static solver always does. */
    const bool single_precision;
    /** Of all cells, if results are reproducible [m]. */
    double longest_edge = 0.;
    /** Share of the width of a cell that a crack takes. */
    double                            crack_share;
    const dealii::FESystem<3>         fe;
    const dealii::MappingQ1<3>        mapping;
    dealii::DoFHandler<3>             dof_handler;
    dealii::AffineConstraints<double> hanging_nodes;
    /** Hanging nodes and supports. The matrix-free data contain the hanging
     *  nodes only: at a fixed node the internal force is the reaction, and the
     *  mass is zero. */
    dealii::AffineConstraints<double> constraints;
    dealii::IndexSet                  owned_dofs, relevant_dofs;
    MatrixFree                        matrix_free;

    /** Material of each cell batch of the matrix-free data, which holds cells
     *  of one material only. */
    std::vector<unsigned int> material_of_batch;

    /** Where a cell is in the matrix-free data: one SIMD lane of a batch. */
    struct Place
    {
      unsigned int batch, lane;
    };

    /** Place of an owned cell. */
    Place
    place_of(const Cell &cell) const
    {
      return places[grid.owned_cell(cell)];
    }

    /** Whether the cells of a material have one integration point. */
    bool
    has_one_point(const unsigned int material) const;

    /** Integration points of the cells of a material. */
    const dealii::Quadrature<3> &
    points(const unsigned int material) const;

    /**
     * Corners of trilinear cells in single precision; forces can be computed in
     * single precision as long as a caller holds them. Null for cells of higher
     * degree and for reproducible sums: both are in double precision.
     */
    std::shared_ptr<const MatrixFree::SingleCorners>
    single_corners() const;

    /**
     * Constraints of hanging nodes, of these supports, and of all nodes of the
     * cells of the materials that are true in @p fixed_materials, if this is
     * not empty. Supports of the case are included only if given.
     */
    dealii::AffineConstraints<double>
    make_constraints(const std::vector<Support> &supports,
                     const std::vector<bool>    &fixed_materials = {}) const;

    /** Position of each owned node [m]. */
    std::vector<dealii::Point<3>> node_positions;

    /** A zero vector in the layout of the matrix-free data. */
    Vector
    create_vector() const;

    unsigned int
    n_owned_nodes() const;

    /** Local number of an owned node from its global index. */
    unsigned int
    owned_node(const dealii::types::global_dof_index global_node) const;

    /** Number of nodes shared with other ranks (largest over the ranks). */
    unsigned int
    largest_interface() const;

    /** A node whose value a hanging node interpolates, or a free node itself,
     *  with its weight. */
    struct Share
    {
      dealii::types::global_dof_index node;
      double                          weight;
    };

    /** The nodes that carry a value at this node: itself, or the masters of a
     *  hanging node. */
    std::vector<Share>
    carriers(const dealii::types::global_dof_index global_node) const;

    /** Global indices of a cell's nodes, in the order of the scalar element. */
    std::vector<dealii::types::global_dof_index>
    cell_nodes(const Cell &cell) const;

    /** A cell of the triangulation as one of the DoF handler. */
    Cell
    dof_cell(const dealii::Triangulation<3>::active_cell_iterator &cell) const;

    /**
     * Sends records to the ranks that own their nodes; records that arrive have
     * the local node. Their order does not depend on timing; if sums are
     * reproducible, the order of the records of each node does not depend on
     * the partition either. @p Record must be trivially copyable.
     */
    template <typename Record>
    std::vector<std::pair<unsigned int, Record>>
    send_to_owners(
      const std::vector<std::pair<dealii::types::global_dof_index, Record>>
        &records) const;

    /** The rank that owns a global node. */
    unsigned int
    owner(const dealii::types::global_dof_index global_node) const;

  private:
    void
    number_by_nodes();

    /** Keeps the corners of the cells, and frees the geometry that deal.II has
     *  computed for the cells. */
    void
    keep_corners_only();

    /** Sets MatrixFree::node_entries, and frees deal.II's own entries. */
    void
    find_node_entries();

    std::vector<dealii::types::global_dof_index> first_dof_of_rank;
    std::vector<Place>                           places; // of owned cells

    const DiscretizationParameters parameters;
    const std::vector<bool>        has_memory; // of each material
    const dealii::QMidpoint<3>     centre;

    // where the time loop needs them
    std::shared_ptr<const MatrixFree::SingleCorners> kept_single_corners;
  };


  template <typename Record>
  std::vector<std::pair<unsigned int, Record>>
  Discretization::send_to_owners(
    const std::vector<std::pair<dealii::types::global_dof_index, Record>>
      &records) const
  {
    static_assert(std::is_trivially_copyable_v<Record>);
    struct Item
    {
      dealii::types::global_dof_index node;
      Record                          record;
    };
    std::map<unsigned int, std::vector<char>> outgoing;
    const unsigned int                        rank =
      dealii::Utilities::MPI::this_mpi_process(grid.communicator());
    outgoing[rank].reserve(records.size() * sizeof(Item)); // most of them
    for (const auto &[node, record] : records)
      {
        Item item{node, record};
        __builtin_clear_padding(&item); // records are sorted by their bytes
        auto      &buffer = outgoing[owner(node)];
        const auto bytes  = reinterpret_cast<const char *>(&item);
        buffer.insert(buffer.end(), bytes, bytes + sizeof(Item));
      }
    // a map ordered by rank; records for this rank are not copied
    auto own = outgoing.extract(rank);
    auto incoming =
      dealii::Utilities::MPI::some_to_some(grid.communicator(), outgoing);
    incoming.insert(std::move(own));
    std::vector<const char *> items;
    for (const auto &buffer : incoming)
      for (std::size_t i = 0; i < buffer.second.size(); i += sizeof(Item))
        items.push_back(buffer.second.data() + i);
    // sorted, so that the order of the records of a node is reproducible
    if (reproducible)
      std::sort(items.begin(), items.end(), [](const char *a, const char *b) {
        return std::memcmp(a, b, sizeof(Item)) < 0;
      });
    std::vector<std::pair<unsigned int, Record>> arrived;
    arrived.reserve(items.size());
    for (const char *const bytes : items)
      {
        Item item;
        std::memcpy(&item, bytes, sizeof(Item));
        arrived.emplace_back(owned_node(item.node), item.record);
      }
    return arrived;
  }
} // namespace Voussoir

#endif
