#include <voussoir/output/stress_points.h>

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


  StressPoints::StressPoints(const ObservedModel      &model,
                             const std::vector<Place> &places)
  {
    const Discretization &discretization = model.discretization;
    const auto           &scalar         = discretization.fe.base_element(0);
    const auto           &partitioner =
      *discretization.matrix_free.get_vector_partitioner();
    const bool is_static = model.initial.displacement.size() > 0;
    if (is_static)
      model.initial.temperature.update_ghost_values();
    for (const Place &place : places)
      {
        const Tensor<2, 3> to_space =
          transpose(inverse_jacobian(place.cell, place.unit));
        const auto nodes  = discretization.cell_nodes(place.cell);
        double     degree = 0.;
        for (unsigned int j = 0; j < nodes.size(); ++j)
          for (const auto &carrier : discretization.carriers(nodes[j]))
            {
              const unsigned int entry =
                partitioner.global_to_local(3 * carrier.node);
              weights.push_back(
                {entry,
                 carrier.weight *
                   (to_space * scalar.shape_grad(j, place.unit))});
              if (is_static)
                degree += carrier.weight * scalar.shape_value(j, place.unit) *
                          model.initial.temperature.local_element(entry);
            }
        end_of_weights.push_back(weights.size());
        laws.emplace_back(model, place.cell, place.unit);
        temperature.push_back(degree);
      }
    initial_strain.resize(places.size());
    stress.resize(places.size());
    if (is_static)
      {
        model.initial.temperature.zero_out_ghost_values();
        model.initial.displacement.update_ghost_values();
        for (unsigned int p = 0; p < places.size(); ++p)
          initial_strain[p] = strain(p, model.initial.displacement);
        model.initial.displacement.zero_out_ghost_values();
      }
  }


  SymmetricTensor<2, 3>
  StressPoints::strain(const unsigned int point,
                       const Vector      &displacement) const
  {
    Tensor<2, 3> gradient;
    for (std::size_t i = point == 0 ? 0 : end_of_weights[point - 1];
         i < end_of_weights[point];
         ++i)
      for (unsigned int d = 0; d < 3; ++d)
        gradient[d] += displacement.local_element(weights[i].entry + d) *
                       weights[i].gradient;
    return symmetrize(gradient);
  }


  const std::vector<SymmetricTensor<2, 3>> &
  StressPoints::evaluate(const Vector &displacement)
  {
    displacement.update_ghost_values();
    for (unsigned int p = 0; p < stress.size(); ++p)
      stress[p] =
        laws[p](strain(p, displacement), initial_strain[p], temperature[p]);
    displacement.zero_out_ghost_values();
    return stress;
  }
} // namespace Voussoir
