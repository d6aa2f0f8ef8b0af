#include <voussoir/output/checkpoint.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <limits>

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    constexpr char beginning[] = "step-", ending[] = ".h5";


    std::string
    file_name(const unsigned long long step)
    {
      // the names sort in the order of the numbers
      std::ostringstream name;
      name << beginning << std::setw(12) << std::setfill('0') << step << ending;
      return name.str();
    }


    bool
    is_checkpoint(const fs::path &file)
    {
      return file.extension() == ending &&
             file.filename().string().rfind(beginning, 0) == 0;
    }
  } // namespace


  Checkpoint::Checkpoint(const std::string &folder, const MPI_Comm communicator)
    : folder(folder)
    , communicator(communicator)
  {}


  std::vector<std::string>
  Checkpoint::files() const
  {
    std::vector<std::string> result;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code none;
        for (const auto &entry : fs::directory_iterator(folder, none))
          if (is_checkpoint(entry.path()))
            result.push_back(entry.path());
        std::sort(result.rbegin(), result.rend());
      }
    return Utilities::MPI::broadcast(communicator, result);
  }


  void
  Checkpoint::write(const unsigned long long step,
                    const nlohmann::json    &header,
                    const StateContent      &content) const
  {
    write_state(folder + "/" + file_name(step), header, content, communicator);
    // the checkpoint before stays; newer ones are damaged, as the run continues
    // from the newest whole one
    const std::string written = folder + "/" + file_name(step);
    const auto        all     = files();
    const auto        place   = std::find(all.begin(), all.end(), written);
    std::error_code   ignored;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      for (auto file = all.begin(); file != all.end(); ++file)
        if (file < place || file > place + 1)
          fs::remove(*file, ignored);
  }


  std::string
  Checkpoint::newest(std::vector<std::string> &damaged) const
  {
    for (const std::string &file : files())
      {
        const std::string damage = damage_of_state(file, communicator);
        if (damage.empty())
          return file;
        damaged.push_back("\"" + file + "\": " + damage);
      }
    return "";
  }


  // The key of a node is the smallest (cell, place in the cell) among its
  // cells; the cells around an owned node are owned or ghosts.
  NodalKeys::NodalKeys(const Discretization &discretization)
    : keys(discretization.n_owned_nodes(),
           std::numeric_limits<std::uint64_t>::max())
  {
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
  }


  KeyedValues
  NodalKeys::values(Vector &vector) const
  {
    KeyedValues result{3, {}};
    result.items.reserve(keys.size());
    for (unsigned int node = 0; node < keys.size(); ++node)
      result.items.emplace_back(keys[node], vector.begin() + 3 * node);
    return result;
  }
} // namespace Voussoir
