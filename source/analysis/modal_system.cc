#include <voussoir/analysis/modal_system.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/lumped_mass.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::vector<bool>
    among(const std::vector<std::string> &materials, const std::string &names)
    {
      std::vector<bool> result(materials.size(), false);
      for (const std::string &name : split_list(names))
        result[std::find(materials.begin(), materials.end(), name) -
               materials.begin()] = true;
      return result;
    }


    AffineConstraints<double>
    modal_constraints(const ModalModel &model, const ModeParameters &parameters)
    {
      return model.solid.discretization.make_constraints(
        model.boundaries.supports_with_absorbing(false),
        among(model.material_names, parameters.fixed_materials));
    }


    /** Stiffness of a solid cell of the size of the water's cells [N/m]. */
    double
    typical_stiffness(const ModalModel &model)
    {
      double modulus = 0.;
      for (const Material *material : model.solid.materials)
        modulus =
          std::max(modulus, material->elastic_constants().young_modulus);
      const AcousticSpace &space = model.reservoir->space;
      const double         size  = std::cbrt(
        space.volumes.mean_value()); // deal.II's mean over all unknowns
      return modulus * size;
    }


    /** Sine waves of arbitrary direction, scaled to the extent of a body. */
    class Waves
    {
    public:
      Waves(const std::vector<Point<3>>                     &nodes,
            const std::function<double(const unsigned int)> &mass_of_node,
            const MPI_Comm                                   communicator)
        : nodes(nodes)
      {
        std::vector<double> moments(7);
        for (unsigned int node = 0; node < nodes.size(); ++node)
          {
            const double m = mass_of_node(node);
            moments[6] += m;
            for (unsigned int d = 0; d < 3; ++d)
              {
                moments[d] += m * nodes[node][d];
                moments[3 + d] += m * nodes[node][d] * nodes[node][d];
              }
          }
        moments = sum_over_ranks(moments, communicator);
        for (unsigned int d = 0; d < 3; ++d)
          {
            centre[d] = moments[d] / moments[6];
            extent[d] = std::sqrt(
              std::max(0.,
                       moments[3 + d] / moments[6] - centre[d] * centre[d]));
          }
      }

      /** The value at each node, at a stride. */
      void
      draw(std::mt19937 &generator, double *values, const unsigned int apart)
      {
        // raw numbers, which are the same everywhere
        const auto   number   = [&] { return generator() / 2147483648. - 1.; };
        const double smallest = 0.01 * extent.norm();
        Tensor<1, 3> wave_number;
        for (unsigned int d = 0; d < 3; ++d)
          wave_number[d] =
            2. * numbers::PI / 3. * number() / std::max(extent[d], smallest);
        const double phase = numbers::PI * number();
        for (unsigned int node = 0; node < nodes.size(); ++node)
          values[apart * node] =
            std::cos(wave_number * (nodes[node] - centre) + phase);
      }

    private:
      const std::vector<Point<3>> &nodes;
      Point<3>                     centre;
      Tensor<1, 3>                 extent; // standard deviations
    };
  } // namespace


  ModalSystem::ModalSystem(const ModalModel     &model,
                           const ModeParameters &parameters)
    : model(model)
    , parameters(parameters)
    , moduli_as_given(model.solid.internal_force.with(
        std::vector<double>(model.solid.materials.size(), 1.)))
    , constraints(modal_constraints(model, parameters))
    , from(model.solid.discretization.create_vector())
    , to(from)
  {
    if (model.contact != nullptr)
      tie();
    find_structural_mass();
  }


  void
  ModalSystem::tie()
  {
    const Contact &contact = *model.contact;
    const bool     all = parameters.interfaces == InterfacesInModes::all_tied;
    const auto     is_closed = [&](const ContactPoint &point) {
      return all || contact.touches(point) || point.force[0] > 0.;
    };
    std::vector<unsigned int> sums(3);
    for (const ContactPoint &point : contact.points())
      {
        sums[0] += 1;
        if (is_closed(point))
          sums[1] += 1;
        else if (contact.surfaces()[point.surface].bar_stiffness > 0.)
          sums[2] += 1;
      }
    sums   = sum_over_ranks(sums, model.solid.grid().communicator());
    points = {sums[0], sums[1], sums[2] > 0};
    ties.emplace(model.solid.discretization, contact, is_closed);
    constraints = ties->added_to(constraints);
  }


  void
  ModalSystem::find_structural_mass()
  {
    const auto massless =
      among(model.material_names, parameters.massless_materials);
    std::vector<double> density;
    for (unsigned int m = 0; m < massless.size(); ++m)
      density.push_back(
        massless[m] ? 0. : model.solid.materials[m]->inertial_density());
    const Discretization &discretization = model.solid.discretization;
    structure = LumpedMass(discretization, density, density).mass;
    if (ties)
      ties->collect(structure);
    for (unsigned int i = 0; i < structure.locally_owned_size(); ++i)
      if (constraints.is_constrained(
            discretization.owned_dofs.nth_index_in_set(i)))
        structure.local_element(i) = 0.;
  }


  void
  ModalSystem::set_up()
  {
    ElasticSolver::Additions additions;
    additions.ties = ties ? &*ties : nullptr;
    solver.emplace(model.solid.discretization,
                   moduli_as_given,
                   model.solid.materials,
                   constraints,
                   additions);
    if (model.reservoir != nullptr)
      water.emplace(*model.reservoir,
                    parameters.water == WaterInModes::compressible ?
                      typical_stiffness(model) :
                      0.);
  }


  std::size_t
  ModalSystem::size() const
  {
    return structure.locally_owned_size() + (water ? water->size() : 0);
  }


  types::global_dof_index
  ModalSystem::n_with_mass() const
  {
    types::global_dof_index moving = 0;
    for (const double entry : structure)
      moving += entry > 0.;
    return Utilities::MPI::sum(moving, structure.get_mpi_communicator());
  }


  const ModalSystem::TiedPoints &
  ModalSystem::tied_points() const
  {
    return points;
  }


  bool
  ModalSystem::has_added_mass() const
  {
    if (model.reservoir != nullptr)
      return true;
    double largest = 0.;
    if (parameters.water != WaterInModes::none)
      for (const NodalTerms::Matrix &added : model.terms.added_mass)
        largest = std::max(largest, added.norm());
    return Utilities::MPI::max(largest, structure.get_mpi_communicator()) > 0.;
  }


  void
  ModalSystem::stiffness(double *force, const double *motion) const
  {
    const unsigned int n = structure.locally_owned_size();
    std::copy_n(motion, n, from.begin());
    solver->apply(to, from);
    solver->clear_constrained(to);
    std::copy_n(to.begin(), n, force);
    for (std::size_t i = n; i < size(); ++i)
      force[i] = water->stiffness * motion[i];
  }


  void
  ModalSystem::mass(double *momentum, const double *motion) const
  {
    const unsigned int n = structure.locally_owned_size();
    std::copy_n(motion, n, from.begin());
    if (ties)
      ties->distribute(from);
    to = from;
    to.scale(structure);
    std::fill(momentum + n, momentum + size(), 0.);
    if (water)
      water->add_momentum(to, momentum + n, from, motion + n);
    else if (parameters.water != WaterInModes::none)
      for (unsigned int slot = 0; slot < model.terms.nodes.size(); ++slot)
        {
          const unsigned int first = 3 * model.terms.nodes[slot];
          for (unsigned int d = 0; d < 3; ++d)
            for (unsigned int e = 0; e < 3; ++e)
              to.local_element(first + d) +=
                model.terms.added_mass[slot][d][e] *
                from.local_element(first + e);
        }
    if (ties)
      ties->collect(to);
    solver->clear_constrained(to);
    std::copy_n(to.begin(), n, momentum);
  }


  void
  ModalSystem::precondition(double *motion, const double *force) const
  {
    const unsigned int n = structure.locally_owned_size();
    std::copy_n(force, n, from.begin());
    solver->precondition(to, from);
    std::copy_n(to.begin(), n, motion);
    for (std::size_t i = n; i < size(); ++i)
      motion[i] = force[i] / water->stiffness;
  }


  std::vector<ModalSystem::Motion>
  ModalSystem::start(const unsigned int number) const
  {
    const MPI_Comm communicator = structure.get_mpi_communicator();
    Waves          waves(
      model.solid.discretization.node_positions,
      [&](const unsigned int node) {
        double m = 0.; // a roller may fix some of the directions
        for (unsigned int d = 0; d < 3; ++d)
          m += structure.local_element(3 * node + d);
        return m;
      },
      communicator);
    std::optional<Waves> in_water;
    if (water && water->stiffness > 0.)
      in_water.emplace(
        model.reservoir->space.node_positions,
        [&](const unsigned int node) {
          return model.reservoir->space.volumes.local_element(node);
        },
        communicator);

    std::mt19937        generator(1);
    std::vector<Motion> result(number, Motion(size()));
    Motion              wave(size()), force(size());
    for (Motion &motion : result)
      {
        for (unsigned int d = 0; d < 3; ++d)
          waves.draw(generator, wave.data() + d, 3);
        if (in_water)
          {
            double *pressures = wave.data() + structure.locally_owned_size();
            in_water->draw(generator, pressures, 1);
            water->clear_surface(pressures);
          }
        mass(force.data(), wave.data());
        precondition(motion.data(), force.data());
      }
    return result;
  }


  ModalSystem::Motion
  ModalSystem::rigid_momentum(const unsigned int direction) const
  {
    Motion motion(size()), momentum(size());
    for (unsigned int i = direction; i < structure.locally_owned_size(); i += 3)
      motion[i] = 1.;
    mass(momentum.data(), motion.data());
    if (!water)
      return momentum;
    to = 0.;
    water->add_momentum_of_floor(
      to, momentum.data() + structure.locally_owned_size(), direction);
    if (ties)
      ties->collect(to);
    solver->clear_constrained(to);
    for (unsigned int i = 0; i < structure.locally_owned_size(); ++i)
      momentum[i] += to.local_element(i);
    return momentum;
  }


  ModalSystem::Motion
  ModalSystem::divided_by_mass(const Motion &momentum) const
  {
    constexpr unsigned int most      = 1000;
    constexpr double       tolerance = 1e-8;

    // without water this is the mass, and one step suffices
    Motion weight(size(), structure.linfty_norm());
    for (unsigned int i = 0; i < structure.locally_owned_size(); ++i)
      if (structure.local_element(i) > 0.)
        weight[i] = structure.local_element(i);

    Motion motion(size()), residual = momentum, direction(size()),
                           scaled(size()), product_with(size());
    const double square = product(momentum, momentum);
    double       last   = 0.;
    for (unsigned int i = 0; i < most && product(residual, residual) >
                                           tolerance * tolerance * square;
         ++i)
      {
        for (std::size_t j = 0; j < size(); ++j)
          scaled[j] = residual[j] / weight[j];
        const double now  = product(residual, scaled);
        const double keep = i == 0 ? 0. : now / last;
        last              = now;
        for (std::size_t j = 0; j < size(); ++j)
          direction[j] = scaled[j] + keep * direction[j];
        mass(product_with.data(), direction.data());
        const double step = now / product(direction, product_with);
        for (std::size_t j = 0; j < size(); ++j)
          {
            motion[j] += step * direction[j];
            residual[j] -= step * product_with[j];
          }
      }
    return motion;
  }


  double
  ModalSystem::product(const Motion &a, const Motion &b) const
  {
    return Utilities::MPI::sum(
      std::inner_product(a.begin(), a.end(), b.begin(), 0.),
      structure.get_mpi_communicator());
  }


  Vector
  ModalSystem::solid_part(const Motion &force) const
  {
    Vector result(structure);
    std::copy_n(force.begin(), result.locally_owned_size(), result.begin());
    return result;
  }


  Vector
  ModalSystem::displacement(const Motion &motion) const
  {
    Vector result = solid_part(motion);
    if (ties)
      ties->distribute(result);
    return result;
  }
} // namespace Voussoir
