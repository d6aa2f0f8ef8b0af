#include <voussoir/base/error.h>
#include <voussoir/constraints/contact_clusters.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/mesh/interfaces.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Points nearer than this part of the smallest cell on an interface are
    // taken to coincide: ranks compute them to round-off only.
    constexpr double coincidence = 1e-6;

    // Cell, by Grid::global_key, and number of the node in it: names a node
    // without reference to ranks.
    using NodeKey = std::pair<std::uint64_t, unsigned int>;

    /** A node of a face on an interface, on the side of the face's cell. */
    struct Record
    {
      Point<3>                position, face_center;
      Tensor<1, 3>            area; // share of the face, outwards [m2]
      NodeKey                 key;
      types::global_dof_index node;
      unsigned int            interface, side, face;
      bool                    hanging;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &position &face_center &area &key.first &key
          .second &node &interface &side                &hanging;
      }
    };

    bool
    before(const Record *a, const Record *b)
    {
      return std::tie(a->key, a->interface, a->side, a->face) <
             std::tie(b->key, b->interface, b->side, b->face);
    }


    /** A cluster with the key of its first node. */
    struct KeyedCluster
    {
      NodeKey        key;
      ContactCluster cluster;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &key.first &key.second &cluster;
      }
    };


    /** Cuts space into cubes, so that near points are found in the same one. */
    class Cubes
    {
    public:
      using Cube = std::array<std::int64_t, 3>;

      explicit Cubes(const double size)
        : size(size)
      {}

      Cube
      at(const Point<3> &p) const
      {
        Cube cube;
        for (unsigned int d = 0; d < 3; ++d)
          cube[d] = static_cast<std::int64_t>(std::floor(p[d] / size));
        return cube;
      }

      /** Cubes that a point may fall into with any round-off. */
      std::set<Cube>
      near(const Point<3> &p, const double tolerance) const
      {
        std::set<Cube> result;
        for (unsigned int corner = 0; corner < 8; ++corner)
          result.insert(
            at(p + tolerance * (2. * GeometryInfo<3>::unit_cell_vertex(corner) -
                                Point<3>(1, 1, 1))));
        return result;
      }

      static unsigned int
      rank(const Cube &cube, const unsigned int n_ranks)
      {
        std::uint64_t hash = 0;
        for (const std::int64_t i : cube)
          {
            hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 32;
          }
        return hash % n_ranks;
      }

    private:
      const double size;
    };


    /** A node by one of its cells on a side of an interface. */
    struct KeyedNode
    {
      NodeKey  key;
      Point<3> position;
    };


    /** The nodes of the faces of a set, those of neighbouring cells, too. */
    std::map<types::global_dof_index, KeyedNode>
    nodes_of_faces(const Discretization &discretization,
                   FaceNodes            &face_nodes,
                   const std::string    &set)
    {
      std::map<types::global_dof_index, KeyedNode> result;
      for (const auto &[cell, face] : discretization.grid.faces(set))
        {
          const auto nodes =
            discretization.cell_nodes(discretization.dof_cell(cell));
          for (const FaceNode &node : face_nodes.of(cell, face))
            {
              const KeyedNode found{{Grid::global_key(cell), node.number},
                                    node.position};
              const auto [known, is_new] =
                result.emplace(nodes[node.number], found);
              if (!is_new && found.key < known->second.key)
                known->second = found;
            }
        }
      return result;
    }


    std::vector<Record>
    records_of_owned_faces(const Discretization           &discretization,
                           const std::vector<std::string> &interfaces)
    {
      FaceNodes           face_nodes(discretization.mapping,
                           discretization.fe.base_element(0));
      std::vector<Record> records;
      for (unsigned int i = 0; i < interfaces.size(); ++i)
        for (const unsigned int side : {0, 1})
          {
            const std::string set =
              interfaces[i] + (side == 0 ? "" : other_side);
            const auto known = nodes_of_faces(discretization, face_nodes, set);
            discretization.grid.for_each_face(
              set, [&](const auto &cell, const unsigned int face) {
                const auto nodes =
                  discretization.cell_nodes(discretization.dof_cell(cell));
                for (const FaceNode &node : face_nodes.of(cell, face))
                  {
                    Record     record{node.position,
                                  cell->face(face)->center(),
                                  node.area * node.normal,
                                  {Grid::global_key(cell), node.number},
                                  nodes[node.number],
                                  i,
                                  side,
                                  face,
                                  false};
                    const auto carriers = discretization.carriers(record.node);
                    record.hanging =
                      carriers.size() > 1 &&
                      (discretization.degree > 1 ||
                       std::any_of(carriers.begin(),
                                   carriers.end(),
                                   [&](const auto &carrier) {
                                     return known.count(carrier.node) == 0;
                                   }));
                    if (carriers.size() == 1 || record.hanging)
                      {
                        records.push_back(record);
                        continue;
                      }
                    // its gap is the mean of those of its carriers, which take
                    // its area
                    for (const auto &[carrier, weight] : carriers)
                      {
                        record.node     = carrier;
                        record.key      = known.at(carrier).key;
                        record.position = known.at(carrier).position;
                        record.area     = weight * node.area * node.normal;
                        records.push_back(record);
                      }
                  }
              });
          }
      return records;
    }


    double
    smallest_cell(const Grid &grid, const std::vector<std::string> &interfaces)
    {
      double size = std::numeric_limits<double>::max();
      for (const std::string &interface : interfaces)
        for (const std::string &name : {interface, interface + other_side})
          grid.for_each_face(name, [&](const auto &cell, const unsigned int) {
            size = std::min(size, cell->minimum_vertex_distance());
          });
      return Utilities::MPI::min(size, grid.communicator());
    }


    /** Error of this rank; all ranks throw the same error. */
    class Problems
    {
    public:
      void
      add(const Record &record, const std::vector<std::string> &interfaces)
      {
        std::ostringstream text;
        text << "The interface \"" << interfaces[record.interface]
             << "\" has cells of different size next to the point ("
             << record.position[0] << ", " << record.position[1] << ", "
             << record.position[2]
             << ") m, so that not every node has a partner on the other side; "
                "refine all cells at it equally by \"Local refinement\" in "
                "section \"Mesh\", or none, or set \"Degree = 1\" in section "
                "\"Discretization\".";
        const auto problem = std::make_pair(record.key, text.str());
        if (first.second.empty() || problem < first)
          first = problem;
      }

      void
      throw_on_all(const MPI_Comm communicator) const
      {
        if (Utilities::MPI::max(first.second.empty() ? 0 : 1, communicator) ==
            0)
          return;
        auto problems = Utilities::MPI::all_gather(communicator, first);
        std::sort(problems.begin(), problems.end());
        for (const auto &problem : problems)
          if (!problem.second.empty())
            throw UserError(problem.second);
      }

    private:
      std::pair<NodeKey, std::string> first;
    };


    // The cluster of the records of one point, which are sorted. It is empty
    // where all these nodes are at the end of an interface.
    KeyedCluster
    make_cluster(const std::vector<const Record *> &records,
                 const double                       tolerance,
                 const std::vector<std::string>    &interfaces,
                 Problems                          &problems)
    {
      // the lowest key of each node
      std::map<types::global_dof_index, NodeKey> key_of_node;
      for (const Record *record : records)
        key_of_node.insert({record->node, record->key});

      // the nodes that each face connects, and their areas
      std::map<std::tuple<unsigned int, NodeKey, NodeKey>,
               std::vector<Tensor<1, 3>>>
                                                 areas;
      std::map<NodeKey, types::global_dof_index> nodes;
      for (const Record *record : records)
        {
          const auto partner =
            std::find_if(records.begin(), records.end(), [&](const Record *r) {
              return r->interface == record->interface &&
                     r->side != record->side &&
                     r->face_center.distance(record->face_center) < tolerance;
            });
          if (partner == records.end())
            problems.add(*record, interfaces);
          else if (record->node == (*partner)->node)
            continue; // at the end of an interface a node may hang
          else if (record->hanging)
            problems.add(*record, interfaces);
          else if (record->side == 0)
            {
              const NodeKey first  = key_of_node[record->node],
                            second = key_of_node[(*partner)->node];
              nodes[first]         = record->node;
              nodes[second]        = (*partner)->node;
              areas[{record->interface, first, second}].push_back(record->area);
            }
        }

      KeyedCluster result;
      if (nodes.empty())
        return result;
      result.key              = nodes.begin()->first;
      ContactCluster &cluster = result.cluster;
      cluster.key             = 128 * result.key.first + result.key.second;
      cluster.position        = (*std::find_if(records.begin(),
                                        records.end(),
                                        [&](const Record *record) {
                                          return record->key == result.key;
                                        }))
                           ->position;
      std::map<NodeKey, unsigned int> number;
      for (const auto &[key, node] : nodes)
        {
          number[key] = cluster.nodes.size();
          cluster.nodes.push_back(node);
        }
      for (auto &[connection, shares] : areas)
        {
          // in an order that does not depend on ranks
          std::sort(shares.begin(),
                    shares.end(),
                    [](const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
                      return std::tie(a[0], a[1], a[2]) <
                             std::tie(b[0], b[1], b[2]);
                    });
          ContactPair pair{std::get<0>(connection),
                           number[std::get<1>(connection)],
                           number[std::get<2>(connection)],
                           Tensor<1, 3>(),
                           0.};
          for (const Tensor<1, 3> &share : shares)
            {
              pair.normal += share;
              pair.area += share.norm();
            }
          pair.normal /= pair.normal.norm();
          cluster.pairs.push_back(pair);
        }
      return result;
    }
  } // namespace


  std::vector<ContactCluster>
  find_contact_clusters(const Discretization           &discretization,
                        const std::vector<std::string> &interfaces)
  {
    const Grid    &grid         = discretization.grid;
    const MPI_Comm communicator = grid.communicator();
    const auto     n_ranks      = Utilities::MPI::n_mpi_processes(communicator);
    const auto     my_rank = Utilities::MPI::this_mpi_process(communicator);
    for (const std::string &name : interfaces)
      for (const std::string &side : {name, name + other_side})
        grid.check_face_set(side, "The interface \"" + name + "\"");

    // All records of one point meet on the rank of its cube. A point that may
    // fall into several cubes is sent to all of them, and only the cube of the
    // lowest record's position makes the cluster.
    const double size      = smallest_cell(grid, interfaces);
    const double tolerance = coincidence * size;
    const Cubes  cubes(size / discretization.degree);
    std::map<unsigned int, std::vector<Record>> outgoing;
    for (const Record &record :
         records_of_owned_faces(discretization, interfaces))
      {
        std::set<unsigned int> ranks;
        for (const auto &cube : cubes.near(record.position, tolerance))
          ranks.insert(Cubes::rank(cube, n_ranks));
        for (const unsigned int rank : ranks)
          outgoing[rank].push_back(record);
      }
    const auto incoming = Utilities::MPI::some_to_some(communicator, outgoing);
    std::map<Cubes::Cube, std::vector<const Record *>> records_in_cube;
    for (const auto &message : incoming)
      for (const Record &record : message.second)
        for (const auto &cube : cubes.near(record.position, tolerance))
          if (Cubes::rank(cube, n_ranks) == my_rank)
            records_in_cube[cube].push_back(&record);

    Problems                                          problems;
    std::map<unsigned int, std::vector<KeyedCluster>> clusters;
    for (auto &[cube, records] : records_in_cube)
      while (!records.empty())
        {
          const Point<3> position = records.front()->position;
          const auto     others   = std::stable_partition(
            records.begin(), records.end(), [&](const Record *record) {
              return record->position.distance(position) < tolerance;
            });
          std::vector<const Record *> here(records.begin(), others);
          records.erase(records.begin(), others);
          std::sort(here.begin(), here.end(), before);
          if (cubes.at(here.front()->position) != cube)
            continue;
          const KeyedCluster cluster =
            make_cluster(here, tolerance, interfaces, problems);
          if (!cluster.cluster.nodes.empty())
            clusters[discretization.owner(cluster.cluster.nodes.front())]
              .push_back(cluster);
        }
    problems.throw_on_all(communicator);

    std::vector<KeyedCluster> mine;
    for (const auto &message :
         Utilities::MPI::some_to_some(communicator, clusters))
      mine.insert(mine.end(), message.second.begin(), message.second.end());
    std::sort(mine.begin(),
              mine.end(),
              [](const KeyedCluster &a, const KeyedCluster &b) {
                return a.key < b.key;
              });
    std::vector<ContactCluster> result;
    for (KeyedCluster &cluster : mine)
      result.push_back(std::move(cluster.cluster));
    return result;
  }
} // namespace Voussoir
