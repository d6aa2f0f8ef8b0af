#include <voussoir/base/mpi.h>
#include <voussoir/fem/lanczos.h>
#include <voussoir/loads/reservoir_end.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Motion above the frequencies of this number of modes leaves as plane
    // waves: in a canyon with 280 m of water, above 20 Hz.
    constexpr unsigned int most_modes = 64;

    // Sine of the slope of an end above which the log has a warning.
    constexpr double largest_slope = 0.1;


    /** Sine of the largest angle between the end and the vertical, and between
     *  its normal and the edges of the cell before it. */
    double
    slope(const Grid::Cell &cell, const unsigned int face)
    {
      using Geometry    = GeometryInfo<3>;
      const auto corner = [&](const unsigned int side, const unsigned int v) {
        return cell->vertex(Geometry::face_to_cell_vertices(side, v));
      };
      Tensor<1, 3> normal = cross_product_3d(corner(face, 3) - corner(face, 0),
                                             corner(face, 2) - corner(face, 1));
      normal /= normal.norm();
      double result = std::abs(normal[2]);
      for (unsigned int v = 0; v < Geometry::vertices_per_face; ++v)
        {
          const Tensor<1, 3> edge =
            corner(face, v) - corner(Geometry::opposite_face[face], v);
          result =
            std::max(result,
                     (edge - (edge * normal) * normal).norm() / edge.norm());
        }
      return result;
    }
  } // namespace


  ReservoirEnd::ReservoirEnd(const AcousticSpace                &space,
                             const AcousticSpace::FacePredicate &is_end,
                             const Water                        &water,
                             Log                                &log)
    : communicator(space.grid.communicator())
    , density(water.density)
    , speed(water.speed)
  {
    number_nodes(space, water);
    assemble(space, is_end, log);
    if (water.is_channel)
      find_modes();
  }


  void
  ReservoirEnd::number_nodes(const AcousticSpace &space, const Water &water)
  {
    // by keys that do not depend on the ranks
    using Values    = Tensor<1, 4>;
    const auto keys = space.node_keys();
    std::vector<
      std::pair<std::uint64_t, std::pair<types::global_dof_index, Values>>>
                                          mine;
    std::map<std::uint64_t, unsigned int> owned;
    for (unsigned int i = 0; i < keys.size(); ++i)
      if (water.end_areas.local_element(i) > 0.)
        {
          Values values;
          values[0] = water.end_areas.local_element(i);
          values[1] = space.volumes.local_element(i);
          values[2] = water.bottom_dashpots.local_element(i);
          values[3] = water.inverse_storage.local_element(i) == 0. ? 1. : 0.;
          mine.push_back(
            {keys[i], {space.owned_dofs.nth_index_in_set(i), values}});
          owned[keys[i]] = i;
        }
    auto all = join_over_ranks(mine, communicator);
    std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
    for (const auto &[key, node] : all)
      {
        if (const auto here = owned.find(key); here != owned.end())
          nodes.push_back(
            {here->second, static_cast<unsigned int>(dof_of_node.size())});
        dof_of_node.push_back(node.first);
        areas.push_back(node.second[0]);
        volumes.push_back(node.second[1]);
        dashpots.push_back(node.second[2]);
        in_surface.push_back(node.second[3] > 0.);
      }
  }


  void
  ReservoirEnd::assemble(const AcousticSpace                &space,
                         const AcousticSpace::FacePredicate &is_end,
                         Log                                &log)
  {
    using Dof = types::global_dof_index;
    FEFaceValues<3>                                     values(space.mapping,
                           space.fe,
                           QGauss<2>(space.fe.degree + 1),
                           update_gradients | update_normal_vectors |
                             update_JxW_values);
    std::vector<std::pair<std::pair<Dof, Dof>, double>> mine;

    std::vector<Dof> dofs(space.fe.n_dofs_per_cell());
    double           leans = 0.;
    for (const auto &cell : space.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int face : cell->face_indices())
          if (cell->at_boundary(face) && is_end(cell, face))
            {
              leans = std::max(leans, slope(cell, face));
              values.reinit(cell, face);
              cell->get_dof_indices(dofs);
              const auto across = [&](const unsigned int j,
                                      const unsigned int q) {
                const Tensor<1, 3> &n = values.normal_vector(q);
                return values.shape_grad(j, q) -
                       (values.shape_grad(j, q) * n) * n;
              };
              for (const unsigned int i : values.dof_indices())
                for (const unsigned int j : values.dof_indices())
                  if (space.fe.has_support_on_face(i, face) &&
                      space.fe.has_support_on_face(j, face))
                    {
                      double sum = 0.;
                      for (const unsigned int q :
                           values.quadrature_point_indices())
                        sum += across(i, q) * across(j, q) * values.JxW(q);
                      mine.push_back({{dofs[i], dofs[j]}, sum});
                    }
            }
    leans = Utilities::MPI::max(leans, communicator);
    if (leans > largest_slope)
      log.warn(
        "the \"Radiating end\" in section \"Reservoir\", or cells before "
        "it, lean by up to ",
        std::asin(std::min(leans, 1.)) * 180. / numbers::PI,
        " degrees; the far reservoir behind it is computed for an upright end "
        "with cells at right angles to it");

    std::map<Dof, unsigned int> number;
    for (unsigned int i = 0; i < dof_of_node.size(); ++i)
      number[dof_of_node[i]] = i;
    const auto             all = join_over_ranks(mine, communicator);
    DynamicSparsityPattern entries(areas.size());
    for (const auto &[pair, value] : all)
      entries.add(number.at(pair.first), number.at(pair.second));
    pattern.copy_from(entries);
    stiffness.reinit(pattern);
    for (const auto &[pair, value] : all)
      stiffness.add(number.at(pair.first), number.at(pair.second), value);
  }


  void
  ReservoirEnd::find_modes()
  {
    // one rank computes the modes, so that all have the same to the last bit
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      modes =
        find_channel_modes(stiffness, areas, in_surface, speed, most_modes);
    modes.frequencies =
      Utilities::MPI::broadcast(communicator, modes.frequencies);
    modes.shapes = Utilities::MPI::broadcast(communicator, modes.shapes);
    const unsigned int n = modes.frequencies.size();

    // the decay rate of amplitude is half of rho c^2 C / M at the bottom
    modes.decay.assign(n, 0.);
    for (unsigned int i = 0; i < areas.size(); ++i)
      for (unsigned int j = 0; j < n; ++j)
        modes.decay[j] += 0.5 * density * speed * speed * dashpots[i] *
                          areas[i] / volumes[i] *
                          Utilities::fixed_power<2>(modes.shapes[i * n + j]);
    for (unsigned int j = 0; j < n; ++j)
      modes.decay[j] = std::min(modes.decay[j], modes.frequencies[j]);
  }


  double
  ReservoirEnd::apply_stiffness(const unsigned int         node,
                                const std::vector<double> &impulse) const
  {
    double sum = 0.;
    for (auto entry = stiffness.begin(node); entry != stiffness.end(node);
         ++entry)
      sum += entry->value() * impulse[entry->column()];
    return sum;
  }


  double
  ReservoirEnd::stable_step() const
  {
    Vector start(areas.size()), inverse(areas.size());
    for (unsigned int i = 0; i < areas.size(); ++i)
      {
        start.local_element(i)   = std::sin(1. + i * i);
        inverse.local_element(i) = in_surface[i] ? 0. : 1. / areas[i];
      }
    std::vector<double> values(areas.size());
    const double        largest =
      largest_eigenvalue(start, inverse, [&](Vector &dst, const Vector &src) {
        std::copy(src.begin(), src.end(), values.begin());
        for (unsigned int i = 0; i < values.size(); ++i)
          dst.local_element(i) = apply_stiffness(i, values);
      });
    return largest > 0. ? 2. / (speed * std::sqrt(largest)) :
                          std::numeric_limits<double>::max();
  }
} // namespace Voussoir
