#include <voussoir/base/error.h>
#include <voussoir/output/face_mesh.h>

#include <deal.II/fe/fe_tools.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Patches of a surface for deal.II's writers. */
    class SurfaceOutput : public DataOutInterface<2, 3>
    {
    public:
      SurfaceOutput(std::vector<DataOutBase::Patch<2, 3>> &&patches,
                    const std::vector<std::string>         &names)
        : patches(std::move(patches))
        , names(names)
      {}

    private:
      const std::vector<DataOutBase::Patch<2, 3>> &
      get_patches() const override
      {
        return patches;
      }

      std::vector<std::string>
      get_dataset_names() const override
      {
        return names;
      }

      const std::vector<DataOutBase::Patch<2, 3>> patches;
      const std::vector<std::string>              names;
    };
  } // namespace


  FaceMesh::FaceMesh(const Discretization           &discretization,
                     const std::vector<std::string> &sets,
                     const std::string              &place,
                     const std::string              &kind,
                     const std::vector<std::string> &all_names)
    : discretization(discretization)
    , kind(kind)
    , all_names(all_names)
  {
    if (sets.empty())
      throw UserError(place + " is empty; name faces.");
    Places places;
    for (unsigned int s = 0; s < sets.size(); ++s)
      {
        discretization.grid.check_face_set(sets[s], place);
        number_of_set.push_back(number_of(sets[s], all_names));
        discretization.grid.for_each_face(
          sets[s], [&](const auto &cell, const unsigned int face) {
            add_face(s, discretization.dof_cell(cell), face, places);
          });
      }
    set_and_node.resize(places.nodes.size());
    for (const auto &[key, node] : places.nodes)
      set_and_node[node] = key;
    number_nodes(places.nodes, sets.size());
    find_normals(places.normals);
  }


  void
  FaceMesh::add_face(const unsigned int          set,
                     const Discretization::Cell &cell,
                     const unsigned int          face,
                     Places                     &places)
  {
    const auto        &scalar   = discretization.fe.base_element(0);
    const unsigned int per_edge = discretization.degree + 1;
    const unsigned int across   = face / 2;
    const auto         hierarchic =
      FETools::lexicographic_to_hierarchic_numbering<3>(discretization.degree);
    const auto cell_nodes = discretization.cell_nodes(cell);

    set_of_face.push_back(set);
    for (unsigned int i = 0; i < per_edge * per_edge; ++i)
      {
        // the two directions along the face, the lower one faster
        std::array<unsigned int, 3> at;
        at[across]              = face % 2 * discretization.degree;
        at[across == 0 ? 1 : 0] = i % per_edge;
        at[across == 2 ? 1 : 2] = i / per_edge;
        const unsigned int j =
          hierarchic[at[0] + per_edge * (at[1] + per_edge * at[2])];

        const auto [item, is_new] =
          places.nodes.emplace(SetAndNode(set, cell_nodes[j]),
                               places.nodes.size());
        const Point<3> unit = scalar.unit_support_point(j);
        if (is_new)
          {
            positions.push_back(
              discretization.mapping.transform_unit_to_real_cell(cell, unit));
            places.normals.resize(4 * places.nodes.size(), 0.);
          }
        all_places.push_back({cell, unit});
        node_of_place.push_back(item->second);
        place_keys.push_back(
          {set, Grid::global_key(cell) * 128 + j, item->second});

        Tensor<1, 3> outward =
          inverse_jacobian(cell, unit)[across] * (face % 2 * 2. - 1.);
        outward /= outward.norm();
        double *sums = &places.normals[4 * item->second];
        sums[0] += 1.;
        for (unsigned int d = 0; d < 3; ++d)
          sums[1 + d] += outward[d];
      }
  }


  void
  FaceMesh::find_normals(const std::vector<double> &normals_of_nodes)
  {
    Vector sums = make_vector(4);
    sum_over_holders(sums, 4, normals_of_nodes);
    for (const unsigned int node_entry : entries)
      {
        const unsigned int entry = 4 * node_entry;
        n_places_of_node.push_back(std::lround(sums.local_element(entry)));
        normals.push_back(Tensor<1, 3>({sums.local_element(entry + 1),
                                        sums.local_element(entry + 2),
                                        sums.local_element(entry + 3)}));
        normals.back() /= normals.back().norm();
      }
  }


  void
  FaceMesh::number_nodes(const NodeNumbers &nodes, const unsigned int n_sets)
  {
    // the owner of a node numbers the node in each of its sets
    std::vector<std::pair<types::global_dof_index, unsigned int>> records;
    for (const auto &item : nodes)
      records.emplace_back(item.first.second, item.first.first);
    std::set<std::pair<unsigned int, unsigned int>> owned; // set and node
    for (const auto &[node, set] : discretization.send_to_owners(records))
      owned.insert({set, node});
    n_owned     = owned.size();
    n_numbers   = 0;
    first_owned = 0;
    const auto counts =
      Utilities::MPI::all_gather(discretization.grid.communicator(), n_owned);
    for (unsigned int rank = 0; rank < counts.size(); ++rank)
      {
        if (rank < Utilities::MPI::this_mpi_process(
                     discretization.grid.communicator()))
          first_owned += counts[rank];
        n_numbers += counts[rank];
      }

    numbers.resize(nodes.size());
    Vector known(discretization.owned_dofs,
                 discretization.relevant_dofs,
                 discretization.grid.communicator());
    auto   next = first_owned;
    for (unsigned int set = 0; set < n_sets; ++set)
      {
        known.zero_out_ghost_values();
        for (const auto &item : owned)
          if (item.first == set)
            known.local_element(3 * item.second) = next++;
        known.update_ghost_values();
        for (const auto &[key, node] : nodes)
          if (key.first == set)
            numbers[node] = std::llround(known(3 * key.second));
      }
    const Vector one_each = make_vector(1);
    for (const auto number : numbers)
      entries.push_back(one_each.get_partitioner()->global_to_local(number));
  }


  Vector
  FaceMesh::make_vector(const unsigned int width) const
  {
    IndexSet owned(width * n_numbers), relevant(width * n_numbers);
    owned.add_range(width * first_owned, width * (first_owned + n_owned));
    for (const auto number : numbers)
      relevant.add_range(width * number, width * (number + 1));
    return Vector(owned, relevant, communicator());
  }


  void
  FaceMesh::sum_over_holders(Vector                    &sums,
                             const unsigned int         width,
                             const std::vector<double> &values) const
  {
    sums.zero_out_ghost_values();
    sums = 0.;
    for (unsigned int node = 0; node < entries.size(); ++node)
      std::copy_n(&values[width * node],
                  width,
                  sums.begin() + width * entries[node]);
    sums.compress(VectorOperation::add);
    sums.update_ghost_values();
  }


  MPI_Comm
  FaceMesh::communicator() const
  {
    return discretization.grid.communicator();
  }


  unsigned int
  FaceMesh::n_nodes() const
  {
    return numbers.size();
  }


  const Point<3> &
  FaceMesh::position(const unsigned int node) const
  {
    return positions[node];
  }


  bool
  FaceMesh::is_level() const
  {
    const bool level =
      std::any_of(normals.begin(), normals.end(), [](const auto &normal) {
        return std::abs(normal[2]) > 1. - 1e-6;
      });
    return Utilities::MPI::logical_or(level, communicator());
  }


  void
  FaceMesh::check_not_level(const std::string &place) const
  {
    if (is_level())
      throw UserError(place +
                      " names faces that are level somewhere, where arch and "
                      "cantilever have no direction; name the upstream and "
                      "downstream faces of the dam.");
  }


  std::array<Tensor<1, 3>, 2>
  FaceMesh::arch_and_cantilever(const unsigned int node) const
  {
    const Tensor<1, 3> &n = normals[node];
    Tensor<1, 3>        arch({-n[1], n[0], 0.}); // z x n
    arch /= arch.norm();
    return {{arch, cross_product_3d(n, arch)}};
  }


  std::vector<FaceMesh::Quadrilateral>
  FaceMesh::quadrilaterals() const
  {
    const unsigned int         per_edge = discretization.degree + 1;
    std::vector<Quadrilateral> result;
    for (unsigned int f = 0; f < set_of_face.size(); ++f)
      for (unsigned int j = 0; j + 1 < per_edge; ++j)
        for (unsigned int i = 0; i + 1 < per_edge; ++i)
          {
            const unsigned int *corner =
              &node_of_place[(f * per_edge + j) * per_edge + i];
            result.push_back({set_of_face[f],
                              {{corner[0],
                                corner[1],
                                corner[per_edge],
                                corner[per_edge + 1]}}});
          }
    return result;
  }


  std::map<std::string, KeyedValues>
  FaceMesh::keyed_values(std::vector<double> &values,
                         const unsigned int   width,
                         const std::string   &what) const
  {
    std::map<std::string, KeyedValues> result;
    for (const unsigned int number : number_of_set)
      result[all_names[number] + what].width = width;
    for (const auto &[set, key, node] : place_keys)
      result[all_names[number_of_set[set]] + what].items.emplace_back(
        key, &values[width * node]);
    return result;
  }


  const std::vector<FaceMesh::SetAndNode> &
  FaceMesh::sets_and_nodes() const
  {
    return set_and_node;
  }


  const std::vector<StressPoints::Place> &
  FaceMesh::places() const
  {
    return all_places;
  }


  const std::vector<unsigned int> &
  FaceMesh::nodes_of_places() const
  {
    return node_of_place;
  }


  void
  FaceMesh::mean_over_places(Vector              &work,
                             const unsigned int   width,
                             std::vector<double> &values) const
  {
    sum_over_holders(work, width, values);
    for (unsigned int node = 0; node < entries.size(); ++node)
      {
        const double *sum   = work.begin() + width * entries[node];
        const double  share = 1. / n_places_of_node[node];
        for (unsigned int c = 0; c < width; ++c)
          values[width * node + c] = share * sum[c];
      }
  }


  FaceStress::FaceStress(const StressModel &model, const FaceMesh &mesh)
    : mesh(mesh)
    , points(model, mesh.places(), mesh.nodes_of_places(), mesh.n_nodes())
    , sums(mesh.make_vector(6))
    , means(mesh.n_nodes())
  {}


  const std::vector<SymmetricTensor<2, 3>> &
  FaceStress::evaluate(const State &state)
  {
    const auto &parts = points.evaluate(state);
    components.resize(6 * parts.size());
    for (unsigned int node = 0; node < parts.size(); ++node)
      for (unsigned int c = 0; c < 6; ++c)
        components[6 * node + c] = parts[node].access_raw_entry(c);
    mesh.mean_over_places(sums, 6, components);
    for (unsigned int node = 0; node < means.size(); ++node)
      for (unsigned int c = 0; c < 6; ++c)
        means[node].access_raw_entry(c) = components[6 * node + c];
    return means;
  }


  std::string
  FaceMesh::write(const ObservedRun              &run,
                  const std::vector<std::string> &fields,
                  const std::vector<double>      &values,
                  const std::string              &name,
                  const double                    time,
                  const std::vector<VtuText>     &texts) const
  {
    const unsigned int per_edge = discretization.degree + 1;
    const unsigned int per_face = per_edge * per_edge;
    const unsigned int width    = fields.size();

    std::vector<DataOutBase::Patch<2, 3>> patches(set_of_face.size());
    for (unsigned int f = 0; f < patches.size(); ++f)
      {
        auto &patch                = patches[f];
        patch.reference_cell       = ReferenceCells::Quadrilateral;
        patch.patch_index          = f;
        patch.n_subdivisions       = discretization.degree;
        patch.points_are_available = true;
        patch.data.reinit(width + 1 + 3, per_face);
        for (unsigned int i = 0; i < per_face; ++i)
          {
            const unsigned int node = node_of_place[per_face * f + i];
            for (unsigned int c = 0; c < width; ++c)
              patch.data(c, i) = values[width * node + c];
            patch.data(width, i) = number_of_set[set_of_face[f]];
            for (unsigned int d = 0; d < 3; ++d)
              patch.data(width + 1 + d, i) = positions[node][d];
          }
        const std::array<unsigned int, 4> corners{
          {0, per_edge - 1, per_face - per_edge, per_face - 1}};
        for (unsigned int v = 0; v < 4; ++v)
          patch.vertices[v] =
            positions[node_of_place[per_face * f + corners[v]]];
      }
    std::vector<std::string> all_fields = fields;
    all_fields.push_back(kind);
    std::vector<VtuText> all_texts = texts;
    all_texts.push_back({kind + "_names", all_names});
    SurfaceOutput     output(std::move(patches), all_fields);
    const std::string file = name + ".vtu";
    return write_vtu(
             output, run.folder + "/" + file, time, all_texts, run.log) ?
             file :
             "";
  }
} // namespace Voussoir
