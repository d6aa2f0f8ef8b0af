#include <voussoir/base/error.h>
#include <voussoir/output/checkpoint.h>

#include <filesystem>
#include <fstream>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    std::string
    complete_slot(const std::string &folder)
    {
      std::ifstream pointer(folder + "/last_complete");
      std::string   slot;
      pointer >> slot;
      return folder + "/" + slot;
    }

    std::string
    rank_file(const std::string &slot, const unsigned int rank)
    {
      return slot + "/rank-" + std::to_string(rank) + ".bin";
    }
    nlohmann::json
    names_and_widths(const std::map<std::string, KeyedValues> &values)
    {
      nlohmann::json result = nlohmann::json::object();
      for (const auto &[name, group] : values)
        result[name] = group.width;
      return result;
    }
  } // namespace


  Checkpoint::Checkpoint(const Discretization &discretization,
                         const std::string    &folder)
    : discretization(discretization)
    , folder(folder)
    , keys(discretization.n_owned_nodes(),
           std::numeric_limits<std::uint64_t>::max())
  {
    // The smallest (cell, place in the cell) among the cells around a node:
    // all of them are owned or ghosts where the node is owned.
    for (const auto &cell : discretization.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const auto          nodes = discretization.cell_nodes(cell);
          const std::uint64_t first = Grid::global_key(cell) * 128;
          for (unsigned int j = 0; j < nodes.size(); ++j)
            if (discretization.owned_dofs.is_element(3 * nodes[j]))
              {
                auto &key = keys[discretization.owned_node(nodes[j])];
                key       = std::min(key, first + j);
              }
        }
    if (exists(folder) && complete_slot(folder) == folder + "/slot-1")
      next_slot = 2;
  }


  bool
  Checkpoint::exists(const std::string &folder)
  {
    return fs::exists(folder + "/last_complete");
  }


  nlohmann::json
  Checkpoint::read_header(const std::string &folder)
  {
    std::ifstream in(complete_slot(folder) + "/header.json");
    return nlohmann::json::parse(in);
  }


  void
  Checkpoint::write(const std::map<std::string, Vector *>    &vectors,
                    const std::map<std::string, KeyedValues> &values,
                    const nlohmann::json                     &header)
  {
    const MPI_Comm     communicator = discretization.grid.communicator();
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    const std::string  slot = "slot-" + std::to_string(next_slot);
    const std::string  path = folder + "/" + slot;
    if (rank == 0)
      fs::create_directories(path);
    MPI_Barrier(communicator);

    std::ofstream out(rank_file(path, rank), std::ios::binary);
    const auto    put = [&](const auto *data, const std::size_t n) {
      out.write(reinterpret_cast<const char *>(data), n * sizeof(*data));
    };
    const std::uint64_t n_nodes = keys.size();
    put(&n_nodes, 1);
    put(keys.data(), n_nodes);
    for (const auto &item : vectors)
      put(item.second->begin(), 3 * n_nodes);
    for (const auto &item : values)
      {
        const std::uint64_t n_items = item.second.items.size();
        put(&n_items, 1);
        for (const auto &[key, numbers] : item.second.items)
          {
            put(&key, 1);
            put(numbers, item.second.width);
          }
      }
    out.close();
    const bool good = Utilities::MPI::min(out.good() ? 1 : 0, communicator);
    if (rank == 0 && good)
      {
        nlohmann::json full = header;
        full["ranks"]       = Utilities::MPI::n_mpi_processes(communicator);
        for (const auto &item : vectors)
          full["vectors"].push_back(item.first);
        full["values"] = names_and_widths(values);
        std::ofstream text(path + "/header.json");
        text << full.dump(1) << std::endl;
        // only now is the slot complete
        if (text.good())
          std::ofstream(folder + "/last_complete") << slot << std::endl;
      }
    if (!good)
      throw UserError("The checkpoint \"" + path +
                      "\" could not be written; check the space left on the "
                      "disk.");
    MPI_Barrier(communicator);
    next_slot = 3 - next_slot;
  }


  void
  Checkpoint::read(const std::map<std::string, Vector *>    &vectors,
                   const std::map<std::string, KeyedValues> &values) const
  {
    const std::string        slot   = complete_slot(folder);
    const nlohmann::json     header = read_header(folder);
    std::vector<std::string> names;
    for (const auto &item : vectors)
      names.push_back(item.first);
    if (header.at("vectors").get<std::vector<std::string>>() != names ||
        header.at("values") != names_and_widths(values))
      throw UserError("The checkpoint \"" + slot +
                      "\" was written with other damping or other output "
                      "quantities; restart with the same parameters.");

    std::unordered_map<std::uint64_t, unsigned int> node_of_key;
    for (unsigned int node = 0; node < keys.size(); ++node)
      node_of_key[keys[node]] = node;
    // several places may share a number
    std::map<std::string, std::unordered_multimap<std::uint64_t, double *>>
      values_of_key;
    for (const auto &[name, group] : values)
      values_of_key[name].insert(group.items.begin(), group.items.end());
    std::size_t found = 0;
    for (unsigned int rank = 0; rank < header.at("ranks"); ++rank)
      {
        std::ifstream in(rank_file(slot, rank), std::ios::binary);
        const auto    get = [&](auto *data, const std::size_t n) {
          in.read(reinterpret_cast<char *>(data), n * sizeof(*data));
        };
        std::uint64_t n_nodes = 0;
        get(&n_nodes, 1);
        std::vector<std::uint64_t> their_keys(n_nodes);
        get(their_keys.data(), n_nodes);
        std::vector<double> numbers(3 * n_nodes);
        for (const auto &item : vectors)
          {
            get(numbers.data(), numbers.size());
            for (std::size_t i = 0; i < n_nodes; ++i)
              {
                const auto mine = node_of_key.find(their_keys[i]);
                if (mine != node_of_key.end())
                  for (unsigned int d = 0; d < 3; ++d)
                    item.second->local_element(3 * mine->second + d) =
                      numbers[3 * i + d];
              }
          }
        for (const auto &[name, group] : values)
          {
            std::uint64_t n_items = 0;
            get(&n_items, 1);
            numbers.resize(group.width);
            for (std::uint64_t i = 0; i < n_items && in; ++i)
              {
                std::uint64_t key = 0;
                get(&key, 1);
                get(numbers.data(), group.width);
                const auto range = values_of_key.at(name).equal_range(key);
                for (auto mine = range.first; mine != range.second; ++mine)
                  std::copy(numbers.begin(), numbers.end(), mine->second);
              }
          }
        for (const std::uint64_t key : their_keys)
          found += node_of_key.count(key);
        if (!in)
          throw UserError("The checkpoint file \"" + rank_file(slot, rank) +
                          "\" is incomplete; start the case afresh.");
      }
    if (found != keys.size())
      throw UserError("The checkpoint \"" + slot +
                      "\" belongs to another mesh; restart with the mesh, "
                      "degree and refinement of the run that wrote it.");
  }
} // namespace Voussoir
