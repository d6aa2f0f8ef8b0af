#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/files/table.h>
#include <voussoir/output/section_line.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string place =
      "\"Sections\" in section \"Output/section forces\"";

    struct Quantity
    {
      const char *name, *unit;
    };
    constexpr unsigned int                   n_quantities = 7;
    const std::array<Quantity, n_quantities> quantities{
      {{"arch thrust", "MN/m"},
       {"arch moment", "MNm/m"},
       {"arch shear", "MN/m"},
       {"cantilever force", "MN/m"},
       {"cantilever moment", "MNm/m"},
       {"cantilever shear", "MN/m"},
       {"tangential shear", "MN/m"}}};

    /**
     * Forces and moments in sections through the dam, from the stress on a line
     * across it: N = int sigma dxi and M = int sigma xi dxi about the middle.
     */
    class SectionForces : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Sections",
          sections_text,
          "Named places on the upstream face, \"name: x z\" or \"name: x y z\" "
          "[m], separated by \";\". From the nearest point of that face a "
          "horizontal line runs along its normal through the dam. Arch thrust, "
          "moment and shear are per metre of height, those of the cantilever "
          "(vertical force) per metre of arch length [MN/m, MNm/m]; tension is "
          "positive, moments are positive with tension upstream.");
        prm.add_parameter("Upstream",
                          upstream_sets,
                          "Face sets on which the lines begin.");
        prm.add_parameter("Downstream",
                          downstream_sets,
                          "Face sets on which the lines end.");
        prm.add_parameter("Interval",
                          interval,
                          "Time between two lines of section_forces.csv [s]; "
                          "extremes are those of a twentieth of the shortest "
                          "period that the mesh carries with eight nodes per "
                          "wavelength, if that is shorter.",
                          Patterns::Double(1e-6));
      }

      void
      check(const ObservedModel &model) const override
      {
        make_lines(model);
      }

      void
      prepare(const ObservedModel &model,
              const double         start_time,
              const bool           restarted) override
      {
        communicator = model.solid.grid().communicator();
        exact_sums   = model.solid.discretization.reproducible;
        schedule     = Schedule(interval, model.time_step);
        looks = Schedule(model.looking_interval(interval), model.time_step);
        lines = make_lines(model);
        std::vector<StressPoints::Place> places;
        for (const SectionLine &line : lines)
          for (const auto &point : line.points)
            places.push_back(point.place);
        stress_points = std::make_unique<StressPoints>(model, places);
        shares.clear();
        times.clear();
        largest.assign(n_quantities * lines.size(),
                       -std::numeric_limits<double>::max());
        smallest.assign(n_quantities * lines.size(),
                        std::numeric_limits<double>::max());
        std::vector<std::string> columns;
        for (const SectionLine &line : lines)
          for (const Quantity &quantity : quantities)
            columns.push_back(line.name + ' ' + quantity.name + " [" +
                              quantity.unit + ']');
        table.open(model.log,
                   model.folder + "/section_forces.csv",
                   columns,
                   model.time_step,
                   start_time,
                   restarted);
      }

      void
      observe(const State &state) override
      {
        const bool has_line = schedule.due(state.step);
        if (!has_line && !looks.due(state.step))
          return;
        const auto &stress = stress_points->evaluate(state);
        auto        tensor = stress.begin();
        for (const SectionLine &line : lines)
          {
            std::vector<Sum> sums(n_quantities, Sum(exact_sums));
            for (const auto &point : line.points)
              {
                const double       factor  = 1e-6 * point.weight;
                const Tensor<1, 3> on_arch = *tensor * line.arch,
                                   on_height =
                                     *tensor * Tensor<1, 3>({0, 0, 1});
                ++tensor;
                sums[0] += factor * (on_arch * line.arch);
                sums[1] += factor * (on_arch * line.arch) * point.coordinate;
                sums[2] += factor * (on_arch * line.normal);
                sums[3] += factor * on_height[2];
                sums[4] += factor * on_height[2] * point.coordinate;
                sums[5] += factor * (on_height * line.normal);
                sums[6] += factor * (on_height * line.arch);
              }
            shares.insert(shares.end(), sums.begin(), sums.end());
          }
        times.emplace_back(state.time, has_line);
        if (times.size() >= 100)
          flush();
      }

      void
      finish(const State &, nlohmann::json &summary) override
      {
        flush();
        auto &result = summary["section forces"];
        for (unsigned int i = 0; i < lines.size(); ++i)
          {
            auto &section                 = result[lines[i].name];
            section["upstream point [m]"] = {lines[i].upstream[0],
                                             lines[i].upstream[1],
                                             lines[i].upstream[2]};
            section["thickness [m]"]      = lines[i].thickness;
            for (unsigned int k = 0; k < n_quantities; ++k)
              {
                const std::string name = std::string(quantities[k].name) +
                                         " [" + quantities[k].unit + ']';
                section["largest " + name]  = largest[n_quantities * i + k];
                section["smallest " + name] = smallest[n_quantities * i + k];
              }
          }
      }

      nlohmann::json
      save() override
      {
        flush();
        return {{"largest", largest}, {"smallest", smallest}};
      }

      void
      load(const nlohmann::json &saved) override
      {
        if (saved.at("largest").size() != largest.size())
          return;
        saved.at("largest").get_to(largest);
        saved.at("smallest").get_to(smallest);
      }

    private:
      std::vector<SectionLine>
      make_lines(const ObservedModel &model) const
      {
        const auto  requests = parse_sections(sections_text, place);
        const Grid &grid     = model.solid.grid();
        const std::array<std::vector<FaceCorners>, 2> faces{
          {gather_faces(grid,
                        split_list(upstream_sets),
                        "\"Upstream\" in section \"Output/section forces\""),
           gather_faces(
             grid,
             split_list(downstream_sets),
             "\"Downstream\" in section \"Output/section forces\"")}};
        std::vector<SectionLine> result;
        for (const SectionRequest &request : requests)
          result.emplace_back(model, request, faces, place);
        return result;
      }

      void
      flush()
      {
        const auto        sums  = sum_over_ranks(shares, communicator);
        const std::size_t width = n_quantities * lines.size();
        for (std::size_t i = 0; i < times.size(); ++i)
          {
            const std::vector<double> values(sums.begin() + i * width,
                                             sums.begin() + (i + 1) * width);
            for (std::size_t k = 0; k < width; ++k)
              {
                largest[k]  = std::max(largest[k], values[k]);
                smallest[k] = std::min(smallest[k], values[k]);
              }
            const auto &[time, has_line] = times[i];
            if (has_line)
              table.write(time, values);
          }
        table.flush();
        shares.clear();
        times.clear();
      }

      std::string sections_text;
      std::string upstream_sets   = "upstream face";
      std::string downstream_sets = "downstream face";
      double      interval        = 0.01;

      MPI_Comm                      communicator;
      Schedule                      schedule, looks;
      std::vector<SectionLine>      lines;
      std::unique_ptr<StressPoints> stress_points;
      TimeTable                     table;
      std::vector<double>           largest, smallest;
      std::vector<Sum>              shares;
      bool                          exact_sums = false;

      std::vector<std::pair<double, bool>> times; // of looks; with a line
    };

    const Registry<Observer>::Add<SectionForces> registered(
      "section forces",
      "Forces and moments of arches and cantilevers in chosen sections, in "
      "section_forces.csv.");
  } // namespace
} // namespace Voussoir
