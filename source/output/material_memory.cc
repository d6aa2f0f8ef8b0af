#include <voussoir/base/mpi.h>
#include <voussoir/materials/tension_split.h>
#include <voussoir/output/material_memory.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string opening_now = "crack opening now [mm]";

    /** Number of an output of a material; past the end if it has none. */
    std::size_t
    output_number(const Material &material, const std::string &name)
    {
      const auto names = material.output_names();
      return std::find(names.begin(), names.end(), name) - names.begin();
    }


    /** The names of the outputs of a material, and of results computed from its
     *  internal variables. */
    std::vector<std::string>
    names_of(const Material &material)
    {
      auto names = material.output_names();
      if (reports_cracks(material))
        names.push_back(opening_now);
      return names;
    }


    /** Name of the largest value of all points at the end. */
    std::string
    summary_name(const std::string &name)
    {
      return name == opening_now ? "widest crack opening at the end [mm]" :
             name.rfind("largest", 0) == 0 ? name :
                                             "largest " + name;
    }


    /** Calls visit(cell, band, values of these names) for all points of a
     *  material; the band is zero [m] where the point is still elastic. */
    void
    for_each_point(
      const Solid                                            &solid,
      const unsigned int                                      m,
      const PointHistory                                     &history,
      const std::function<void(const Discretization::Cell &,
                               const double,
                               const std::vector<double> &)> &visit)
    {
      const Material           &material = *solid.materials[m];
      const std::vector<double> nothing(names_of(material).size());
      const bool                cracks = reports_cracks(material);
      const std::size_t         largest =
        output_number(material, OutputName::largest_opening);
      std::vector<double> values;
      for (const auto &[cell, place] : history.cells())
        for (unsigned int q = 0; q < history.n_points(); ++q)
          {
            const double band = history.band(place, q);
            if (band > 0.)
              {
                values = material.outputs(history.read(place, q).data(), band);
                if (cracks)
                  {
                    const CrackOpening opening(
                      solid, m, history, place, q, largest);
                    values.push_back(1e3 * opening.now());
                    if (CrackOpening::is_of_cell(solid))
                      values[largest] = 1e3 * opening.largest();
                  }
              }
            visit(cell, band, band > 0. ? values : nothing);
          }
    }
  } // namespace


  template <typename OfPoint>
  double
  CrackOpening::of_cell(const OfPoint &of_point) const
  {
    if (!is_of_cell(solid))
      return of_point(q);
    const Quadrature<3> &points = solid.discretization.points(material);
    double               sum    = 0.;
    for (unsigned int i = 0; i < points.size(); ++i)
      if (history.band(place, i) > 0.)
        sum += points.weight(i) * of_point(i);
    return sum / solid.discretization.crack_share;
  }


  double
  CrackOpening::now() const
  {
    return of_cell([this](const unsigned int i) { return now_at(i); });
  }


  double
  CrackOpening::largest() const
  {
    return of_cell([this](const unsigned int i) { return largest_at(i); });
  }


  double
  CrackOpening::now_at(const unsigned int q) const
  {
    const ActivePoint     &point = history.active_point(place.batch, q);
    const ElasticConstants elastic =
      solid.materials[material]->elastic_constants();
    const auto   strain = history.inelastic_strain(place,
                                                 q,
                                                 elastic.young_modulus,
                                                 elastic.poisson_ratio);
    Tensor<1, 3> normal;
    for (unsigned int d = 0; d < 3; ++d)
      normal[d] = point.normal[d][place.lane];
    const double across = normal * (strain * normal);
    const auto   stress = lane_of(point.stress, place.lane);
    // at 30 degrees to the stress an open crack still has less than this share
    constexpr double closed = 0.01;
    if (normal * (stress * normal) < -closed * elastic.young_modulus * across)
      return 0.;
    return std::max(0.,
                    std::min(largest_at(q), history.band(place, q) * across));
  }


  double
  CrackOpening::largest_at(const unsigned int q) const
  {
    return 1e-3 *
           solid.materials[material]->outputs(history.read(place, q).data(),
                                              history.band(place, q))[number];
  }


  bool
  reports_cracks(const Material &material)
  {
    return output_number(material, OutputName::largest_opening) <
           material.output_names().size();
  }


  namespace
  {
    /** Calls visit(number of the material, history, cell, place, point, band)
     *  for the points of for_each_crack(). */
    template <typename Visit>
    void
    for_each_active(const ObservedRun &run, const Visit &visit)
    {
      for (unsigned int m = 0; m < run.solid.materials.size(); ++m)
        {
          const Material     &material = *run.solid.materials[m];
          const PointHistory *history  = run.material_memory.of(m);
          if (history == nullptr || !reports_cracks(material))
            continue;
          for (const auto &[cell, place] : history->cells())
            for (unsigned int q = 0; q < history->n_points(); ++q)
              if (const double band = history->band(place, q); band > 0.)
                visit(m, *history, cell, place, q, band);
        }
    }
  } // namespace


  void
  for_each_active_point(const ObservedRun                             &run,
                        const std::function<void(const Discretization::Cell &,
                                                 const unsigned int)> &visit)
  {
    for_each_active(run,
                    [&](const unsigned int,
                        const PointHistory &,
                        const Discretization::Cell &cell,
                        const PointHistory::Place &,
                        const unsigned int q,
                        const double) { visit(cell, q); });
  }


  void
  for_each_crack(const ObservedRun                               &run,
                 const std::function<void(const Discretization::Cell &,
                                          const unsigned int,
                                          const double,
                                          const CrackOpening &)> &visit)
  {
    unsigned int known  = numbers::invalid_unsigned_int;
    std::size_t  number = 0;
    for_each_active(
      run,
      [&](const unsigned int          m,
          const PointHistory         &history,
          const Discretization::Cell &cell,
          const PointHistory::Place  &place,
          const unsigned int          q,
          const double                band) {
        if (m != known)
          number =
            output_number(*run.solid.materials[m], OutputName::largest_opening);
        known = m;
        visit(cell, q, band, {run.solid, m, history, place, q, number});
      });
  }


  std::map<std::string, dealii::Vector<float>>
  memory_of_cells(const Solid &solid, const MaterialMemory &memory)
  {
    const auto n          = solid.grid().triangulation().n_active_cells();
    const auto is_opening = [](const std::string &name) {
      return name == opening_now || name == OutputName::largest_opening;
    };
    std::map<std::string, dealii::Vector<float>> result;
    for (unsigned int m = 0; m < solid.materials.size(); ++m)
      {
        const PointHistory *history = memory.of(m);
        const auto          names   = names_of(*solid.materials[m]);
        for (const std::string &name : names)
          if (result[name].size() == 0)
            result[name].reinit(n);
        if (history == nullptr)
          continue;
        for_each_point(
          solid,
          m,
          *history,
          [&](const Discretization::Cell &cell,
              const double                band,
              const std::vector<double>  &outputs) {
            for (unsigned int i = 0; band > 0. && i < names.size(); ++i)
              if (float &value = result[names[i]][cell->active_cell_index()];
                  CrackOpening::is_of_cell(solid) && is_opening(names[i]))
                value = std::max<float>(value, outputs[i]);
              else
                value += outputs[i] / history->n_points();
          });
      }
    return result;
  }


  WidestCrack
  widest_crack(const ObservedRun &run, const bool ever)
  {
    // share, opening, place
    std::array<double, 5> widest{};
    for_each_crack(
      run,
      [&](const Discretization::Cell &cell,
          const unsigned int,
          const double        band,
          const CrackOpening &opening) {
        const double wide   = ever ? opening.largest() : opening.now();
        const double length = band / run.solid.discretization.crack_share;
        if (wide > widest[0] * length)
          {
            const Point<3> where = cell->center();
            widest = {{wide / length, wide, where[0], where[1], where[2]}};
          }
      });
    for (const auto &other :
         Utilities::MPI::all_gather(run.solid.grid().communicator(), widest))
      widest = std::max(widest, other);
    return {widest[1], widest[0], Point<3>(widest[2], widest[3], widest[4])};
  }


  nlohmann::json
  memory_summary(const ObservedRun              &run,
                 const std::vector<std::string> &material_names)
  {
    nlohmann::json result;
    const MPI_Comm communicator = run.solid.grid().communicator();
    for (unsigned int m = 0; m < run.solid.materials.size(); ++m)
      {
        const PointHistory *history = run.material_memory.of(m);
        if (history == nullptr)
          continue;
        const auto          names = names_of(*run.solid.materials[m]);
        std::vector<double> largest(names.size()), volumes(4);
        for_each_point(run.solid,
                       m,
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
        for (const auto &[cell, place] : history->cells())
          if (history->tip_strength(place.batch)[place.lane] < 1.)
            ++volumes[3];
        volumes = sum_over_ranks(volumes, communicator);
        if (volumes[0] == 0.) // a class of a random field without cells
          continue;
        auto &item = result[material_names[m]];
        item["share of the volume that left the elastic range"] =
          volumes[1] / volumes[0];
        item["energy lost [J]"] = volumes[2];
        if (run.solid.materials[m]->cracks_grow())
          item["cells at tips of cracks and notches"] = volumes[3];
        for (unsigned int i = 0; i < names.size(); ++i)
          item[summary_name(names[i])] =
            Utilities::MPI::max(largest[i], communicator);
      }
    return result;
  }
} // namespace Voussoir
