#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/option.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/files/table.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/area_above.h>
#include <voussoir/output/over_stress_limits.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string over_stress_section = "section \"Output/over-stress\"";
    const std::string over_stressed_sets =
      "\"Face sets\" in " + over_stress_section;


    enum class ComparedStress
    {
      principal,
      arch_and_cantilever
    };

    OptionNames<ComparedStress>
    option_names(const ComparedStress)
    {
      return {{ComparedStress::principal, "principal"},
              {ComparedStress::arch_and_cantilever, "arch and cantilever"}};
    }


    /**
     * Over-stress of the faces of a dam in a linear analysis: amount, time and
     * area of the tension above the strength, and whether these call for a
     * non-linear analysis (see OverStressLimits).
     */
    class OverStress : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets", sets, "Faces to evaluate.");
        add_option(
          prm,
          "Stress",
          compared,
          "Stress that is compared with the strength: the largest principal "
          "stress, or the larger one of arch and cantilever stress.");
        prm.add_parameter(
          "Tensile strength",
          strengths,
          "Static tensile strength of the concrete, one for all faces or one "
          "for each [Pa]; 0 for the strength of the materials. The "
          "demand-capacity ratio is the tension over it." +
            usually(Usual::tensile_strength_or_none),
          Patterns::List(Patterns::Double(0.), 1));
        prm.add_parameter(
          "Strengths of materials",
          of_materials,
          "The same by material, \"concrete: 2e6; crest: 3e6\", where "
          "\"Tensile strength\" is 0. Empty for the strengths of the linear "
          "elastic materials.");
        limits.declare_parameters(prm);
      }

      void
      check(const ObservedModel &model) const override
      {
        const FaceMesh faces = make_mesh(model);
        if (compared != ComparedStress::principal)
          faces.check_not_level(over_stressed_sets);
        const auto face_sets = split_list(sets);
        if (strengths.size() != 1 && strengths.size() != face_sets.size())
          throw UserError("\"Tensile strength\" in " + over_stress_section +
                          " has " + std::to_string(strengths.size()) +
                          " values for " + std::to_string(face_sets.size()) +
                          " face sets; give one for all or one for each.");
        strengths_of_nodes(model, faces);
        limits.check(over_stress_section);
        check_elastic(model, face_sets);
      }

      void
      observe(const State &state) override
      {
        if (state.step < next_step) // the state of the checkpoint has been
                                    // evaluated before
          return;
        const double interval = state.step == 0 ? 0. : run().time_step;
        next_step             = state.step + 1;
        find_ratios(state);
        if (state.step == 0)
          at_rest = ratio_of_node;
        for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
          {
            const double ratio = ratio_of_node[node];
            if (!(ratio <= largest[2 * node])) // a NaN stays
              {
                largest[2 * node]     = ratio;
                largest[2 * node + 1] = state.time;
              }
            const std::size_t n_below = std::lower_bound(limits.ratios.begin(),
                                                         limits.ratios.end(),
                                                         ratio) -
                                        limits.ratios.begin();
            if (n_below > 0)
              times[n_ratios() * node + n_below - 1] += interval;
          }
        waiting_times.push_back(state.time);
        waiting_areas.resize(waiting_areas.size() + n_areas(), 0.);
        areas->add(ratio_of_node,
                   waiting_areas.data() + waiting_areas.size() - n_areas());
        if (waiting_times.size() >= 1000)
          flush();
      }

    private:
      void
      prepare() override
      {
        names  = split_list(sets);
        mesh   = std::make_unique<FaceMesh>(make_mesh(run()));
        stress = std::make_unique<FaceStress>(run(), *mesh);
        areas  = std::make_unique<AreaAbove>(*mesh, limits.ratios);
        directions.clear();
        strength_of_node = strengths_of_nodes(run(), *mesh);
        for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
          if (compared != ComparedStress::principal)
            directions.push_back(mesh->arch_and_cantilever(node));
        at_rest.assign(mesh->n_nodes(), 0.);
        largest.assign(2 * mesh->n_nodes(), 0.);
        times.assign(n_ratios() * mesh->n_nodes(), 0.);
        keep([this] {
          auto values = mesh->keyed_values(largest, 2);
          values.merge(mesh->keyed_values(times, n_ratios(), ", times"));
          values.merge(mesh->keyed_values(at_rest, 1, ", at rest"));
          return values;
        });
        keep("next step", next_step, 0);
        keep("largest areas",
             at_once,
             std::vector<std::array<double, 2>>(n_areas(), {{0., 0.}}));
        waiting_areas.clear();
        waiting_times.clear();
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        const std::vector<FaceOverStress> faces = find_faces();
        std::vector<std::string>          reasons;
        nlohmann::json                   &result = summary["over-stress"];
        for (const FaceOverStress &face : faces)
          {
            result[face.name] = limits.json(face);
            for (const std::string &reason : limits.reasons_of(face))
              reasons.push_back(reason);
          }
        std::string verdict = "linear analysis suffices";
        if (!reasons.empty())
          verdict = "non-linear analysis is called for: ";
        for (std::size_t i = 0; i < reasons.size(); ++i)
          verdict += (i == 0 ? "" : "; ") + reasons[i];
        result["verdict"] = verdict;
        run().log.line("Over-stress of the faces: ", verdict);
        if (!reasons.empty())
          run().log.warn("\"over-stress\": ", verdict);
        write_curves(faces);
        write_fields(state.time);
      }

      FaceMesh
      make_mesh(const ObservedModel &model) const
      {
        return FaceMesh(model.solid.discretization,
                        split_list(sets),
                        over_stressed_sets,
                        "face_set",
                        model.names.face_sets);
      }

      /** Strength at each node of the faces, the least of the materials there
       *  [Pa]. */
      std::vector<double>
      strengths_of_nodes(const ObservedModel &model,
                         const FaceMesh      &faces) const
      {
        std::map<std::string, double> of_material;
        for (const std::string &item : split_list(of_materials, ';'))
          {
            const auto        colon = item.rfind(':');
            const std::string name  = Utilities::trim(item.substr(0, colon));
            const auto        value =
              colon == std::string::npos ?
                       std::optional<double>() :
                       parse_number(Utilities::trim(item.substr(colon + 1)));
            const auto &known = model.names.materials;
            if (!value ||
                std::find(known.begin(), known.end(), name) == known.end())
              throw UserError("\"Strengths of materials\" in " +
                              over_stress_section + " has \"" + item +
                              "\"; write \"MATERIAL: STRENGTH\" with a "
                              "material of the case.");
            of_material[name] = *value;
          }
        std::vector<double> strength(faces.n_nodes(),
                                     std::numeric_limits<double>::max());
        for (std::size_t i = 0; i < faces.places().size(); ++i)
          {
            const unsigned int node = faces.nodes_of_places()[i],
                               set  = faces.sets_and_nodes()[node].first;
            const std::string &material =
              model.names
                .materials[model.solid.grid().material(faces.places()[i].cell)];
            double value = strengths[strengths.size() == 1 ? 0 : set];
            if (const auto own = of_material.find(material);
                value == 0. && own != of_material.end())
              value = own->second;
            strength[node] = std::min(strength[node], value);
          }
        const bool any_missing =
          std::any_of(strength.begin(), strength.end(), [](const double value) {
            return value <= 0.;
          });
        if (Utilities::MPI::logical_or(any_missing, faces.communicator()))
          throw UserError("\"Tensile strength\" in " + over_stress_section +
                          " is 0; give the static tensile strength of the "
                          "concrete in Pa, there or with its material.");
        return strength;
      }

      /** Refuses materials that crack, as the tension in cracked concrete is no
       *  measure of the demand. */
      static void
      check_elastic(const ObservedModel            &model,
                    const std::vector<std::string> &face_sets)
      {
        int cracking = -1; // number of a material
        for (const std::string &name : face_sets)
          model.solid.grid().for_each_face(
            name, [&](const auto &cell, const unsigned int) {
              const int material = model.solid.grid().material(cell);
              if (model.solid.materials[material]->n_history() > 0)
                cracking = material;
            });
        cracking =
          Utilities::MPI::max(cracking, model.solid.grid().communicator());
        if (cracking >= 0)
          throw UserError(
            "The faces of " + over_stress_section +
            " have cells of the material \"" + model.names.materials[cracking] +
            "\", whose stress is limited by its strength, but over-stress is "
            "that of a linear analysis; choose a linear elastic law, or "
            "remove the observer \"over-stress\".");
      }

      unsigned int
      n_ratios() const
      {
        return limits.ratios.size();
      }

      /** Number of areas, one for each set and ratio. */
      std::size_t
      n_areas() const
      {
        return names.size() * n_ratios();
      }

      /** Finds the demand-capacity ratio of each node. */
      void
      find_ratios(const State &state)
      {
        const auto &tensors = stress->evaluate(state);
        ratio_of_node.resize(tensors.size());
        for (unsigned int first = 0; first < tensors.size();
             first += Lanes::size())
          {
            const unsigned int n =
              std::min<std::size_t>(Lanes::size(), tensors.size() - first);
            if (compared == ComparedStress::principal)
              {
                SymmetricTensor3<Lanes> together;
                for (unsigned int lane = 0; lane < n; ++lane)
                  for (unsigned int c = 0; c < 6; ++c)
                    together.access_raw_entry(c)[lane] =
                      tensors[first + lane].access_raw_entry(c);
                const Lanes largest =
                  largest_and_smallest_principal(together).first;
                for (unsigned int lane = 0; lane < n; ++lane)
                  ratio_of_node[first + lane] = largest[lane];
              }
            else
              for (unsigned int node = first; node < first + n; ++node)
                {
                  const auto &[arch, cantilever] = directions[node];
                  ratio_of_node[node] =
                    std::max(arch * (tensors[node] * arch),
                             cantilever * (tensors[node] * cantilever));
                }
          }
        for (unsigned int node = 0; node < tensors.size(); ++node)
          ratio_of_node[node] /= strength_of_node[node];
      }

      /** Sums the areas of the pending moments over the ranks. */
      void
      flush() override
      {
        const auto sums = sum_over_ranks(waiting_areas, mesh->communicator());
        for (std::size_t i = 0; i < sums.size(); ++i)
          {
            auto &[area, time] = at_once[i % n_areas()];
            if (sums[i] > area)
              {
                area = sums[i];
                time = waiting_times[i / n_areas()];
              }
          }
        waiting_areas.clear();
        waiting_times.clear();
      }

      /** Time of a node above each ratio, including the time above the next one
       *  [s]. */
      std::vector<double>
      accumulated_times(const unsigned int node) const
      {
        const double       *own = &times[n_ratios() * node];
        std::vector<double> above(own, own + n_ratios());
        for (unsigned int r = n_ratios() - 1; r > 0; --r)
          above[r - 1] += above[r];
        return above;
      }

      std::vector<FaceOverStress>
      find_faces() const
      {
        const auto          communicator = mesh->communicator();
        std::vector<double> ratio, ever(n_areas()), accumulated(n_areas()),
          beyond_rest(n_areas()), resting(n_areas());
        // of each set: largest ratio, its time and place; the same of the
        // static state
        constexpr double none = -std::numeric_limits<double>::max();
        std::vector<std::array<double, 5>> most(names.size(), {{none}});
        std::vector<std::array<double, 4>> most_at_rest(names.size(), {{none}});
        for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
          {
            const unsigned int set   = mesh->sets_and_nodes()[node].first;
            const Point<3>    &where = mesh->position(node);
            const auto         above = accumulated_times(node);
            ratio.push_back(largest[2 * node]);
            most[set] = std::max(most[set],
                                 {{largest[2 * node],
                                   largest[2 * node + 1],
                                   where[0],
                                   where[1],
                                   where[2]}});
            most_at_rest[set] =
              std::max(most_at_rest[set],
                       {{at_rest[node], where[0], where[1], where[2]}});
            for (unsigned int r = 0; r < n_ratios(); ++r)
              {
                const unsigned int i = set * n_ratios() + r;
                accumulated[i]       = std::max(accumulated[i], above[r]);
                if (at_rest[node] <= limits.ratios[r])
                  beyond_rest[i] = std::max(beyond_rest[i], above[r]);
              }
          }
        areas->add(ratio, ever.data());
        areas->add(at_rest, resting.data());
        ever    = sum_over_ranks(ever, communicator);
        resting = sum_over_ranks(resting, communicator);
        Utilities::MPI::max(accumulated, communicator, accumulated);
        Utilities::MPI::max(beyond_rest, communicator, beyond_rest);
        const auto total =
          sum_over_ranks(areas->total(names.size()), communicator);
        const auto take_largest = [&](auto &of_sets) {
          for (const auto &other :
               Utilities::MPI::all_gather(communicator, of_sets))
            for (unsigned int set = 0; set < names.size(); ++set)
              of_sets[set] = std::max(of_sets[set], other[set]);
        };
        take_largest(most);
        take_largest(most_at_rest);

        std::vector<FaceOverStress> faces;
        for (unsigned int set = 0; set < names.size(); ++set)
          {
            const auto &[greatest, time, x, y, z] = most[set];
            FaceOverStress &face                  = faces.emplace_back();
            face.name                             = names[set];
            face.area                             = total[set];
            face.largest                          = greatest;
            face.time                             = time;
            face.where                            = Point<3>(x, y, z);
            face.largest_at_rest                  = most_at_rest[set][0];
            face.where_at_rest = Point<3>(most_at_rest[set][1],
                                          most_at_rest[set][2],
                                          most_at_rest[set][3]);
            for (unsigned int i = set * n_ratios(); i < (set + 1) * n_ratios();
                 ++i)
              {
                face.accumulated.push_back(accumulated[i]);
                face.beyond_rest.push_back(beyond_rest[i]);
                face.resting.push_back(resting[i]);
                face.ever.push_back(ever[i]);
                face.at_once.push_back(at_once[i][0]);
                face.time_at_once.push_back(at_once[i][1]);
              }
          }
        return faces;
      }

      void
      write_curves(const std::vector<FaceOverStress> &faces) const
      {
        if (Utilities::MPI::this_mpi_process(mesh->communicator()) != 0)
          return;
        std::vector<std::string>         titles{"ratio", "allowed time [s]"};
        std::vector<std::vector<double>> columns{limits.ratios, {}};
        for (const double ratio : limits.ratios)
          columns[1].push_back(limits.allowed_time(ratio));
        for (const FaceOverStress &face : faces)
          {
            titles.push_back(face.name + " accumulated time [s]");
            titles.push_back(face.name + " area at any time [m2]");
            titles.push_back(face.name + " largest area at once [m2]");
            columns.push_back(face.accumulated);
            columns.push_back(face.ever);
            columns.push_back(face.at_once);
          }
        const std::string file = run().folder + "/over_stress.csv";
        run().log.attempted(file,
                            write_file(file, csv_of_columns(titles, columns)));
      }

      void
      write_fields(const double time) const
      {
        std::vector<std::string> fields{"largest_ratio",
                                        "time_of_largest_ratio_s"};
        for (const double ratio : limits.ratios)
          fields.push_back("time_above_" + OverStressLimits::text(ratio) +
                           "_s");
        std::vector<double> fields_of_nodes;
        for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
          {
            const double *own = &largest[2 * node];
            fields_of_nodes.insert(fields_of_nodes.end(), own, own + 2);
            for (const double seconds : accumulated_times(node))
              fields_of_nodes.push_back(seconds);
          }
        mesh->write(run(), fields, fields_of_nodes, "over_stress", time);
      }

      std::string         sets     = "upstream face, downstream face";
      ComparedStress      compared = ComparedStress::principal;
      std::vector<double> strengths{0.};
      std::string         of_materials;
      OverStressLimits    limits;

      std::vector<std::string>    names; // of the face sets
      std::unique_ptr<FaceMesh>   mesh;
      std::unique_ptr<FaceStress> stress;
      std::unique_ptr<AreaAbove>  areas;

      // of each node: arch and cantilever stress if they are needed, strength
      // [Pa], ratio now, largest one and its time [s], and for each ratio of
      // the list the time between this ratio and the next one [s]
      std::vector<std::array<Tensor<1, 3>, 2>> directions;
      std::vector<double>                      strength_of_node, ratio_of_node;
      std::vector<double>                      largest, times;
      std::vector<double>                      at_rest; // ratio at t = 0

      unsigned long long next_step = 0; // to be evaluated

      // of each set and ratio the largest area at a moment [m2], and its time
      // [s]; areas of this rank at the pending moments
      std::vector<std::array<double, 2>> at_once;
      std::vector<double>                waiting_areas, waiting_times;
    };

    const Registry<Observer>::Add<OverStress> registered_over_stress(
      "over-stress",
      "Tension above the strength on the faces of a dam, by amount, time and "
      "area, in over_stress.csv and over_stress.vtu, and whether a linear "
      "analysis suffices.");
  } // namespace
} // namespace Voussoir
