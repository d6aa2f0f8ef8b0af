#include <voussoir/base/mpi.h>
#include <voussoir/output/crack_paths.h>

#include <boost/pending/disjoint_sets.hpp>

#include <numeric>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int no_number = numbers::invalid_unsigned_int;

    // marks for edges that no other rank has, and for the two faces
    constexpr std::array<int, 3> nowhere{{0, 0, 0}},
      faces[2]{{{1, 0, 0}}, {{2, 0, 0}}};


    /** Direction of the edge of a cell that begins in a corner, along an axis.
     */
    std::array<int, 3>
    direction_at(const Discretization::Cell &cell,
                 const unsigned int          corner,
                 const unsigned int          axis)
    {
      const Tensor<1, 3> edge =
        cell->vertex(corner ^ (1 << axis)) - cell->vertex(corner);
      std::array<int, 3> direction;
      for (unsigned int d = 0; d < 3; ++d)
        direction[d] = std::lround(1e3 * edge[d] / edge.norm());
      return direction;
    }
  } // namespace


  CrackPaths::CrackPaths(
    const Discretization                             &discretization,
    const std::vector<std::array<std::bitset<8>, 2>> &touching)
    : discretization(discretization)
    , touching(touching)
    , is_shared(discretization.grid.triangulation().n_vertices(), false)
    , number_of_cell(touching.size(), no_number)
  {
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (cell->is_ghost())
        for (const unsigned int v : cell->vertex_indices())
          is_shared[cell->vertex_index(v)] = true;
  }


  unsigned int
  CrackPaths::number_of(const Cell &cell)
  {
    const unsigned int own    = discretization.grid.owned_cell(cell);
    unsigned int      &number = number_of_cell[own];
    if (number != no_number)
      return number;
    number           = cells.size();
    const auto nodes = discretization.cell_nodes(cell);
    cells.emplace_back();
    cells.back().touching = touching[own];
    for (unsigned int corner = 0; corner < 8; ++corner)
      {
        cells.back().corners[corner] = cell->vertex(corner);
        for (unsigned int k = 0; k < 3; ++k)
          {
            // vertices come first among the nodes
            const Edge edge{nodes[corner], direction_at(cell, corner, k)};
            const auto [known, is_first] =
              number_of_edge.emplace(edge, shared_edges.size());
            cells.back().edges[corner][k] = known->second;
            if (is_first)
              shared_edges.push_back(
                is_shared[cell->vertex_index(corner)] ?
                  edge :
                  Edge{numbers::invalid_dof_index, nowhere});
          }
      }
    return number;
  }


  unsigned int
  CrackPaths::n_eighths() const
  {
    return 8 * cells.size();
  }


  std::vector<CrackPaths::Joint>
  CrackPaths::own_joints(const std::vector<double> &openings,
                         const double               least) const
  {
    std::vector<unsigned int> order;
    for (unsigned int i = 0; i < n_eighths(); ++i)
      if (openings[i] > least)
        order.push_back(i);
    const auto is_wider = [&](const unsigned int a, const unsigned int b) {
      return openings[a] > openings[b];
    };
    if (!std::is_sorted(order.begin(), order.end(), is_wider))
      std::stable_sort(order.begin(), order.end(), is_wider);

    // eighths, edges and the two faces; of each connected group, one member
    // that other ranks have
    const unsigned int first_edge = n_eighths(),
                       first_face = first_edge + shared_edges.size();
    std::vector<Edge> known_outside(first_edge,
                                    {numbers::invalid_dof_index, nowhere});
    known_outside.insert(known_outside.end(),
                         shared_edges.begin(),
                         shared_edges.end());
    for (const auto &face : faces)
      known_outside.push_back({numbers::invalid_dof_index, face});

    std::vector<Joint>                  joints;
    boost::disjoint_sets_with_storage<> chains(known_outside.size());
    const auto join = [&](const unsigned int eighth, const unsigned int other) {
      const auto a = chains.find_set(eighth), b = chains.find_set(other);
      if (a == b)
        return;
      const Edge of_a = known_outside[a], of_b = known_outside[b];
      const bool has_a = of_a.direction != nowhere,
                 has_b = of_b.direction != nowhere;
      if (has_a && has_b)
        {
          const Point<3> &where = cells[eighth / 8].corners[eighth % 8];
          joints.push_back({openings[eighth],
                            {{where[0], where[1], where[2]}},
                            {{of_a, of_b}}});
        }
      chains.link(a, b);
      known_outside[chains.find_set(a)] = has_a ? of_a : of_b;
    };
    std::vector<std::bitset<8>> joined(cells.size());
    for (const unsigned int i : order)
      {
        const CrackedCell &cell   = cells[i / 8];
        const unsigned int corner = i % 8;
        for (const unsigned int edge : cell.edges[corner])
          join(i, first_edge + edge);
        for (unsigned int other = 0; other < 8; ++other)
          if (joined[i / 8][other] && (other ^ corner) != 7)
            join(i, i - corner + other);
        joined[i / 8][corner] = true;
        for (const unsigned int face : {0, 1})
          if (cell.touching[face][corner])
            join(i, first_face + face);
        if (chains.find_set(first_face) == chains.find_set(first_face + 1))
          break; // the next eighths are narrower
      }
    return joints;
  }


  CrackPath
  CrackPaths::widest(const std::vector<double> &openings,
                     const double               least) const
  {
    const MPI_Comm communicator = discretization.grid.communicator();

    // no path is wider than the widest crack at either face
    std::vector<double> at_faces(2, 0.);
    for (unsigned int i = 0; i < n_eighths(); ++i)
      for (const unsigned int face : {0, 1})
        if (cells[i / 8].touching[face][i % 8])
          at_faces[face] = std::max(at_faces[face], openings[i]);
    Utilities::MPI::max(at_faces, communicator, at_faces);
    if (std::min(at_faces[0], at_faces[1]) <= least)
      return {};

    auto joints = join_over_ranks(own_joints(openings, least), communicator);
    std::stable_sort(joints.begin(),
                     joints.end(),
                     [](const Joint &a, const Joint &b) {
                       return a.opening > b.opening;
                     });
    std::map<Edge, unsigned int> number;
    for (const auto &face : faces)
      number.emplace(Edge{numbers::invalid_dof_index, face}, number.size());
    for (const Joint &joint : joints)
      for (const Edge &end : joint.ends)
        number.emplace(end, number.size());
    boost::disjoint_sets_with_storage<> chains(number.size());
    for (const Joint &joint : joints)
      {
        chains.union_set(number[joint.ends[0]], number[joint.ends[1]]);
        if (chains.find_set(0) == chains.find_set(1))
          return {joint.opening,
                  Point<3>(joint.where[0], joint.where[1], joint.where[2])};
      }
    return {};
  }
} // namespace Voussoir
