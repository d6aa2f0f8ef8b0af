#include <voussoir/fem/cell_neighbors.h>
#include <voussoir/fem/crack_growth.h>
#include <voussoir/fem/crack_planes.h>
#include <voussoir/fem/trilinear_cells.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools.h>

#include <optional>
#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double widest_band = 3.,    // over the size of the cell
      least_of_tip               = 0.005, // share of the stabilisation
      left_per_update            = 0.9,   // of it
      reach                      = 1.6,   // over the size of the cell
      strength_beside            = 2.;    // over that of the material


    double
    size_of(const Discretization::Cell &cell)
    {
      return std::cbrt(cell->measure());
    }


    /** Middle of the cut of the plane with a face. */
    template <typename Face>
    std::optional<Point<3>>
    middle_of_cut(const Point<3>     &point,
                  const Tensor<1, 3> &normal,
                  const Face         &face)
    {
      Tensor<1, 3> sum;
      unsigned int n = 0;
      for (unsigned int l = 0; l < face->n_lines(); ++l)
        {
          const Point<3> a      = face->line(l)->vertex(0),
                         b      = face->line(l)->vertex(1);
          const double height_a = normal * (a - point),
                       height_b = normal * (b - point);
          if ((height_a > 0.) != (height_b > 0.))
            {
              sum += a + height_a / (height_a - height_b) * (b - a);
              ++n;
            }
        }
      if (n == 0)
        return {};
      return Point<3>(sum / double(n));
    }


    void
    set_lane(Tensor<1, 3, Lanes> &vector,
             const unsigned int   lane,
             const Tensor<1, 3>  &value)
    {
      for (unsigned int d = 0; d < 3; ++d)
        vector[d][lane] = value[d];
    }


    /** Pressure on the faces of a crack; zero if it is open [Pa]. */
    double
    pressure_on_crack(const ActivePoint &point, const unsigned int lane)
    {
      return std::max(0.,
                      -(point.normal * (point.stress * point.normal))[lane]);
    }


    /** Ghost values for the time of an update. */
    class GhostValues
    {
    public:
      explicit GhostValues(const Vector &vector)
        : vector(vector)
        , is_mine(!vector.has_ghost_elements())
      {
        if (is_mine)
          vector.update_ghost_values();
      }

      ~GhostValues()
      {
        if (is_mine)
          vector.zero_out_ghost_values();
      }

      GhostValues(const GhostValues &) = delete;

    private:
      const Vector &vector;
      const bool    is_mine;
    };
  } // namespace


  CrackPlanes::CrackPlanes(const Discretization &discretization,
                           const std::vector<const CellKernel *> &kernels,
                           const InternalForce &internal_force,
                           const Damping       &damping,
                           const bool           at_rest)
    : discretization(discretization)
    , kernels(kernels)
    , internal_force(internal_force)
    , damping(damping)
    , at_rest(at_rest)
  {
    if (std::none_of(kernels.begin(), kernels.end(), [](const auto *kernel) {
          return kernel->cracks_along_planes();
        }))
      return;
    const auto &dofs = discretization.dof_handler;
    at_vertex.resize(discretization.grid.triangulation().n_vertices());
    shared_vertices.resize(at_vertex.size(), false);
    std::vector<bool> can_crack(at_vertex.size(), false);
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int vertex = cell->vertex_index(v);
            if (follows_planes(cell))
              can_crack[vertex] = true;
            if (cell->is_ghost())
              shared_vertices[vertex] = true;
          }
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          if (can_crack[cell->vertex_index(v)])
            at_vertex[cell->vertex_index(v)].push_back(cell);
  }


  void
  CrackPlanes::update(const double time_step, State &state)
  {
    if (state.step % steps_between_looks == 0)
      find(time_step, state);
  }


  bool
  CrackPlanes::find(const double time_step, State &state)
  {
    MaterialMemory &memory = state.material_memory;
    if (at_vertex.empty() || memory.empty())
      return false;
    Found found = cells_to_update(memory);

    // whether any rank has something to do
    enum
    {
      first,
      cracks,
      tips,
      shared_tips,
      changing
    };
    const std::vector<unsigned int> mine{
      !found.first.empty(),
      !found.first.empty() || !found.next.empty(),
      !found.tips.empty(),
      std::any_of(found.tips.begin(),
                  found.tips.end(),
                  [&](const Cell &cell) { return is_shared(cell); }),
      found.changes()};
    std::vector<unsigned int> any(mine.size());
    Utilities::MPI::max(mine, discretization.grid.communicator(), any);

    if (any[cracks] == 0 && any[tips] == 0 && any[changing] == 0)
      return false;
    const auto        n_tips = found.tips.size();
    const GhostValues ghosts(state.displacement);
    if (any[first] > 0)
      begin(found.first, state.displacement, memory);
    if (any[cracks] > 0)
      {
        const std::vector<Crack> now = new_cracks(found, memory);
        for (const Crack &crack : now)
          propagate(crack, memory, found.tips);
        for (const Crack &crack : now)
          strengthen(crack, memory);
      }
    const bool has_new_tips = found.tips.size() > n_tips;
    turn(found,
         any[cracks] > 0 || any[shared_tips] > 0,
         state.displacement,
         memory);
    if (Utilities::MPI::logical_or(found.changes(),
                                   discretization.grid.communicator()))
      change_stabilisation(found, time_step, state);
    return !found.first.empty() || has_new_tips || !found.releasing.empty();
  }


  bool
  CrackPlanes::follows_planes(const Cell &cell) const
  {
    return kernels[discretization.grid.material(cell)]->cracks_along_planes();
  }


  PointHistory &
  CrackPlanes::history_of(const Cell &cell, MaterialMemory &memory) const
  {
    return *memory.of(discretization.grid.material(cell));
  }


  bool
  CrackPlanes::is_cracked(const Cell &cell, MaterialMemory &memory) const
  {
    const unsigned int          material = discretization.grid.material(cell);
    const PointHistory         &history  = *memory.of(material);
    const Discretization::Place place    = discretization.place_of(cell);
    return history.band(place, 0) > 0. &&
           kernels[material]->is_cracked(history.read(place, 0).data());
  }


  double
  CrackPlanes::stabilisation_due(const Cell &cell, MaterialMemory &memory) const
  {
    PointHistory &history         = history_of(cell, memory);
    const auto [batch, lane]      = discretization.place_of(cell);
    const PlanesOfBatch &planes   = history.planes_of(batch);
    const double         now      = 1. - planes.released[lane];
    const bool           is_crack = history.tips_of(batch).run_on[lane] > 0.;
    const double         least =
      is_crack ? history.active_point(batch, 0).share[lane] : least_of_tip;
    if (!(least < 0.95 * now))
      return now;
    // a crack that has run into the cell opens at once
    const bool is_first = planes.opening[0][lane] == 0. &&
                          planes.opening[1][lane] == 0. &&
                          planes.opening[2][lane] == 0.;
    return at_rest || (is_crack && !is_first) ?
             least :
             std::max(least, left_per_update * now);
  }


  bool
  CrackPlanes::is_pressed(const Cell &cell, MaterialMemory &memory) const
  {
    // a crack without stress is not closed by round-off
    constexpr double least_share = 1e-6;
    const auto [batch, lane]     = discretization.place_of(cell);
    return pressure_on_crack(history_of(cell, memory).active_point(batch, 0),
                             lane) >
           least_share *
             kernels[discretization.grid.material(cell)]->tensile_strength();
  }


  void
  CrackPlanes::find_change(const Cell     &cell,
                           const bool      closes,
                           MaterialMemory &memory,
                           Found          &found) const
  {
    const auto [batch, lane]    = discretization.place_of(cell);
    const PlanesOfBatch &planes = history_of(cell, memory).planes_of(batch);
    if (closes != (planes.closed[lane] > 0.))
      {
        if (!at_rest)
          found.switching.push_back(cell);
      }
    else if (closes && planes.released[lane] > 0.)
      found.bearing.push_back(cell);
    else if (!closes &&
             stabilisation_due(cell, memory) < 1. - planes.released[lane])
      found.releasing.push_back(cell);
  }


  CrackPlanes::Found
  CrackPlanes::cells_to_update(MaterialMemory &memory) const
  {
    Found found;
    for (unsigned int m = 0; m < kernels.size(); ++m)
      {
        if (!kernels[m]->cracks_along_planes())
          continue;
        PointHistory &history = *memory.of(m);
        for (const auto &[cell, place] : history.cells())
          {
            const auto [batch, lane] = place;
            const bool has_plane  = history.planes_of(batch).width[lane] > 0.;
            const bool is_elastic = history.band(place, 0) == 0.;
            if (!has_plane && is_elastic)
              continue;
            // a crack that the search of an equilibrium has not kept
            if (is_elastic)
              history.tips_of(batch).run_on[lane] = 0.;
            if (history.tips_of(batch).run_on[lane] == 0.)
              {
                if (is_cracked(cell, memory))
                  (has_plane ? found.next : found.first).push_back(cell);
                else if (has_plane)
                  found.tips.push_back(cell);
              }
            else if (has_plane)
              find_change(cell, is_pressed(cell, memory), memory, found);
          }
      }
    return found;
  }


  const CrackPlanes::Surroundings &
  CrackPlanes::around(const Cell &cell)
  {
    const auto known = surroundings.find(cell);
    if (known != surroundings.end())
      return known->second;
    std::map<std::uint64_t, Cell> sorted;
    for (const unsigned int v : cell->vertex_indices())
      for (const Cell &other : at_vertex[cell->vertex_index(v)])
        sorted.emplace(Grid::global_key(other), other);
    Surroundings found;
    for (const auto &[key, other] : sorted)
      found.cells.push_back(other);

    const FE_Q<3> fe(1);
    FEValues<3>   values(discretization.mapping,
                       fe,
                       QGauss<3>(2),
                       update_gradients | update_JxW_values);
    values.reinit(typename Triangulation<3>::active_cell_iterator(cell));
    double volume = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      {
        volume += values.JxW(q);
        for (unsigned int a = 0; a < 8; ++a)
          found.gradients[a] += values.JxW(q) * values.shape_grad(a, q);
      }
    for (Tensor<1, 3> &gradient : found.gradients)
      gradient /= volume;
    return surroundings.emplace(cell, std::move(found)).first->second;
  }


  bool
  CrackPlanes::is_shared(const Cell &cell) const
  {
    const auto vertices = cell->vertex_indices();
    return std::any_of(vertices.begin(),
                       vertices.end(),
                       [&](const unsigned int v) {
                         return shared_vertices[cell->vertex_index(v)];
                       });
  }


  std::vector<CrackPlanes::Tension>
  CrackPlanes::tension(const std::vector<Cell> &cells,
                       const bool               are_shared,
                       const Vector            &displacement,
                       const MaterialMemory    &memory)
  {
    std::map<unsigned int, SplitStress> of_batch;
    const auto                          stresses = [&](const unsigned int batch,
                              const Cell        &cell) -> const SplitStress                          &{
      const auto known = of_batch.find(batch);
      if (known != of_batch.end())
        return known->second;
      return of_batch
        .emplace(batch,
                 internal_force.elastic_stress(
                   batch,
                   displacement,
                   memory.of(discretization.grid.material(cell))))
        .first->second;
    };
    const auto stress_of_own = [&](const Cell &cell) {
      const auto [batch, lane] = discretization.place_of(cell);
      return lane_of(stresses(batch, cell).tensile, lane);
    };

    // stresses of own cells around cells of other ranks, and the other way
    std::map<Cell, SymmetricTensor<2, 3>> of_ghosts;
    const auto                           &dofs = discretization.dof_handler;
    if (are_shared)
      {
        const std::set<Cell> ask(cells.begin(), cells.end());
        std::set<Cell>       wanted;
        GridTools::exchange_cell_data_to_ghosts<double, DoFHandler<3>>(
          dofs,
          [&](const Cell &cell) {
            return ask.count(cell) > 0 ? std::optional<double>(1.) :
                                         std::optional<double>();
          },
          [&](const Cell &cell, const double) {
            for (const unsigned int v : cell->vertex_indices())
              for (const Cell &other : at_vertex[cell->vertex_index(v)])
                if (other->is_locally_owned())
                  wanted.insert(other);
          });
        using Stress = Tensor<1, 6>;
        GridTools::exchange_cell_data_to_ghosts<Stress, DoFHandler<3>>(
          dofs,
          [&](const Cell &cell) {
            if (wanted.count(cell) == 0)
              return std::optional<Stress>();
            const SymmetricTensor<2, 3> stress = stress_of_own(cell);
            Stress                      sent;
            for (unsigned int i = 0; i < 6; ++i)
              sent[i] = stress.access_raw_entry(i);
            return std::optional<Stress>(sent);
          },
          [&](const Cell &cell, const Stress &sent) {
            for (unsigned int i = 0; i < 6; ++i)
              of_ghosts[cell].access_raw_entry(i) = sent[i];
          });
      }

    std::vector<Tension> found;
    for (const Cell &cell : cells)
      {
        SymmetricTensor<2, 3> sum;
        for (const Cell &other : around(cell).cells)
          sum += other->measure() * (other->is_locally_owned() ?
                                       stress_of_own(other) :
                                       of_ghosts.at(other));
        const auto [batch, lane] = discretization.place_of(cell);
        found.push_back(
          {sum.norm() > 0. ? eigenvectors(sum)[0].second : Tensor<1, 3>(),
           lane_of(stresses(batch, cell).all, lane)});
      }
    return found;
  }


  CrackPlanes::Plane
  CrackPlanes::plane_of(const Cell &cell, MaterialMemory &memory) const
  {
    const auto [batch, lane]    = discretization.place_of(cell);
    const PlanesOfBatch &planes = history_of(cell, memory).planes_of(batch);
    Plane                plane;
    for (unsigned int d = 0; d < 3; ++d)
      {
        plane.point[d]  = planes.point[d][lane];
        plane.normal[d] = planes.normal[d][lane];
      }
    return plane;
  }


  void
  CrackPlanes::set_plane(const Cell     &cell,
                         const Plane    &plane,
                         MaterialMemory &memory)
  {
    const auto  &gradients = around(cell).gradients;
    Tensor<1, 3> beyond;
    for (const unsigned int v : cell->vertex_indices())
      if ((cell->vertex(v) - plane.point) * plane.normal > 0.)
        beyond += gradients[v];
    const double       size = size_of(cell), across = beyond * plane.normal;
    const Tensor<1, 3> opening =
      beyond.norm() > 0.2 / size ? beyond / beyond.norm() : plane.normal;

    const auto [batch, lane] = discretization.place_of(cell);
    PlanesOfBatch &planes    = history_of(cell, memory).planes_of(batch);
    set_lane(planes.point, lane, plane.point);
    set_lane(planes.normal, lane, plane.normal);
    set_lane(planes.opening, lane, opening);
    planes.width[lane] =
      across > 1. / (widest_band * size) ? 1. / across : widest_band * size;
  }


  void
  CrackPlanes::set_tip_strength(const Cell &cell, MaterialMemory &memory) const
  {
    PointHistory &history    = history_of(cell, memory);
    const auto [batch, lane] = discretization.place_of(cell);
    const double size        = size_of(cell);
    history.tips_of(batch).strength[lane] =
      kernels[discretization.grid.material(cell)]->tip_strength(
        size * std::pow(history.planes_of(batch).width[lane] / size, 1.5));
  }


  void
  CrackPlanes::begin(const std::vector<Cell> &first,
                     const Vector            &displacement,
                     MaterialMemory          &memory)
  {
    const std::vector<Tension> around_first =
      tension(first, true, displacement, memory);
    for (unsigned int i = 0; i < first.size(); ++i)
      {
        const auto [batch, lane] = discretization.place_of(first[i]);
        PointHistory &history    = history_of(first[i], memory);
        ActivePoint  &point      = history.active_point(batch, 0);
        Tensor<1, 3>  normal     = around_first[i].direction;
        if (normal.norm() == 0.)
          for (unsigned int d = 0; d < 3; ++d)
            normal[d] = point.normal[d][lane];
        // the crack keeps the normal and the band that it has in the law
        PlanesOfBatch &planes = history.planes_of(batch);
        set_lane(planes.point, lane, first[i]->center());
        set_lane(planes.normal, lane, normal);
        planes.width[lane] = point.band[lane];
      }
  }


  std::vector<CrackPlanes::Crack>
  CrackPlanes::new_cracks(const Found &found, MaterialMemory &memory) const
  {
    std::map<std::uint64_t, Crack> sorted;
    std::map<Cell, Plane>          shared;
    for (const std::vector<Cell> *cells : {&found.first, &found.next})
      for (const Cell &cell : *cells)
        {
          const Plane plane        = plane_of(cell, memory);
          const auto [batch, lane] = discretization.place_of(cell);
          history_of(cell, memory).tips_of(batch).run_on[lane] = 1.;
          sorted.emplace(Grid::global_key(cell), Crack{cell, plane});
          if (is_shared(cell))
            shared.emplace(cell, plane);
        }
    using Sent = Tensor<1, 6>;
    if (Utilities::MPI::n_mpi_processes(discretization.grid.communicator()) > 1)
      GridTools::exchange_cell_data_to_ghosts<Sent, DoFHandler<3>>(
        discretization.dof_handler,
        [&](const Cell &cell) {
          const auto crack = shared.find(cell);
          if (crack == shared.end())
            return std::optional<Sent>();
          Sent sent;
          for (unsigned int d = 0; d < 3; ++d)
            {
              sent[d]     = crack->second.point[d];
              sent[3 + d] = crack->second.normal[d];
            }
          return std::optional<Sent>(sent);
        },
        [&](const Cell &cell, const Sent &sent) {
          if (!follows_planes(cell))
            return;
          Plane plane;
          for (unsigned int d = 0; d < 3; ++d)
            {
              plane.point[d]  = sent[d];
              plane.normal[d] = sent[3 + d];
            }
          sorted.emplace(Grid::global_key(cell), Crack{cell, plane});
        });
    std::vector<Crack> cracks;
    for (const auto &[key, crack] : sorted)
      cracks.push_back(crack);
    return cracks;
  }


  void
  CrackPlanes::propagate(const Crack       &crack,
                         MaterialMemory    &memory,
                         std::vector<Cell> &tips)
  {
    for_each_neighbor(crack.cell, [&](const Cell &cell, const auto &face) {
      if (!cell->is_locally_owned() || !follows_planes(cell) ||
          is_cracked(cell, memory))
        return;
      const auto [batch, lane] = discretization.place_of(cell);
      PlanesOfBatch &planes    = history_of(cell, memory).planes_of(batch);
      if (planes.width[lane] > 0.)
        return;
      const auto point =
        middle_of_cut(crack.plane.point, crack.plane.normal, face);
      if (!point)
        return;
      set_lane(planes.parent, lane, crack.plane.normal);
      set_plane(cell, {*point, crack.plane.normal}, memory);
      tips.push_back(cell);
    });
  }


  void
  CrackPlanes::strengthen(const Crack &crack, MaterialMemory &memory)
  {
    const double within = reach * size_of(crack.cell);
    for (const unsigned int v : crack.cell->vertex_indices())
      for (const Cell &cell : at_vertex[crack.cell->vertex_index(v)])
        {
          if (!cell->is_locally_owned() || !follows_planes(cell) ||
              cell->center().distance(crack.cell->center()) > within)
            continue;
          PointHistory &history    = history_of(cell, memory);
          const auto [batch, lane] = discretization.place_of(cell);
          if (history.planes_of(batch).width[lane] == 0.)
            history.tips_of(batch).strength[lane] = strength_beside;
        }
  }


  void
  CrackPlanes::turn(Found          &found,
                    const bool      are_shared,
                    const Vector   &displacement,
                    MaterialMemory &memory)
  {
    const std::vector<Tension> around_tips =
      tension(found.tips, are_shared, displacement, memory);
    for (unsigned int i = 0; i < found.tips.size(); ++i)
      {
        const Cell         &cell      = found.tips[i];
        const Tensor<1, 3> &direction = around_tips[i].direction;
        const auto [batch, lane]      = discretization.place_of(cell);
        PointHistory &history         = history_of(cell, memory);
        Tensor<1, 3>  parent;
        for (unsigned int d = 0; d < 3; ++d)
          parent[d] = history.planes_of(batch).parent[d][lane];
        // of a first crack that was not kept
        if (parent.norm() + direction.norm() == 0.)
          continue;
        Tensor<1, 3> normal =
          parent + (direction * parent < 0. ? -1. : 1.) * direction;
        normal /= normal.norm();
        set_plane(cell, {plane_of(cell, memory).point, normal}, memory);
        set_tip_strength(cell, memory);

        const double strength =
          kernels[discretization.grid.material(cell)]->tensile_strength();
        find_change(cell,
                    normal * (around_tips[i].own * normal) < -strength,
                    memory,
                    found);
      }
  }


  void
  CrackPlanes::change_stabilisation(const Found &found,
                                    const double time_step,
                                    State       &state) const
  {
    const GhostValues                         of_velocity(state.velocity);
    std::vector<std::unique_ptr<GhostValues>> of_memory;
    for (const Vector &branch : state.memory)
      of_memory.push_back(std::make_unique<GhostValues>(branch));

    TrilinearCells<OnePointShape> shape(discretization.matrix_free);
    const auto                    strain = [&](const unsigned int batch) {
      shape.reinit(batch);
      shape.gather_evaluate(state.displacement, EvaluationFlags::gradients);
      return shape.stabilised_strain();
    };
    const auto lane_of_cell = [&](const Cell &cell) {
      return discretization.place_of(cell).lane;
    };
    // calls work(planes, batch, its cells, their energy), and counts the energy
    // lost
    const auto change = [&](const std::vector<Cell> &cells,
                            Sum PointLosses::*lost,
                            const auto       &work) {
      std::map<unsigned int, std::vector<Cell>> by_batch;
      for (const Cell &cell : cells)
        by_batch[discretization.place_of(cell).batch].push_back(cell);
      for (const auto &[batch, of_batch] : by_batch)
        {
          PointHistory &history =
            history_of(of_batch[0], state.material_memory);
          const auto energy = [&, batch = batch] {
            return internal_force.stabilisation_energy(batch,
                                                       {state.displacement,
                                                        state.velocity,
                                                        state.velocity,
                                                        state.memory,
                                                        damping,
                                                        time_step},
                                                       history);
          };
          const Lanes before = energy();
          work(history.planes_of(batch), batch, of_batch, energy);
          const Lanes lost_now = before - energy();
          for (const Cell &cell : of_batch)
            history.losses.*lost += lost_now[lane_of_cell(cell)];
        }
    };
    change(found.switching,
           &PointLosses::closing,
           [&](PlanesOfBatch           &planes,
               const unsigned int       batch,
               const std::vector<Cell> &cells,
               const auto &) {
             for (const Cell &cell : cells)
               {
                 const unsigned int lane = lane_of_cell(cell);
                 planes.closed[lane]     = 1. - planes.closed[lane];
                 if (planes.closed[lane] > 0.)
                   planes.at_closing.set_lane(lane, strain(batch));
               }
           });
    change(
      found.bearing,
      &PointLosses::closing,
      [&](PlanesOfBatch           &planes,
          const unsigned int       batch,
          const std::vector<Cell> &cells,
          const auto              &energy) {
        // of what the closed crack bears
        Lanes of_bending = energy();
        for (const Cell &cell : cells)
          planes.closed[lane_of_cell(cell)] = 0.;
        of_bending -= energy();
        Lanes too_much = 0.;
        for (const Cell &cell : cells)
          {
            const unsigned int lane = lane_of_cell(cell);
            planes.closed[lane]     = 1.;
            // stress that varies from -s to s has the energy s^2 V/(6 M);
            // faces that are pressed together bear s up to the pressure
            PointHistory &history = history_of(cell, state.material_memory);
            if (history.tips_of(batch).run_on[lane] == 0.)
              continue;
            const double pressure =
              pressure_on_crack(history.active_point(batch, 0), lane);
            const double bearable =
              planes.released[lane] * pressure * pressure * cell->measure() /
              (6. *
               kernels[discretization.grid.material(cell)]->wave_modulus());
            if (of_bending[lane] > bearable)
              too_much[lane] = 1. - std::sqrt(bearable / of_bending[lane]);
          }
        StabilisedFields<Lanes> since_closing = strain(batch);
        since_closing.add(-1., planes.at_closing);
        planes.at_closing.add(too_much, since_closing);
      });
    change(found.releasing,
           &PointLosses::material,
           [&](PlanesOfBatch &planes,
               const unsigned int,
               const std::vector<Cell> &cells,
               const auto &) {
             for (const Cell &cell : cells)
               planes.released[lane_of_cell(cell)] =
                 1. - stabilisation_due(cell, state.material_memory);
           });
  }
} // namespace Voussoir
