#include <voussoir/base/error.h>
#include <voussoir/base/machine.h>
#include <voussoir/fem/discretization.h>
#include <voussoir/mesh/mesh_check.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>


namespace Voussoir
{
  using namespace dealii;

  void
  DiscretizationParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Degree",
                      degree,
                      "Polynomial degree of the displacement; 1 is fastest per "
                      "unknown, 2 to 4 are more accurate per unknown.",
                      Patterns::Integer(1, 4));
    add_option(
      prm,
      "Quadrature",
      quadrature,
      "Integration points of the stiffness: Gauss or Gauss-Lobatto points, "
      "degree + 1 in each direction, or one point in the centre of cells of "
      "degree 1, stabilised by elastic stiffness against bending within the "
      "cell. With one point a step costs about half, and walls of one or two "
      "cells bend as they should, while full integration at degree 1 makes "
      "them too stiff; but damage follows the mean strain of a cell only, and "
      "a damaged cell keeps its stiffness against bending. Where concrete "
      "cracks, full integration or several cells through the wall are needed. "
      "\"One point where elastic\" has one point in materials that stay "
      "elastic and Gauss points in those that crack or yield: for a dam in a "
      "large rock mass. Gauss-Lobatto points at degree 1 are exact in cells "
      "with parallel sides only: in irregular cells a uniform stress errs by up "
      "to a tenth. The mass is always lumped at the Gauss-Lobatto nodes.");
    add_option(
      prm,
      "Sums",
      sums,
      "As dealt: contributions of cells to a node are summed in the order of "
      "the partition, so that results on other numbers of ranks differ by "
      "round-off, which pounding of cracks and joints amplifies. "
      "Reproducible: results do not depend on the number of ranks, bit for "
      "bit, at a cost in time; doc/running.md says which results.");
    add_option(
      prm,
      "Cell precision",
      precision,
      "Arithmetic of the internal forces of elastic cells of degree 1 in the "
      "time loop. Single: strain, stress and forces of a cell are computed in "
      "single precision, twice as many cells at a time, from relative "
      "displacements of its nodes, which are formed in double precision; sums "
      "at the nodes, the motion, cells that crack or yield and static "
      "equilibrium are in double precision. Faster by a half to two thirds, "
      "with round-off of 1e-7 of the strain, that of the static state "
      "included. Cells of higher degree and reproducible sums are always in "
      "double precision; the smoother of the static solver, which changes no "
      "result, is in single precision where possible.");
  }


  bool
  DiscretizationParameters::one_point(const bool has_memory) const
  {
    return quadrature == QuadratureRule::one_point ||
           (quadrature == QuadratureRule::one_point_where_elastic &&
            !has_memory);
  }


  double
  DiscretizationParameters::relative_cost(const bool has_memory) const
  {
    // Measured in one step over both kinds of trilinear cells, relative to
    // elastic ones. For concrete, halfway between no crack and cracks in 4 % of
    // its volume: 1.5 and 1.9 with eight points beside one, 1.2 and 1.6 with
    // eight points in all cells, 1.1 with one.
    if (!has_memory || degree > 1)
      return 1.;
    switch (quadrature)
      {
        case QuadratureRule::one_point_where_elastic:
          return 1.7;
        case QuadratureRule::one_point:
          return 1.1;
        default:
          return 1.4;
      }
  }


  double
  DiscretizationParameters::relative_cost_of_face() const
  {
    // Measured, relative to an elastic cell, with nodal update and free field
    // of the boundary: 0.96 with one point, 0.83 with eight. Contact: 1.4
    // to 1.9 of a cell with one point for both sides.
    return one_point(false) ? 1. : 0.8;
  }


  namespace
  {
    // A crack across a row of cells of degree 2: the strain is linear in a cell
    // and the force equal in its outer points; one of these opens with the
    // centre, the other unloads.
    double
    share_of_crack(const Quadrature<1> &quadrature, const unsigned int degree)
    {
      return degree == 2 ? quadrature.weight(0) + quadrature.weight(1) :
                           1. / degree;
    }


    // Corners of the cells of a batch; lanes without a cell have those of the
    // last cell.
    Discretization::MatrixFree::Corners
    corners_of(const Discretization::MatrixFree &matrix_free,
               const unsigned int                batch)
    {
      Discretization::MatrixFree::Corners corners;
      const unsigned int                  n_cells =
        matrix_free.n_active_entries_per_cell_batch(batch);
      for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            corners[8 * d + v][lane] =
              matrix_free.get_cell_iterator(batch, std::min(lane, n_cells - 1))
                ->vertex(v)[d];
      return corners;
    }


    // Frees the library's entries of the batches that have `node_entries`.
    void
    keep_entries_of_others(Discretization::MatrixFree &matrix_free)
    {
      auto &dof_info = const_cast<internal::MatrixFreeFunctions::DoFInfo &>(
        matrix_free.get_dof_info());
      auto              &starts    = dof_info.row_starts;
      const unsigned int n_batches = matrix_free.n_cell_batches(),
                         n_rows    = 3 * Lanes::size(); // of a batch
      std::array<std::vector<unsigned int>, 2>         kept;
      const std::array<std::vector<unsigned int> *, 2> all{
        {&dof_info.dof_indices, &dof_info.dof_indices_interleaved}};
      unsigned int n_kept = 0;
      for (unsigned int batch = 0; batch < n_batches; ++batch)
        {
          const auto         row   = starts.begin() + n_rows * batch;
          const unsigned int first = row->first, end = (row + n_rows)->first;
          const bool is_kept = matrix_free.node_entries[batch] == nullptr;
          for (unsigned int i = 0; i < n_rows; ++i)
            (row + i)->first =
              n_kept + (is_kept ? (row + i)->first - first : 0);
          if (!is_kept)
            continue;
          n_kept += end - first;
          for (unsigned int i = 0; i < 2; ++i)
            if (!all[i]->empty())
              kept[i].insert(kept[i].end(),
                             all[i]->begin() + first,
                             all[i]->begin() + end);
        }
      for (auto row = starts.begin() + n_rows * n_batches; row != starts.end();
           ++row)
        row->first = n_kept; // ghost cells are not read
      for (unsigned int i = 0; i < 2; ++i)
        *all[i] = std::move(kept[i]);
    }


    // Of the owned nodes.
    std::vector<Point<3>>
    positions_of_nodes(const Discretization &discretization)
    {
      std::vector<Point<3>> positions(discretization.n_owned_nodes());
      const auto           &scalar = discretization.fe.base_element(0);
      FEValues<3>           beside_vertices(discretization.mapping,
                                  scalar,
                                  Quadrature<3>(
                                    scalar.get_unit_support_points()),
                                  update_quadrature_points);
      for (const auto &cell :
           discretization.grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (discretization.degree > 1)
              beside_vertices.reinit(cell);
            const auto nodes =
              discretization.cell_nodes(discretization.dof_cell(cell));
            for (unsigned int j = 0; j < nodes.size(); ++j)
              if (discretization.owned_dofs.is_element(3 * nodes[j]))
                // The vertices themselves: deal.II 9.6 maps the corners of each
                // cell with round-off of its own, so that a position would
                // depend on the order of the cells.
                positions[discretization.owned_node(nodes[j])] =
                  j < cell->n_vertices() ? cell->vertex(j) :
                                           beside_vertices.quadrature_point(j);
          }
      return positions;
    }
  } // namespace


  Discretization::Discretization(const Grid                     &grid,
                                 const DiscretizationParameters &parameters,
                                 const std::vector<Support>     &supports,
                                 const std::vector<bool>        &has_memory)
    : grid(grid)
    , degree(parameters.degree)
    , reproducible(parameters.sums == Sums::reproducible)
    , single_precision(has_singles && degree == 1 && !reproducible &&
                       parameters.precision == CellPrecision::single_precision)
    , fe(FE_Q<3>(parameters.degree), 3)
    , dof_handler(grid.triangulation())
    , parameters(parameters)
    , has_memory(has_memory)
  {
    check_size(grid.triangulation().n_global_active_cells(),
               degree,
               "\"Degree\" in section \"Discretization\"",
               RanksOfMachine(grid.communicator()).n_machines());
    dof_handler.distribute_dofs(fe);
    number_by_nodes();
    owned_dofs = dof_handler.locally_owned_dofs();
    DoFTools::extract_locally_relevant_dofs(dof_handler, relevant_dofs);
    const auto owned_by_all =
      Utilities::MPI::all_gather(grid.communicator(), owned_dofs.n_elements());
    first_dof_of_rank.push_back(0);
    for (const auto owned : owned_by_all)
      first_dof_of_rank.push_back(first_dof_of_rank.back() + owned);
    hanging_nodes.reinit(relevant_dofs);
    DoFTools::make_hanging_node_constraints(dof_handler, hanging_nodes);
    hanging_nodes.close();
    constraints = make_constraints(supports);

    MatrixFree::AdditionalData data;
    data.tasks_parallel_scheme = MatrixFree::AdditionalData::none;
    data.mapping_update_flags  = update_gradients | update_JxW_values;
    data.cell_vectorization_categories_strict = true;
    data.cell_vectorization_category.resize( // as MatrixFree requires it
      grid.triangulation().n_active_cells());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        data.cell_vectorization_category[cell->active_cell_index()] =
          grid.material(cell);

    // hanging nodes are resolved in all cells
    data.store_plain_indices = false;

    const Quadrature<1> points =
      parameters.one_point(true) ? // everywhere
        Quadrature<1>(QGauss<1>(1)) :
        parameters.quadrature == QuadratureRule::gauss_lobatto ?
        Quadrature<1>(QGaussLobatto<1>(degree + 1)) :
        Quadrature<1>(QGauss<1>(degree + 1));
    crack_share            = share_of_crack(points, degree);
    matrix_free.quadrature = Quadrature<3>(points);
    // Trilinear cells need no Jacobian matrices of the library: one point for
    // each cell takes the least memory.
    const std::vector<Quadrature<1>> quadratures{
      degree == 1 ? Quadrature<1>(QGauss<1>(1)) : points};
    matrix_free.reinit(mapping,
                       std::vector<const DoFHandler<3> *>{&dof_handler},
                       std::vector<const AffineConstraints<double> *>{
                         &hanging_nodes},
                       quadratures,
                       data);
    if (reproducible)
      {
        for (const auto &cell : dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            longest_edge = std::max(longest_edge, Voussoir::longest_edge(cell));
        longest_edge = Utilities::MPI::max(longest_edge, grid.communicator());
      }

    places.resize(grid.triangulation().n_locally_owned_active_cells());
    for (unsigned int batch = 0; batch < matrix_free.n_cell_batches(); ++batch)
      {
        material_of_batch.push_back(
          grid.material(matrix_free.get_cell_iterator(batch, 0)));
        for (unsigned int lane = 0;
             lane < matrix_free.n_active_entries_per_cell_batch(batch);
             ++lane)
          places[grid.owned_cell(matrix_free.get_cell_iterator(batch, lane))] =
            {batch, lane};
      }
    matrix_free.node_entries.assign(matrix_free.n_cell_batches(), nullptr);
    if (degree == 1)
      {
        find_node_entries();
        keep_corners_only();
      }
    if (single_precision)
      kept_single_corners = single_corners();

    node_positions = positions_of_nodes(*this);
  }


  bool
  Discretization::has_one_point(const unsigned int material) const
  {
    return parameters.one_point(material < has_memory.size() &&
                                has_memory[material]);
  }


  const Quadrature<3> &
  Discretization::points(const unsigned int material) const
  {
    return has_one_point(material) ? centre : matrix_free.quadrature;
  }


  void
  Discretization::keep_corners_only()
  {
    const unsigned int n_batches = matrix_free.n_cell_batches(),
                       n_lanes   = Lanes::size();
    const auto &layout           = *matrix_free.get_vector_partitioner();
    matrix_free.trilinear        = true;
    matrix_free.positions.resize(layout.locally_owned_size() +
                                 layout.n_ghost_indices());
    const auto is_complete = [&](const unsigned int batch) {
      return matrix_free.node_entries[batch] != nullptr &&
             matrix_free.n_active_entries_per_cell_batch(batch) == n_lanes;
    };
    matrix_free.place_of_own_corners.assign(n_batches,
                                            numbers::invalid_unsigned_int);
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        const auto corners = corners_of(matrix_free, batch);
        if (is_complete(batch))
          for (unsigned int v = 0; v < 8; ++v)
            for (unsigned int lane = 0; lane < n_lanes; ++lane)
              for (unsigned int d = 0; d < 3; ++d)
                matrix_free.positions
                  [matrix_free.node_entries[batch][v * n_lanes + lane] + d] =
                  corners[8 * d + v][lane];
        else
          {
            matrix_free.place_of_own_corners[batch] =
              matrix_free.own_corners.size();
            matrix_free.own_corners.push_back(corners);
          }
      }
    auto &geometry =
      const_cast<
        internal::MatrixFreeFunctions::MappingInfo<3, double, Lanes> &>(
        matrix_free.get_mapping_info())
        .cell_data[0];
    // FEEvaluation::reinit takes the address of the first entry
    std::fill(geometry.data_index_offsets.begin(),
              geometry.data_index_offsets.end(),
              0);
    geometry.JxW_values   = AlignedVector<Lanes>(1);
    geometry.jacobians[0] = AlignedVector<Tensor<2, 3, Lanes>>(1);
  }


  void
  Discretization::find_node_entries()
  {
    using namespace internal::MatrixFreeFunctions;
    const unsigned int n_batches = matrix_free.n_cell_batches(),
                       n_lanes = Lanes::size(), n_entries = 8 * n_lanes;
    const DoFInfo     &dof_info = matrix_free.get_dof_info();
    const auto        &masks    = dof_info.hanging_node_constraint_masks;
    const auto        &layout   = *matrix_free.get_vector_partitioner();
    const unsigned int size =
      layout.locally_owned_size() + layout.n_ghost_indices();
    matrix_free.entries.resize(n_batches * n_entries);
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        if (dof_info.index_storage_variants[DoFInfo::dof_access_cell][batch] !=
            DoFInfo::IndexStorageVariants::interleaved)
          continue;
        bool hanging = false;
        if (!masks.empty())
          for (unsigned int lane = 0; lane < n_lanes; ++lane)
            hanging = hanging || masks[batch * n_lanes + lane] !=
                                   unconstrained_compressed_constraint_kind;
        // the entries of the first component; those of the others follow them,
        // of ghost nodes too
        const unsigned int *entries =
          dof_info.dof_indices_interleaved.data() +
          dof_info.row_starts[3 * batch * n_lanes].first;
        if (!hanging &&
            *std::max_element(entries, entries + n_entries) + 4 <= size)
          {
            unsigned int *own = matrix_free.entries.data() + batch * n_entries;
            std::copy_n(entries, n_entries, own);
            matrix_free.node_entries[batch] = own;
          }
      }
    keep_entries_of_others(matrix_free);
  }


  std::shared_ptr<const Discretization::MatrixFree::SingleCorners>
  Discretization::single_corners() const
  {
    if (!has_singles || degree > 1 || reproducible)
      return nullptr;
    if (const auto held = matrix_free.single_corners.lock())
      return held;
    const auto result =
      std::make_shared<MatrixFree::SingleCorners>(matrix_free.n_cell_batches());
    for (unsigned int batch = 0; batch < matrix_free.n_cell_batches(); ++batch)
      {
        const auto corners = corners_of(matrix_free, batch);
        for (unsigned int k = 0; k < 24; ++k)
          (*result)[batch][k] = rounded(corners[k] - corners[k / 8 * 8]);
      }
    matrix_free.single_corners = result;
    return result;
  }


  void
  Discretization::number_by_nodes()
  {
    const IndexSet &owned = dof_handler.locally_owned_dofs();
    std::vector<types::global_dof_index> new_numbers(
      owned.n_elements(), numbers::invalid_dof_index);
    const types::global_dof_index first =
      owned.n_elements() > 0 ? owned.nth_index_in_set(0) : 0;

    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    types::global_dof_index              next = first;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int j = 0; j < fe.base_element(0).n_dofs_per_cell();
               ++j)
            {
              const auto x = dofs[fe.component_to_system_index(0, j)];
              if (owned.is_element(x) &&
                  new_numbers[x - first] == numbers::invalid_dof_index)
                for (unsigned int d = 0; d < 3; ++d)
                  new_numbers[dofs[fe.component_to_system_index(d, j)] -
                              first] = next++;
            }
        }
    dof_handler.renumber_dofs(new_numbers);
  }


  AffineConstraints<double>
  Discretization::make_constraints(
    const std::vector<Support> &supports,
    const std::vector<bool>    &fixed_materials) const
  {
    AffineConstraints<double> result(relevant_dofs);
    DoFTools::make_hanging_node_constraints(dof_handler, result);
    const auto hold = [&](const types::global_dof_index dof) {
      if (result.can_store_line(dof) && !result.is_constrained(dof))
        result.add_line(dof);
    };

    FEFaceValues<3> normals(mapping,
                            fe.base_element(0),
                            QMidpoint<2>(),
                            update_normal_vectors);
    // ghost cells too: a rank must have the supports of all its nodes, ghosts
    // included
    for (const Support &support : supports)
      for (const auto &[cell, face] : grid.faces(support.set))
        {
          std::array<bool, 3> fixed{{true, true, true}};
          if (support.fixed != Support::Fixed::all)
            {
              normals.reinit(cell, face);
              const Tensor<1, 3> n       = normals.normal_vector(0);
              bool               upright = false;
              for (unsigned int d = 0; d < 3; ++d)
                {
                  const bool along = std::abs(n[d]) > 1. - 1e-6;
                  upright          = upright || along;
                  fixed[d] = along == (support.fixed == Support::Fixed::normal);
                }
              if (!upright)
                throw UserError(
                  (support.fixed == Support::Fixed::normal ?
                     "\"Roller\" in section \"Boundaries\" names \"" :
                     "\"Antisymmetric\" in section \"Boundaries\" names "
                     "\"") +
                  support.set +
                  "\", which is not perpendicular to a coordinate axis; " +
                  (support.fixed == Support::Fixed::normal ?
                     "rollers need" :
                     "planes of antisymmetry need") +
                  " faces of constant x, y or z, so use "
                  "\"Fixed\" or an absorbing boundary there.");
            }
          const auto nodes = cell_nodes(dof_cell(cell));
          for (unsigned int j = 0; j < fe.base_element(0).n_dofs_per_cell();
               ++j)
            if (fe.base_element(0).has_support_on_face(j, face))
              for (unsigned int d = 0; d < 3; ++d)
                if (fixed[d])
                  hold(3 * nodes[j] + d);
        }
    if (!fixed_materials.empty())
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial() && fixed_materials[grid.material(cell)])
          for (const auto node : cell_nodes(cell))
            for (unsigned int d = 0; d < 3; ++d)
              hold(3 * node + d);
    result.close();
    return result;
  }


  Vector
  Discretization::create_vector() const
  {
    Vector vector;
    matrix_free.initialize_dof_vector(vector);
    return vector;
  }


  unsigned int
  Discretization::n_owned_nodes() const
  {
    return owned_dofs.n_elements() / 3;
  }


  unsigned int
  Discretization::owned_node(const types::global_dof_index global_node) const
  {
    const auto rank = Utilities::MPI::this_mpi_process(grid.communicator());
    return global_node - first_dof_of_rank[rank] / 3;
  }


  unsigned int
  Discretization::owner(const types::global_dof_index global_node) const
  {
    return std::upper_bound(first_dof_of_rank.begin(),
                            first_dof_of_rank.end(),
                            3 * global_node) -
           first_dof_of_rank.begin() - 1;
  }


  unsigned int
  Discretization::largest_interface() const
  {
    return Utilities::MPI::max(
      matrix_free.get_vector_partitioner()->n_ghost_indices() / 3,
      grid.communicator());
  }


  std::vector<Discretization::Share>
  Discretization::carriers(const types::global_dof_index global_node) const
  {
    const auto *entries = hanging_nodes.get_constraint_entries(3 * global_node);
    if (entries == nullptr)
      return {{global_node, 1.}};
    std::vector<Share> shares;
    for (const auto &entry : *entries)
      shares.push_back({entry.first / 3, entry.second});
    return shares;
  }


  std::vector<types::global_dof_index>
  Discretization::cell_nodes(const Cell &cell) const
  {
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    cell->get_dof_indices(dofs);
    std::vector<types::global_dof_index> nodes(
      fe.base_element(0).n_dofs_per_cell());
    for (unsigned int j = 0; j < nodes.size(); ++j)
      nodes[j] = dofs[fe.component_to_system_index(0, j)] / 3;
    return nodes;
  }


  Discretization::Cell
  Discretization::dof_cell(
    const Triangulation<3>::active_cell_iterator &cell) const
  {
    return Cell(&grid.triangulation(),
                cell->level(),
                cell->index(),
                &dof_handler);
  }
} // namespace Voussoir
