#include <voussoir/base/mpi.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/output/names.h>

#include <algorithm>
#include <cstring>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Sorts names with numbers by value: "block 2" comes before "block 10". */
    std::vector<std::string>
    sorted(std::vector<std::string> names)
    {
      std::sort(names.begin(),
                names.end(),
                [](const std::string &a, const std::string &b) {
                  return strverscmp(a.c_str(), b.c_str()) < 0;
                });
      return names;
    }
  } // namespace


  ResultNames::ResultNames(const std::vector<std::string> &material_names,
                           const Grid                     &grid,
                           const Contact                  *contact)
    : materials(material_names)
    , cell_sets(sorted(grid.cell_set_names()))
    , face_sets(sorted(grid.face_set_names()))
    , interfaces(contact != nullptr ? contact->surface_names() :
                                      std::vector<std::string>())
  {}


  const std::vector<std::string> &
  ResultNames::interface_states()
  {
    static const std::vector<std::string> states{"closed", "sliding", "open"};
    return states;
  }


  nlohmann::json
  ResultNames::json() const
  {
    nlohmann::json result{{"materials", materials},
                          {"cell sets", cell_sets},
                          {"face sets", face_sets}};
    if (!interfaces.empty())
      {
        result["interfaces"]       = interfaces;
        result["interface states"] = interface_states();
      }
    return result;
  }


  unsigned int
  number_of(const std::string &name, const std::vector<std::string> &names)
  {
    const auto found = std::find(names.begin(), names.end(), name);
    AssertThrow(found != names.end(), ExcInternalError());
    return found - names.begin();
  }


  dealii::Vector<float>
  smallest_cell_sets(const Grid &grid, const std::vector<std::string> &names)
  {
    const auto &triangulation = grid.triangulation();

    // of each tag, the indices of its sets in the list
    std::vector<std::vector<unsigned int>> sets_of_tag;
    for (const CellTag &tag : grid.tags())
      {
        sets_of_tag.emplace_back();
        for (const unsigned int set : tag.sets)
          if (const auto name = std::find(names.begin(),
                                          names.end(),
                                          grid.cell_set_names()[set]);
              name != names.end())
            sets_of_tag.back().push_back(name - names.begin());
        std::sort(sets_of_tag.back().begin(), sets_of_tag.back().end());
      }
    std::vector<unsigned long long> sizes(names.size());
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int set : sets_of_tag[cell->material_id()])
          ++sizes[set];
    sizes = sum_over_ranks(sizes, grid.communicator());

    dealii::Vector<float> result(triangulation.n_active_cells());
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        const auto &sets = sets_of_tag[cell->material_id()];
        const auto  smallest =
          std::min_element(sets.begin(),
                           sets.end(),
                           [&](const unsigned int a, const unsigned int b) {
                             return sizes[a] < sizes[b];
                           });
        result[cell->active_cell_index()] =
          smallest == sets.end() ? -1. : *smallest;
      }
    return result;
  }
} // namespace Voussoir
