#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/fem/lanczos.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/mesh/reservoir_mesh.h>

#include <deal.II/numerics/rtree.h>

#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Nodes of water and solid coincide if nearer than this part of the
    // shortest edge on the wall.
    constexpr double coincidence = 1e-4;

    // Largest time step for the estimate of the coupling, over that of the
    // water by itself.
    constexpr double largest_relative_step = 0.95;


    // Limit of z of the normal out of the water, which sets the floor apart
    // from upright planes of symmetry.
    constexpr double largest_normal_of_floor = -0.3;


    bool
    in_any(const Grid                     &grid,
           const std::vector<std::string> &sets,
           const Grid::Cell               &cell,
           const unsigned int              face)
    {
      return std::any_of(sets.begin(), sets.end(), [&](const auto &set) {
        return grid.in_face_set(cell, face, set);
      });
    }


    std::vector<std::string>
    checked_sets(const Grid        &grid,
                 const std::string &list,
                 const std::string &entry)
    {
      const auto sets = split_list(list);
      for (const std::string &set : sets)
        grid.check_face_set(set, "\"" + entry + "\" in section \"Reservoir\"");
      return sets;
    }


    // Warns of a free surface below the top of the water, where its zero
    // pressure would be wrong.
    void
    check_surface(const AcousticSpace            &space,
                  const std::vector<std::string> &sets,
                  Log                            &log)
    {
      double lowest = std::numeric_limits<double>::max(), top = -lowest,
             bottom = lowest;
      for (const auto &cell : space.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int face : cell->face_indices())
            for (unsigned int v = 0; v < 4; ++v)
              {
                const double z = cell->face(face)->vertex(v)[2];
                top            = std::max(top, z);
                bottom         = std::min(bottom, z);
                if (in_any(space.grid, sets, cell, face))
                  lowest = std::min(lowest, z);
              }
      const MPI_Comm communicator = space.grid.communicator();
      lowest                      = Utilities::MPI::min(lowest, communicator);
      top                         = Utilities::MPI::max(top, communicator);
      bottom                      = Utilities::MPI::min(bottom, communicator);
      if (top - lowest > 0.25 * (top - bottom)) // rows of cells may slope
        log.warn(
          "\"Free surface\" in section \"Reservoir\" reaches down to z = ",
          lowest,
          " m, but the top of the water is at ",
          top,
          " m; the water has no pressure there");
    }


    /** The water's nodes on the wet wall, of all ranks. */
    struct WetNodes
    {
      explicit WetNodes(const AcousticSpace &space)
      {
        FaceNodes face_nodes(space.mapping, space.fe);
        std::vector<types::global_dof_index> dofs(space.fe.n_dofs_per_cell());
        std::vector<std::pair<types::global_dof_index, Point<3>>> mine;
        double edge = std::numeric_limits<double>::max();
        for (const auto &cell : space.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned())
            for (const unsigned int face : cell->face_indices())
              if (space.grid.in_face_set(cell, face, wet_wall))
                {
                  cell->get_dof_indices(dofs);
                  for (const auto &[j, x, normal, area] :
                       face_nodes.of(cell, face))
                    mine.emplace_back(dofs[j], x);
                  for (unsigned int line = 0; line < 4; ++line)
                    edge =
                      std::min(edge, cell->face(face)->line(line)->diameter());
                }
        const MPI_Comm communicator = space.grid.communicator();
        tolerance = coincidence * Utilities::MPI::min(edge, communicator);
        for (const auto &[unknown, position] :
             join_over_ranks(mine, communicator))
          {
            unknowns.push_back(unknown);
            positions.push_back(position);
          }
      }

      double                               tolerance;
      std::vector<types::global_dof_index> unknowns;
      std::vector<Point<3>>                positions;
    };
  } // namespace


  Reservoir::Reservoir(const CoarseMesh          &water,
                       const GridParameters      &grid_parameters,
                       const ReservoirParameters &parameters,
                       const Discretization      &solid,
                       Log                       &log)
    : space(water, grid_parameters, solid.degree, solid.grid.communicator())
    , density(parameters.density)
    , compressibility(1. / (parameters.density *
                            Utilities::fixed_power<2>(parameters.sound_speed)))
    , inverse_storage(space.create_vector())
    , dashpots(space.create_vector())
  {
    const Grid &grid   = space.grid;
    const auto surface = checked_sets(grid, parameters.surface, "Free surface");
    const auto ends    = checked_sets(grid, parameters.end, "Radiating end");
    const double alpha = parameters.bottom_reflection;
    const auto   dam = alpha < 1. ? checked_sets(grid, parameters.dam, "Dam") :
                                    std::vector<std::string>();

    const Vector surface_area =
      space.areas([&](const Grid::Cell &cell, const unsigned int face) {
        return in_any(grid, surface, cell, face);
      });
    check_surface(space, surface, log);
    const AcousticSpace::FacePredicate is_end = [&](const Grid::Cell  &cell,
                                                    const unsigned int face) {
      return in_any(grid, ends, cell, face);
    };
    const Vector end_area = space.areas(is_end);
    const Vector bottom_area =
      space.areas([&](const Grid::Cell &cell, const unsigned int face) {
        return alpha < 1. && grid.in_face_set(cell, face, wet_wall) &&
               !in_any(grid, dam, cell, face);
      });
    const double admittance = 1. / (density * parameters.sound_speed);
    Vector       bottom_dashpots(bottom_area);
    bottom_dashpots *= admittance * (1. - alpha) / (1. + alpha);
    for (unsigned int i = 0; i < dashpots.locally_owned_size(); ++i)
      {
        if (surface_area.local_element(i) > 0.)
          continue;
        inverse_storage.local_element(i) =
          1. / (compressibility * space.volumes.local_element(i));
        dashpots.local_element(i) = admittance * end_area.local_element(i) +
                                    bottom_dashpots.local_element(i);
        if (dashpots.local_element(i) > 0.)
          lossy_nodes.push_back(i);
      }
    couple(solid);
    std::vector<std::string> open_sets(surface);
    open_sets.insert(open_sets.end(), ends.begin(), ends.end());
    find_floor(open_sets);
    if (alpha < 1. &&
        Utilities::MPI::logical_or(!floor_nodes.empty(), grid.communicator()))
      log.warn("\"Bottom reflection coefficient\" in section \"Reservoir\" is ",
               alpha,
               ", but part of the floor of the water meets no solid and "
               "reflects all; give it cells of rock");
    largest_step = find_stable_step();
    if (end_area.linfty_norm() > 0.)
      {
        end = std::make_unique<const ReservoirEnd>(
          space,
          is_end,
          ReservoirEnd::Water{density,
                              parameters.sound_speed,
                              end_area,
                              bottom_dashpots,
                              inverse_storage,
                              parameters.far_reservoir ==
                                FarReservoir::channel},
          log);
        largest_step = std::min(largest_step, end->stable_step());
      }
  }


  double
  Reservoir::find_stable_step() const
  {
    // a start vector that is the same on any number of ranks
    Vector start(dashpots);
    for (unsigned int i = 0; i < start.locally_owned_size(); ++i)
      {
        const Point<3> &p      = space.node_positions[i];
        start.local_element(i) = std::sin(1e3 * p[0] + 2e3 * p[1] + 3e3 * p[2]);
      }
    return 2. / std::sqrt(largest_eigenvalue(
                  start, inverse_storage, [&](Vector &dst, const Vector &src) {
                    dst = 0.;
                    space.sweep(dst, src, {}, {});
                    dst /= density;
                  }));
  }


  void
  Reservoir::couple(const Discretization &solid)
  {
    const WetNodes wet(space);
    const auto     tree = pack_rtree_of_indices(wet.positions);

    FaceNodes face_nodes(solid.mapping, solid.fe.base_element(0));
    struct Record
    {
      types::global_dof_index water;
      Tensor<1, 3>            area;
    };
    std::vector<std::pair<types::global_dof_index, Record>> records;
    std::vector<Point<3>>                                   lonely;
    solid.grid.for_each_face(
      wet_wall, [&](const auto &cell, const unsigned int face) {
        const auto nodes = solid.cell_nodes(solid.dof_cell(cell));
        for (const auto &[j, x, normal, area] : face_nodes.of(cell, face))
          {
            std::vector<std::size_t> nearest;
            tree.query(boost::geometry::index::nearest(x, 1),
                       std::back_inserter(nearest));
            if (x.distance(wet.positions[nearest[0]]) > wet.tolerance)
              lonely.assign(1, x);
            else
              records.push_back(
                {nodes[j], {wet.unknowns[nearest[0]], -area * normal}});
          }
      });
    for (const Point<3> &x : join_over_ranks(lonely, space.grid.communicator()))
      {
        std::ostringstream text;
        text << "At (" << x
             << ") m a node of the solid on the wall of the reservoir meets "
                "no node of the water; do not refine cells at the water by "
                "\"Local refinement\" or \"Refine where\" in section \"Mesh\".";
        throw UserError(text.str());
      }

    std::map<std::pair<unsigned int, types::global_dof_index>, Tensor<1, 3>>
             area_of_pair;
    IndexSet unknowns(space.owned_dofs.size());
    for (const auto &[node, record] : solid.send_to_owners(records))
      {
        area_of_pair[{node, record.water}] += record.area;
        unknowns.add_index(record.water);
      }
    wall.reinit(space.owned_dofs, unknowns, space.grid.communicator());
    for (const auto &[pair, area] : area_of_pair)
      pairs.push_back({pair.first,
                       wall.get_partitioner()->global_to_local(pair.second),
                       area});

    // the areas at the unknowns of this rank, whichever rank owns the solid's
    // nodes
    std::array<Vector, 4> sums; // x, y, z; amount, positive where wet
    for (unsigned int d = 0; d < 4; ++d)
      {
        sums[d].reinit(wall);
        for (const Pair &pair : pairs)
          sums[d].local_element(pair.water) +=
            d < 3 ? pair.area[d] : pair.area.norm();
        sums[d].compress(VectorOperation::add);
      }
    for (unsigned int i = 0; i < dashpots.locally_owned_size(); ++i)
      if (sums[3].local_element(i) > 0.)
        wall_nodes.push_back({i,
                              Tensor<1, 3>({sums[0].local_element(i),
                                            sums[1].local_element(i),
                                            sums[2].local_element(i)})});
  }


  std::vector<unsigned int>
  Reservoir::wet_nodes() const
  {
    std::vector<unsigned int> nodes;
    for (const Pair &pair : pairs)
      nodes.push_back(pair.node);
    return nodes;
  }


  void
  Reservoir::find_floor(const std::vector<std::string> &open_sets)
  {
    FaceNodes                            face_nodes(space.mapping, space.fe);
    std::array<Vector, 3>                sums;
    std::vector<types::global_dof_index> dofs(space.fe.n_dofs_per_cell());
    for (Vector &sum : sums)
      sum = space.create_ghosted_vector();
    for (const auto &cell : space.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int face : cell->face_indices())
          if (cell->at_boundary(face) &&
              !space.grid.in_face_set(cell, face, wet_wall) &&
              !in_any(space.grid, open_sets, cell, face))
            {
              cell->get_dof_indices(dofs);
              for (const FaceNode &node : face_nodes.of(cell, face))
                if (node.normal[2] < largest_normal_of_floor)
                  for (unsigned int d = 0; d < 3; ++d)
                    sums[d](dofs[node.number]) += node.area * node.normal[d];
            }
    for (Vector &sum : sums)
      sum.compress(VectorOperation::add);
    for (unsigned int i = 0; i < dashpots.locally_owned_size(); ++i)
      if (sums[2].local_element(i) < 0.)
        floor_nodes.push_back({i,
                               Tensor<1, 3>({sums[0].local_element(i),
                                             sums[1].local_element(i),
                                             sums[2].local_element(i)})});
  }


  double
  Reservoir::stable_step() const
  {
    return largest_step;
  }


  void
  Reservoir::add_coupling(Vector       &force,
                          const Vector &displacement,
                          const double  step) const
  {
    Vector flux = create_wall_vector();
    gather_flux(flux, displacement);
    for (unsigned int i = 0; i < dashpots.locally_owned_size(); ++i)
      flux.local_element(i) *= inverse_storage.local_element(i);
    flux.update_ghost_values();
    const double ratio = std::min(step / largest_step, largest_relative_step);
    for (const Pair &pair : pairs)
      for (unsigned int d = 0; d < 3; ++d)
        force.local_element(3 * pair.node + d) +=
          pair.area[d] * flux.local_element(pair.water) / (1. - ratio * ratio);
  }


  Vector
  Reservoir::create_wall_vector() const
  {
    Vector result;
    result.reinit(wall);
    return result;
  }


  void
  Reservoir::gather_flux(Vector &flux, const Vector &velocity) const
  {
    for (const Pair &pair : pairs)
      for (unsigned int d = 0; d < 3; ++d)
        flux.local_element(pair.water) +=
          pair.area[d] * velocity.local_element(3 * pair.node + d);
    flux.compress(VectorOperation::add);
  }

} // namespace Voussoir
