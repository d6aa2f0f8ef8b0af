#include <voussoir/base/parameter_file.h>
#include <voussoir/output/section_line.h>
#include <voussoir/output/table_observer.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string sections_entry =
      "\"Sections\" in section \"Output/section forces\"";

    struct SectionQuantity
    {
      const char *name, *unit;
    };
    constexpr unsigned int n_section_quantities = 7;
    const std::array<SectionQuantity, n_section_quantities> quantities{
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
    class SectionForces : public TableObserver
    {
    public:
      SectionForces()
        : TableObserver("section_forces.csv", 0.01)
      {}

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
        declare_interval(prm,
                         "Time between two lines of section_forces.csv [s]; "
                         "extremes are sampled each twentieth of the "
                         "shortest period that the mesh carries with eight "
                         "nodes per wavelength, if that is shorter.");
      }

      void
      check(const ObservedModel &model) const override
      {
        make_lines(model);
      }

      void
      observe(const State &state) override
      {
        if (!is_due(state.step))
          return;
        const auto      &stress = stress_points->evaluate(state);
        auto             tensor = stress.begin();
        std::vector<Sum> shares;
        for (const SectionLine &line : lines)
          {
            std::vector<Sum> sums = no_sums(n_section_quantities);
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
        take({state.time, has_line(state.step), shares, {}});
      }

    private:
      void
      prepare() override
      {
        lines = make_lines(run());
        std::vector<StressPoints::Place> places;
        for (const SectionLine &line : lines)
          for (const auto &point : line.points)
            places.push_back(point.place);
        stress_points = std::make_unique<StressPoints>(run(), places);
        std::vector<std::string> columns;
        for (const SectionLine &line : lines)
          for (const SectionQuantity &quantity : quantities)
            columns.push_back(line.name + ' ' + quantity.name + " [" +
                              quantity.unit + ']');
        keep(extremes, columns.size());
        open_table(columns);
      }

      std::vector<double>
      line_of(const Sample &sample) override
      {
        extremes.take(sample.sums);
        return sample.sums;
      }

      void
      conclude(const State &, nlohmann::json &summary) override
      {
        auto &result = summary["section forces"];
        for (unsigned int i = 0; i < lines.size(); ++i)
          {
            auto &section                 = result[lines[i].name];
            section["upstream point [m]"] = {lines[i].upstream[0],
                                             lines[i].upstream[1],
                                             lines[i].upstream[2]};
            section["thickness [m]"]      = lines[i].thickness;
            for (unsigned int k = 0; k < n_section_quantities; ++k)
              {
                const std::string name = std::string(quantities[k].name) +
                                         " [" + quantities[k].unit + ']';
                const unsigned int column   = n_section_quantities * i + k;
                section["largest " + name]  = extremes.largest[column];
                section["smallest " + name] = extremes.smallest[column];
              }
          }
      }

      std::vector<SectionLine>
      make_lines(const ObservedModel &model) const
      {
        const auto  requests = parse_sections(sections_text, sections_entry);
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
          result.emplace_back(model.solid.discretization,
                              request,
                              faces,
                              sections_entry);
        return result;
      }

      std::string sections_text;
      std::string upstream_sets   = "upstream face";
      std::string downstream_sets = "downstream face";

      std::vector<SectionLine>      lines; // across the dam
      std::unique_ptr<StressPoints> stress_points;
      Extremes                      extremes;
    };

    const Registry<Observer>::Add<SectionForces> registered_section_forces(
      "section forces",
      "Forces and moments of arches and cantilevers in chosen sections, in "
      "section_forces.csv.");
  } // namespace
} // namespace Voussoir
