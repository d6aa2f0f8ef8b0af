#include <voussoir/output/stress_points.h>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  Tensor<2, 3>
  inverse_jacobian(const Grid::Cell &cell, const Point<3> &unit)
  {
    Tensor<2, 3> jacobian;
    for (const unsigned int v : cell->vertex_indices())
      jacobian +=
        outer_product(Tensor<1, 3>(cell->vertex(v)),
                      GeometryInfo<3>::d_linear_shape_function_gradient(unit,
                                                                        v));
    return invert(jacobian);
  }


  namespace
  {
    /** A place, or the sum of several places of one point under a linear law,
     *  whose stress under the summed strains is the sum of the stresses. */
    struct Sample
    {
      unsigned int point;
      LawStress    law;

      // gradients of the shape functions by node
      std::map<types::global_dof_index, Tensor<1, 3>> weights;
      double temperature = 0.; // change [K]
    };


    /** @p temperature with its ghosts, or null */
    void
    add(const StressPoints::Place &place,
        const Discretization      &discretization,
        const Vector              *temperature,
        Sample                    &sample)
    {
      const auto &scalar = discretization.fe.base_element(0);
      const auto &partitioner =
        *discretization.matrix_free.get_vector_partitioner();
      const Tensor<2, 3> to_space =
        transpose(inverse_jacobian(place.cell, place.unit));
      const auto nodes = discretization.cell_nodes(place.cell);
      for (unsigned int j = 0; j < nodes.size(); ++j)
        for (const auto &carrier : discretization.carriers(nodes[j]))
          {
            const Tensor<1, 3> unit = scalar.shape_grad(j, place.unit);
            // at a node only the gradients along the lines through it are not
            // zero
            if (unit.norm() > 1e-12)
              sample.weights[carrier.node] +=
                carrier.weight * (to_space * unit);
            if (temperature != nullptr)
              sample.temperature +=
                carrier.weight * scalar.shape_value(j, place.unit) *
                temperature->local_element(
                  partitioner.global_to_local(3 * carrier.node));
          }
    }


    std::vector<unsigned int>
    counted(const std::size_t n)
    {
      std::vector<unsigned int> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0);
      return numbers;
    }
  } // namespace


  StressPoints::StressPoints(const StressModel        &model,
                             const std::vector<Place> &places)
    : StressPoints(model, places, counted(places.size()), places.size())
  {}


  StressPoints::StressPoints(const StressModel               &model,
                             const std::vector<Place>        &places,
                             const std::vector<unsigned int> &point_of_place,
                             const unsigned int               n_points)
    : stress(n_points)
  {
    const bool is_static = model.initial.displacement.size() > 0;
    if (is_static)
      model.initial.temperature.update_ghost_values();
    std::vector<Sample>                                              samples;
    std::map<std::pair<unsigned int, const Material *>, std::size_t> linear;
    for (std::size_t i = 0; i < places.size(); ++i)
      {
        const LawStress law(model, places[i].cell, places[i].unit);
        std::size_t     sample = samples.size();
        if (law.is_always_elastic())
          sample = linear.insert({{point_of_place[i], &law.law()}, sample})
                     .first->second;
        if (sample == samples.size())
          samples.push_back({point_of_place[i], law, {}, 0.});
        add(places[i],
            model.discretization,
            is_static ? &model.initial.temperature : nullptr,
            samples[sample]);
      }

    IndexSet needed(model.discretization.dof_handler.n_dofs());
    {
      std::vector<types::global_dof_index> indices;
      for (const Sample &sample : samples)
        for (const auto &[node, gradient] : sample.weights)
          for (unsigned int d = 0; d < 3; ++d)
            indices.push_back(3 * node + d);
      std::sort(indices.begin(), indices.end());
      needed.add_indices(indices.begin(), indices.end());
    }
    filtered = std::make_unique<FilteredDisplacement>(model, needed);
    const Vector initial =
      is_static ? filtered->entries_of(model.initial.displacement) : Vector();

    for (std::size_t first = 0; first < samples.size(); first += Lanes::size())
      {
        const unsigned int n_samples =
          std::min<std::size_t>(Lanes::size(), samples.size() - first);
        Group      &group       = groups.emplace_back();
        Lanes       temperature = 0.;
        std::size_t longest     = 0;
        for (unsigned int lane = 0; lane < n_samples; ++lane)
          {
            const Sample &sample = samples[first + lane];
            point_of_sample.push_back(sample.point);
            group.laws.set(lane, sample.law);
            temperature[lane] = sample.temperature;
            longest           = std::max(longest, sample.weights.size());
          }
        const std::size_t begin = weights.size();
        weights.resize(begin + longest);
        for (unsigned int lane = 0; lane < Lanes::size(); ++lane)
          {
            // a lane without further points gets an entry that is not used
            const auto &own =
              samples[first + (lane < n_samples ? lane : 0)].weights;
            for (std::size_t i = begin; i < weights.size(); ++i)
              weights[i].entries[lane] =
                filtered->entry(3 * own.begin()->first);
            if (lane >= n_samples)
              continue;
            std::size_t i = begin;
            for (const auto &[node, gradient] : own)
              {
                weights[i].entries[lane] = filtered->entry(3 * node);
                for (unsigned int d = 0; d < 3; ++d)
                  weights[i].gradient[d][lane] = gradient[d];
                ++i;
              }
          }
        group.end_of_weights = weights.size();
        if (is_static)
          group.laws.set_initial(strain(groups.size() - 1, initial),
                                 temperature);
      }
    if (is_static)
      model.initial.temperature.zero_out_ghost_values();
  }


  SymmetricTensor3<Lanes>
  StressPoints::strain(const unsigned int group,
                       const Vector      &displacement) const
  {
    Tensor<2, 3, Lanes> gradient;
    for (std::size_t i = group == 0 ? 0 : groups[group - 1].end_of_weights;
         i < groups[group].end_of_weights;
         ++i)
      for (unsigned int d = 0; d < 3; ++d)
        {
          Lanes value;
          value.gather(displacement.begin() + d, weights[i].entries.data());
          gradient[d] += value * weights[i].gradient;
        }
    return symmetrize(gradient);
  }


  const std::vector<SymmetricTensor<2, 3>> &
  StressPoints::evaluate(const State &state)
  {
    filtered->update(state);
    std::fill(stress.begin(), stress.end(), SymmetricTensor<2, 3>());
    for (unsigned int g = 0; g < groups.size(); ++g)
      {
        const LawStressLanes   &laws  = groups[g].laws;
        SymmetricTensor3<Lanes> total = strain(g, filtered->displacement());
        if (const Vector *memory = filtered->memory())
          total += laws.damping_factors() * strain(g, *memory);
        const auto        sample = laws(total);
        const std::size_t first  = g * Lanes::size();
        const std::size_t n =
          std::min<std::size_t>(Lanes::size(), point_of_sample.size() - first);
        for (std::size_t lane = 0; lane < n; ++lane)
          {
            auto &point = stress[point_of_sample[first + lane]];
            for (unsigned int c = 0; c < 6; ++c)
              point.access_raw_entry(c) += sample.access_raw_entry(c)[lane];
          }
      }
    return stress;
  }
} // namespace Voussoir
