#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/constraints/bond_tips.h>
#include <voussoir/fem/crack_growth.h>
#include <voussoir/mesh/interfaces.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // A set of surfaces as the bits of the three components of a node.
    constexpr unsigned int bits_of_component = 52;

    std::uint64_t
    bits(const double component)
    {
      return static_cast<std::uint64_t>(component);
    }

    bool
    contains(const double *set, const unsigned int surface)
    {
      return (bits(set[surface % 3]) >> (surface / 3)) & 1;
    }

    void
    insert(Tensor<1, 3> &set, const unsigned int surface)
    {
      double &component = set[surface % 3];
      component         = bits(component) | (std::uint64_t(1) << (surface / 3));
    }

    /** Number of surfaces of a set before this one. */
    unsigned int
    place_in(const double *set, const unsigned int surface)
    {
      unsigned int n = 0;
      for (unsigned int s = 0; s < surface; ++s)
        n += contains(set, s);
      return n;
    }


    bool
    has_tips(const InterfacePoints &points, const unsigned int surface)
    {
      return points.surfaces[surface].law->grows_from_tips();
    }


    bool
    has_bond(const InterfacePoints &points, const unsigned int point)
    {
      const ContactSurface &surface =
        points.surfaces[points.points[point].surface];
      return surface.tied || surface.law->strength({}).tension > 0.;
    }


    bool
    is_cracked(const ContactPoint &point)
    {
      return point.joined && point.history.is_cracked();
    }


    /** Largest share of a row of cells that belongs to a node, of a cell. */
    double
    largest_share(const unsigned int degree)
    {
      const auto weights = QGaussLobatto<1>(degree + 1).get_weights();
      return std::max(2. * weights.front(),
                      *std::max_element(weights.begin(), weights.end()));
    }


    /** Pairs of neighbours among the nodes of a cell, by their numbers. */
    std::vector<std::pair<unsigned int, unsigned int>>
    neighbours_in_cell(const FiniteElement<3> &scalar)
    {
      const auto                 &nodes = scalar.get_unit_support_points();
      const std::vector<Point<1>> line =
        QGaussLobatto<1>(scalar.degree + 1).get_points();
      const auto index = [&](const unsigned int node, const unsigned int d) {
        return std::lower_bound(line.begin(),
                                line.end(),
                                nodes[node][d] - 1e-8,
                                [](const Point<1> &point, const double x) {
                                  return point[0] < x;
                                }) -
               line.begin();
      };
      std::vector<std::pair<unsigned int, unsigned int>> pairs;
      for (unsigned int i = 0; i < nodes.size(); ++i)
        for (unsigned int j = 0; j < nodes.size(); ++j)
          {
            unsigned int apart = 0;
            for (unsigned int d = 0; d < 3; ++d)
              apart += std::abs(index(i, d) - index(j, d));
            if (apart == 1)
              pairs.emplace_back(i, j);
          }
      return pairs;
    }
  } // namespace


  BondTips::BondTips(const Solid &solid, InterfacePoints &points)
    : component(points.points.size())
    , tip(points.points.size())
    , sets(solid.discretization.owned_dofs,
           solid.discretization.relevant_dofs,
           points.communicator)
  {
    if (points.surfaces.size() > 3 * bits_of_component)
      throw UserError(
        "Cracks can grow from tips in cases whose interfaces have "
        "156 face sets at most; set \"Crack growth = local\" in "
        "their sections.");
    find_moduli(solid, points);
    find_pairs(points);
    find_neighbours(solid.discretization, points);
    farthest = distances(points, std::vector<bool>(points.points.size(), true));
  }


  void
  BondTips::find_pairs(const InterfacePoints &points)
  {
    for (const ContactPoints::Cluster &cluster : points.clusters())
      {
        const unsigned int end   = cluster.first_point + cluster.n_points;
        bool               cross = true;
        for (unsigned int k = cluster.first_point; k < end; ++k)
          cross &= has_tips(points, points.points[k].surface);
        for (unsigned int k = cluster.first_point; k < end; ++k)
          for (unsigned int l = cluster.first_point; l < end; ++l)
            {
              const ContactPoint &one   = points.points[k],
                                 &other = points.points[l];
              if (one.surface == other.surface)
                {
                  if (cross && k != l)
                    twins.push_back({{k, l}});
                }
              else if (has_tips(points, one.surface) &&
                       std::minmax(one.first, one.second) ==
                         std::minmax(other.first, other.second))
                continued.push_back({{k, l}});
            }
      }
  }


  void
  BondTips::find_moduli(const Solid &solid, InterfacePoints &points)
  {
    const Discretization &discretization = solid.discretization;
    Vector                compliance(sets); // in the earthquake and at rest
    for (const std::string &name : points.names)
      for (const std::string &side : {name, name + other_side})
        discretization.grid.for_each_face(
          side, [&](const auto &cell, const unsigned int) {
            const Material &material = solid.material_of(cell),
                           &at_rest  = material.at_rest();
            const double stiffness[] = {
              material.elastic_constants().young_modulus,
              material.factor_at_rest() *
                at_rest.elastic_constants().young_modulus};
            for (const types::global_dof_index node :
                 discretization.cell_nodes(discretization.dof_cell(cell)))
              for (unsigned int i = 0; i < 2; ++i)
                compliance(3 * node + i) =
                  std::max(compliance(3 * node + i), 1. / stiffness[i]);
          });
    compliance.compress(VectorOperation::max);
    std::vector<Tensor<1, 3>> at_nodes(points.n_nodes());
    points.exchange().to_clusters(compliance, at_nodes);
    for (const ContactPoint &point : points.points)
      for (const auto &[result, i] :
           {std::pair{&modulus, 0}, std::pair{&modulus_at_rest, 1}})
        result->push_back(
          1. / std::max(at_nodes[point.first][i], at_nodes[point.second][i]));
  }


  void
  BondTips::find_neighbours(const Discretization &discretization,
                            InterfacePoints      &points)
  {
    ContactExchange          &exchange = points.exchange();
    const auto               &owned    = exchange.owned_nodes();
    std::vector<Tensor<1, 3>> surfaces(points.n_nodes()),
      at_owned(owned.size());
    for (const ContactPoint &point : points.points)
      if (has_tips(points, point.surface))
        insert(surfaces[point.first], point.surface);
    for (unsigned int k = 0; k < points.points.size(); ++k)
      if (has_tips(points, points.points[k].surface))
        component[k] = place_in(surfaces[points.points[k].first].begin_raw(),
                                points.points[k].surface);
    std::vector<Point<3>> crowded;
    for (unsigned int k = 0; k < component.size(); ++k)
      if (component[k] >= 3 && crowded.empty())
        crowded.push_back(points.positions[k]);
    crowded = join_over_ranks(crowded, points.communicator);
    if (!crowded.empty())
      {
        std::ostringstream place;
        place << crowded.front();
        throw UserError(
          "Cracks cannot grow from tips where more than three face sets of "
          "interfaces meet at one side of a node, as at (" +
          place.str() +
          ") m; set \"Crack growth = local\" in the sections of some.");
      }
    exchange.to_owners(surfaces, at_owned);

    const auto  &scalar = discretization.fe.base_element(0);
    const auto   pairs  = neighbours_in_cell(scalar);
    const double share  = largest_share(scalar.degree);
    for (unsigned int s = 0; s < points.surfaces.size(); ++s)
      if (has_tips(points, s))
        for (const auto &[cell, face] :
             discretization.grid.faces(points.names[s]))
          {
            const auto nodes =
              discretization.cell_nodes(discretization.dof_cell(cell));
            const auto on_face = [&, f = face](const unsigned int node) {
              return scalar.has_support_on_face(node, f);
            };
            for (const auto &[node, other] : pairs)
              {
                if (!on_face(node) || !on_face(other) ||
                    !discretization.owned_dofs.is_element(3 * nodes[node]))
                  continue;
                const unsigned int local =
                  discretization.owned_node(nodes[node]);
                const auto at =
                  std::lower_bound(owned.begin(), owned.end(), local);
                if (at == owned.end() || *at != local ||
                    !contains(at_owned[at - owned.begin()].begin_raw(), s))
                  continue; // at the end of the surface, or hanging
                const unsigned int place = at - owned.begin(),
                                   among =
                                     place_in(at_owned[place].begin_raw(), s);
                const Point<3> unit[]   = {scalar.unit_support_point(node),
                                           scalar.unit_support_point(other)};
                const auto     position = [&, &c = cell](const Point<3> &p) {
                  return discretization.mapping.transform_unit_to_real_cell(c,
                                                                            p);
                };
                neighbours.push_back(
                  {s,
                   place,
                   among,
                   sets.get_partitioner()->global_to_local(3 * nodes[other]),
                   share * position(unit[0]).distance(position(unit[1])) /
                     unit[0].distance(unit[1])});
              }
          }
  }


  std::vector<double>
  BondTips::distances(InterfacePoints &points, const std::vector<bool> &set)
  {
    const auto &list = points.points;
    // the surfaces in the set at each node, and at the nodes of twins
    std::vector<Tensor<1, 3>> at_nodes(points.n_nodes()),
      at_owned(points.exchange().owned_nodes().size());
    for (unsigned int k = 0; k < list.size(); ++k)
      if (set[k] && has_tips(points, list[k].surface))
        insert(at_nodes[list[k].first], list[k].surface);
    for (const auto &[k, twin] : twins)
      if (set[k])
        insert(at_nodes[list[twin].first], list[twin].surface);
    points.exchange().to_owners(at_nodes, at_owned);
    sets                = 0.;
    const auto &numbers = points.exchange().owned_nodes();
    for (unsigned int i = 0; i < numbers.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        sets.local_element(3 * numbers[i] + d) = at_owned[i][d];
    sets.update_ghost_values();
    for (Tensor<1, 3> &value : at_owned)
      value = 0.;
    for (const Neighbour &neighbour : neighbours)
      if (contains(sets.begin() + neighbour.beside, neighbour.surface))
        {
          double &distance = at_owned[neighbour.node][neighbour.component];
          distance         = std::max(distance, neighbour.distance);
        }
    sets.zero_out_ghost_values();
    points.exchange().to_clusters(at_owned, at_nodes);

    std::vector<double> result(list.size());
    for (unsigned int k = 0; k < list.size(); ++k)
      if (has_tips(points, list[k].surface))
        result[k] = at_nodes[list[k].first][component[k]];
    std::vector<double> with_twins(result);
    for (const auto &[k, twin] : twins)
      with_twins[twin] = std::max(with_twins[twin], result[k]);
    return with_twins;
  }


  double
  BondTips::smallest_factor(const InterfacePoints &points) const
  {
    double smallest = 1.;
    for (unsigned int k = 0; k < points.points.size(); ++k)
      smallest =
        std::min(smallest,
                 points.surfaces[points.points[k].surface].law->tip_strength(
                   farthest[k], modulus[k]));
    return Utilities::MPI::min(smallest, points.communicator);
  }


  void
  BondTips::begin_earthquake()
  {
    in_earthquake = true;
  }


  double
  BondTips::strength_at_tip(const unsigned int     k,
                            const InterfacePoints &points) const
  {
    return points.surfaces[points.points[k].surface].law->tip_strength(
      tip[k], in_earthquake ? modulus[k] : modulus_at_rest[k]);
  }


  void
  BondTips::find_tips(const std::vector<bool> &cracked, InterfacePoints &points)
  {
    if (Utilities::MPI::max(cracked != last_cracked ? 1 : 0,
                            points.communicator) == 0)
      return;
    tip          = distances(points, cracked);
    last_cracked = cracked;
    for (const auto &[k, other] : continued)
      if (cracked[other] || !has_bond(points, other))
        tip[k] = std::max(tip[k], farthest[k]);
    for (unsigned int k = 0; k < cracked.size(); ++k)
      if (cracked[k])
        tip[k] = 0.;
  }


  void
  BondTips::update(const unsigned long long step, InterfacePoints &points)
  {
    if (step % steps_between_looks != 0)
      return;
    std::vector<bool> cracked;
    for (const ContactPoint &point : points.points)
      cracked.push_back(is_cracked(point));
    find_tips(cracked, points);
    for (unsigned int k = 0; k < cracked.size(); ++k)
      if (ContactPoint &point = points.points[k]; tip[k] > 0. && point.joined)
        {
          point.history.tip = 1.;
          points.update_limits(point);
          point.history.tip =
            strength_where_tip_arrives(strength_at_tip(k, points),
                                       point.used_bond());
          points.update_limits(point);
        }
  }


  bool
  BondTips::weaken(const std::vector<bool> &cracked, InterfacePoints &points)
  {
    find_tips(cracked, points);
    bool weaker = false;
    for (unsigned int k = 0; k < cracked.size(); ++k)
      if (ContactPoint &point = points.points[k]; tip[k] > 0. && point.joined)
        if (const double strength = strength_at_tip(k, points);
            strength < point.history.tip)
          {
            point.history.tip = strength;
            points.update_limits(point);
            weaker = true;
          }
    return Utilities::MPI::max(weaker ? 1 : 0, points.communicator) > 0;
  }
} // namespace Voussoir
