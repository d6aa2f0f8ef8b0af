#include <voussoir/base/mpi.h>
#include <voussoir/materials/tension_split.h>
#include <voussoir/output/material_memory.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Calls visit(cell, band, outputs of one point) for all points of a
     *  material; without band [m] where it is elastic still. */
    void
    for_each_point(
      const Material                                         &material,
      const PointHistory                                     &history,
      const std::function<void(const Discretization::Cell &,
                               const double,
                               const std::vector<double> &)> &visit)
    {
      const std::vector<double> nothing(material.output_names().size());
      for (const auto &[cell, place] : history.cells())
        for (unsigned int q = 0; q < history.n_points(); ++q)
          {
            const double band = history.band(place, q);
            visit(cell,
                  band,
                  band > 0. ?
                    material.outputs(history.read(place, q).data(), band) :
                    nothing);
          }
    }
  } // namespace


  std::map<std::string, dealii::Vector<float>>
  memory_of_cells(const ObservedModel &model)
  {
    const auto n = model.discretization.grid.triangulation().n_active_cells();
    std::map<std::string, dealii::Vector<float>> result;
    for (unsigned int m = 0; m < model.materials.size(); ++m)
      {
        const PointHistory *history = model.material_memory.of(m);
        const auto          names   = model.materials[m]->output_names();
        for (const std::string &name : names)
          if (result[name].size() == 0)
            result[name].reinit(n);
        if (history == nullptr)
          continue;
        for_each_point(*model.materials[m],
                       *history,
                       [&](const Discretization::Cell &cell,
                           const double                band,
                           const std::vector<double>  &outputs) {
                         for (unsigned int i = 0; band > 0. && i < names.size();
                              ++i)
                           result[names[i]][cell->active_cell_index()] +=
                             outputs[i] / history->n_points();
                       });
      }
    return result;
  }


  WidestCrack
  widest_crack(const ObservedModel &model)
  {
    WidestCrack widest;
    for (unsigned int m = 0; m < model.materials.size(); ++m)
      {
        const auto names = model.materials[m]->output_names();
        const auto opening =
          std::find(names.begin(), names.end(), OutputName::crack_opening) -
          names.begin();
        if (const PointHistory *history = model.material_memory.of(m);
            history != nullptr && opening < std::ptrdiff_t(names.size()))
          for_each_point(*model.materials[m],
                         *history,
                         [&](const Discretization::Cell &,
                             const double               band,
                             const std::vector<double> &outputs) {
                           const double metres = 1e-3 * outputs[opening];
                           if (band > 0. && metres > widest.share * band)
                             widest = {metres, metres / band};
                         });
      }
    const auto all =
      Utilities::MPI::all_gather(model.discretization.grid.communicator(),
                                 std::make_pair(widest.share, widest.opening));
    const auto most = *std::max_element(all.begin(), all.end());
    return {most.second, most.first};
  }


  nlohmann::json
  memory_summary(const ObservedModel            &model,
                 const std::vector<std::string> &material_names)
  {
    nlohmann::json result;
    const MPI_Comm communicator = model.discretization.grid.communicator();
    for (unsigned int m = 0; m < model.materials.size(); ++m)
      {
        const PointHistory *history = model.material_memory.of(m);
        if (history == nullptr)
          continue;
        const auto          names = model.materials[m]->output_names();
        std::vector<double> largest(names.size()), volumes(3);
        for_each_point(*model.materials[m],
                       *history,
                       [&](const Discretization::Cell &cell,
                           const double                band,
                           const std::vector<double>  &outputs) {
                         const double volume =
                           cell->measure() / history->n_points();
                         volumes[0] += volume;
                         if (band > 0.)
                           volumes[1] += volume;
                         for (unsigned int i = 0; i < names.size(); ++i)
                           largest[i] = std::max(largest[i], outputs[i]);
                       });
        volumes[2] = history->losses.material;
        volumes    = sum_over_ranks(volumes, communicator);
        auto &item = result[material_names[m]];
        item["share of the volume that left the elastic range"] =
          volumes[1] / volumes[0];
        item["energy lost [J]"] = volumes[2];
        for (unsigned int i = 0; i < names.size(); ++i)
          item["largest " + names[i]] =
            Utilities::MPI::max(largest[i], communicator);
      }
    return result;
  }
} // namespace Voussoir
