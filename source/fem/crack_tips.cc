#include <voussoir/fem/cell_neighbors.h>
#include <voussoir/fem/crack_growth.h>
#include <voussoir/fem/crack_tips.h>
#include <voussoir/fem/notches.h>

#include <deal.II/grid/grid_tools.h>

#include <optional>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Whether the plane cuts the face. */
    template <typename Face>
    bool
    cuts(const Point<3> &point, const Tensor<1, 3> &normal, const Face &face)
    {
      bool above = false, below = false;
      for (const unsigned int v : face->vertex_indices())
        {
          const double distance = normal * (face->vertex(v) - point);
          above                 = above || distance > 0.;
          below                 = below || distance < 0.;
        }
      return above && below;
    }
  } // namespace


  CrackTips::CrackTips(const Discretization                  &discretization,
                       const std::vector<const CellKernel *> &kernels)
    : discretization(discretization)
    , kernels(kernels)
  {
    for (const CellKernel *kernel : kernels)
      follows_tips.push_back(kernel->cracks_grow() &&
                             !kernel->cracks_along_planes());
    if (!is_needed())
      return;
    is_shared.resize(discretization.grid.triangulation().n_vertices(), false);
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_ghost())
        for (const unsigned int v : cell->vertex_indices())
          is_shared[cell->vertex_index(v)] = true;
  }


  bool
  CrackTips::is_needed() const
  {
    return std::find(follows_tips.begin(), follows_tips.end(), true) !=
           follows_tips.end();
  }


  void
  CrackTips::update(const unsigned long long step, MaterialMemory &memory) const
  {
    if (step % steps_between_looks == 0)
      find(memory);
  }


  bool
  CrackTips::find(MaterialMemory &memory) const
  {
    if (!is_needed() || memory.empty())
      return false;
    std::vector<Crack> cracks = new_cracks(memory);
    exchange(cracks);
    bool is_weaker = false;
    for (const Crack &crack : cracks)
      is_weaker = propagate(crack, memory) || is_weaker;
    return is_weaker;
  }


  void
  CrackTips::take_over(const std::vector<const CellKernel *> &of_static_state,
                       MaterialMemory                        &memory) const
  {
    if (memory.empty() || !any_cracks_grow(kernels))
      return;
    const std::vector<Notch> notches = notches_of_cells(discretization.grid);
    for (unsigned int m = 0; m < kernels.size(); ++m)
      if (kernels[m]->cracks_grow())
        for (const auto &[cell, place] : memory.of(m)->cells())
          {
            double &strength =
              memory.of(m)->tips_of(place.batch).strength[place.lane];
            const Notch &notch = notches[discretization.grid.owned_cell(cell)];
            const double size  = std::cbrt(cell->measure());
            if (strength < strength_at_notch(*of_static_state[m], notch, size))
              strength = strength_at(cell);
            else if (strength < 1.)
              strength = strength_at_notch(*kernels[m], notch, size);
          }
  }


  std::vector<CrackTips::Crack>
  CrackTips::new_cracks(MaterialMemory &memory) const
  {
    std::vector<Crack> cracks;
    for (unsigned int m = 0; m < kernels.size(); ++m)
      {
        if (!follows_tips[m])
          continue;
        PointHistory &history = *memory.of(m);
        for (const auto &[cell, place] : history.cells())
          {
            const auto [batch, lane] = place;
            Tensor<1, 3> sum;
            for (unsigned int q = 0; q < history.n_points(); ++q)
              if (history.band(place, q) > 0. &&
                  history.tips_of(batch).run_on[lane] == 0. &&
                  kernels[m]->is_cracked(history.read(place, q).data()))
                {
                  Tensor<1, 3> normal;
                  for (unsigned int d = 0; d < 3; ++d)
                    normal[d] = history.active_point(batch, q).normal[d][lane];
                  sum += sum * normal < 0. ? -normal : normal;
                }
            if (sum.norm() > 0.)
              {
                cracks.push_back({cell, sum});
                history.tips_of(batch).run_on[lane] = 1.;
              }
          }
      }
    return cracks;
  }


  void
  CrackTips::exchange(std::vector<Crack> &cracks) const
  {
    std::map<Cell, Tensor<1, 3>> shared;
    for (const Crack &crack : cracks)
      for (const unsigned int v : crack.cell->vertex_indices())
        if (is_shared[crack.cell->vertex_index(v)])
          shared.emplace(crack.cell, crack.normal);
    const unsigned int n_most =
      Utilities::MPI::max(static_cast<unsigned int>(shared.size()),
                          discretization.grid.communicator());
    if (n_most == 0)
      return;
    using Sent = std::optional<Tensor<1, 3>>;
    GridTools::exchange_cell_data_to_ghosts<Tensor<1, 3>, DoFHandler<3>>(
      discretization.dof_handler,
      [&](const Cell &cell) -> Sent {
        const auto crack = shared.find(cell);
        return crack == shared.end() ? Sent() : Sent(crack->second);
      },
      [&](const Cell &cell, const Tensor<1, 3> &normal) {
        cracks.push_back({cell, normal});
      });
  }


  bool
  CrackTips::propagate(const Crack &crack, MaterialMemory &memory) const
  {
    const Point<3> centre    = crack.cell->center();
    bool           is_weaker = false;
    for_each_neighbor(crack.cell, [&](const Cell &neighbor, const auto &face) {
      if (cuts(centre, crack.normal, face))
        is_weaker = weaken(neighbor, memory) || is_weaker;
    });
    return is_weaker;
  }


  bool
  CrackTips::weaken(const Cell &cell, MaterialMemory &memory) const
  {
    if (!cell->is_locally_owned())
      return false;
    const unsigned int material = discretization.grid.material(cell);
    if (!follows_tips[material])
      return false;
    const auto [batch, lane] = discretization.place_of(cell);
    double      &strength = memory.of(material)->tips_of(batch).strength[lane];
    const double before   = strength;
    strength              = std::min(strength, strength_at(cell));
    return strength < before;
  }


  double
  CrackTips::strength_at(const Cell &cell) const
  {
    return kernels[discretization.grid.material(cell)]->tip_strength(
      std::cbrt(cell->measure()));
  }
} // namespace Voussoir
