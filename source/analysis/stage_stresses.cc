#include <voussoir/analysis/stage_stresses.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/principal_stress.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::vector<std::string>
    sets_of(const Grid &grid, const std::string &text)
    {
      if (!text.empty())
        return split_list(text);
      std::vector<std::string>        result;
      const std::vector<std::string> &known = grid.face_set_names();
      for (const char *name : {"upstream face", "downstream face"})
        if (std::find(known.begin(), known.end(), name) != known.end())
          result.push_back(name);
      return result;
    }


    struct Quantity
    {
      const char *name;
      bool        is_largest;
    };

    // those of level faces first
    constexpr std::array<Quantity, 6> quantities{
      {{"largest principal stress", true},
       {"smallest principal stress", false},
       {"largest arch stress", true},
       {"smallest arch stress", false},
       {"largest cantilever stress", true},
       {"smallest cantilever stress", false}}};
  } // namespace


  StageStresses::StageStresses(const Discretization &discretization,
                               const std::string    &sets)
  {
    for (const std::string &name : sets_of(discretization.grid, sets))
      {
        auto mesh = std::make_unique<const FaceMesh>(
          discretization,
          std::vector<std::string>{name},
          "\"Face sets\" in section \"Static state\"",
          "face_set",
          discretization.grid.face_set_names());
        const bool is_level = mesh->is_level();
        faces.push_back({name, std::move(mesh), is_level});
      }
  }


  std::vector<const FaceMesh *>
  StageStresses::faces_with_arches() const
  {
    std::vector<const FaceMesh *> result;
    for (const Face &face : faces)
      if (!face.is_level)
        result.push_back(face.mesh.get());
    return result;
  }


  void
  StageStresses::describe(const StressModel &model,
                          nlohmann::json    &report) const
  {
    State state;
    state.displacement = model.initial.displacement;
    state.velocity.reinit(state.displacement);
    for (const Face &face : faces)
      {
        const auto tensors = FaceStress(model, *face.mesh).evaluate(state);
        const unsigned int n_quantities = face.is_level ? 2 : 6;

        // of each extreme the value, negative if it is a smallest, and place
        std::vector<std::array<double, 4>> most(
          n_quantities, {{std::numeric_limits<double>::lowest()}});
        for (unsigned int node = 0; node < tensors.size(); ++node)
          {
            const auto [largest, smallest] =
              largest_and_smallest_principal(tensors[node]);
            std::vector<double> values{largest, smallest};
            if (!face.is_level)
              for (const auto &direction : face.mesh->arch_and_cantilever(node))
                values.insert(values.end(),
                              2,
                              direction * (tensors[node] * direction));
            const Point<3> &at = face.mesh->position(node);
            for (unsigned int c = 0; c < n_quantities; ++c)
              most[c] =
                std::max(most[c],
                         {{(quantities[c].is_largest ? 1. : -1.) * values[c],
                           at[0],
                           at[1],
                           at[2]}});
          }
        for (const auto &others :
             Utilities::MPI::all_gather(face.mesh->communicator(), most))
          for (unsigned int c = 0; c < n_quantities; ++c)
            most[c] = std::max(most[c], others[c]);

        nlohmann::json &result = report["faces"][face.name];
        for (unsigned int c = 0; c < n_quantities; ++c)
          {
            const std::string name       = quantities[c].name;
            const auto &[value, x, y, z] = most[c];
            result[name + " [MPa]"] =
              (quantities[c].is_largest ? 1e-6 : -1e-6) * value;
            result["place of the " + name + " [m]"] = {x, y, z};
          }
      }
  }
} // namespace Voussoir
