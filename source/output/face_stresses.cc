#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/principal_stress.h>
#include <voussoir/output/face_mesh.h>
#include <voussoir/output/picture_series.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string stressed_sets =
      "\"Face sets\" in section \"Output/face stresses\"";

    /** Stresses on the faces of the dam, in the directions of its arches and
     *  cantilevers, at chosen times and as envelopes. */
    class FaceStresses : public Observer
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Face sets",
          sets,
          "Faces to sample. On them arch stress is along the horizontal, "
          "cantilever stress along the steepest line; tension is positive "
          "[MPa].");
        prm.add_parameter(
          "Envelope interval",
          envelope_interval,
          "Time between two samples for the envelopes [s]; 0 for a "
          "twentieth of the shortest period that the mesh "
          "carries with eight nodes per wavelength.",
          Patterns::Double(0.));
        pictures.declare_parameters(prm);
      }

      void
      check(const ObservedModel &model) const override
      {
        pictures.check(model);
        make_mesh(model).check_not_level(stressed_sets);
      }

      void
      observe(const State &state) override
      {
        const bool picture = pictures.due(state);
        if (!picture && !schedule.due(state.step))
          return;
        const std::vector<double> now = stresses(state);
        if (schedule.due(state.step))
          for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
            for (unsigned int c = 0; c < n_extremes; ++c)
              {
                double      *values   = &envelopes[n_values * node];
                double      &envelope = values[c];
                const double value    = now[4 * node + (c < 4 ? c / 2 : c - 2)];
                if (is_largest(c) ? !(value <= envelope) : !(value >= envelope))
                  {
                    envelope               = value; // a NaN stays
                    values[n_extremes + c] = state.time;
                  }
              }
        if (state.step == 0)
          for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
            std::copy_n(&now[4 * node],
                        4,
                        &envelopes[n_values * node + 2 * n_extremes]);
        if (picture)
          pictures.add(state.time,
                       mesh->write(run(),
                                   {"arch_stress_MPa",
                                    "cantilever_stress_MPa",
                                    "largest_principal_stress_MPa",
                                    "smallest_principal_stress_MPa"},
                                   now,
                                   pictures.next_name(state),
                                   state.time));
      }

    private:
      void
      prepare() override
      {
        pictures.prepare(run());
        schedule = Schedule(envelope_interval > 0. ? envelope_interval :
                                                     run().resolving_interval(),
                            run().time_step);
        if (envelope_interval > 0.)
          run().warn_of_coarse_sampling(
            envelope_interval,
            "\"Envelope interval\" in section \"Output/face stresses\"");
        mesh   = std::make_unique<FaceMesh>(make_mesh(run()));
        stress = std::make_unique<FaceStress>(run(), *mesh);
        directions.clear();
        envelopes.assign(n_values * mesh->n_nodes(), 0.);
        for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
          {
            directions.push_back(mesh->arch_and_cantilever(node));
            for (unsigned int c = 0; c < n_extremes; ++c)
              envelopes[n_values * node + c] =
                (is_largest(c) ? -1. : 1.) * std::numeric_limits<double>::max();
          }
        keep([this] { return mesh->keyed_values(envelopes, n_values); });
      }

      void
      conclude(const State &state, nlohmann::json &summary) override
      {
        mesh->write(run(),
                    {"largest_arch_stress_MPa",
                     "smallest_arch_stress_MPa",
                     "largest_cantilever_stress_MPa",
                     "smallest_cantilever_stress_MPa",
                     "largest_principal_stress_MPa",
                     "smallest_principal_stress_MPa",
                     "time_of_largest_arch_stress_s",
                     "time_of_smallest_arch_stress_s",
                     "time_of_largest_cantilever_stress_s",
                     "time_of_smallest_cantilever_stress_s",
                     "time_of_largest_principal_stress_s",
                     "time_of_smallest_principal_stress_s",
                     "arch_stress_at_start_MPa",
                     "cantilever_stress_at_start_MPa",
                     "largest_principal_stress_at_start_MPa",
                     "smallest_principal_stress_at_start_MPa"},
                    envelopes,
                    "face_stress_envelopes",
                    state.time);
        static const std::array<std::string, n_extremes> names{
          {"largest arch stress [MPa]",
           "smallest arch stress [MPa]",
           "largest cantilever stress [MPa]",
           "smallest cantilever stress [MPa]",
           "largest principal stress [MPa]",
           "smallest principal stress [MPa]"}};
        for (unsigned int c = 0; c < n_extremes; ++c)
          {
            double extreme = -std::numeric_limits<double>::max();
            for (unsigned int node = 0; node < mesh->n_nodes(); ++node)
              extreme = std::max(extreme,
                                 (is_largest(c) ? 1. : -1.) *
                                   envelopes[n_values * node + c]);
            extreme = Utilities::MPI::max(extreme, mesh->communicator());
            summary["face stresses"][names[c]] =
              is_largest(c) ? extreme : -extreme;
          }
      }

      FaceMesh
      make_mesh(const ObservedModel &model) const
      {
        return FaceMesh(model.solid.discretization,
                        split_list(sets),
                        stressed_sets,
                        "face_set",
                        model.names.face_sets);
      }

      static constexpr unsigned int n_extremes = 6,
                                    n_values   = 2 * n_extremes + 4;

      /** Whether an extreme is a largest value: the first is, and every other
       *  after it. */
      static bool
      is_largest(const unsigned int c)
      {
        return c % 2 == 0;
      }

      /** Arch, cantilever, largest and smallest principal stress of each node
       *  [MPa]. */
      std::vector<double>
      stresses(const State &state)
      {
        const auto         &tensors = stress->evaluate(state);
        std::vector<double> result;
        result.reserve(4 * tensors.size());
        for (unsigned int node = 0; node < tensors.size(); ++node)
          {
            const auto along = [&](const Tensor<1, 3> &direction) {
              return 1e-6 * (direction * (tensors[node] * direction));
            };
            const auto [largest, smallest] =
              largest_and_smallest_principal(tensors[node]);
            for (const double value : {along(directions[node][0]),
                                       along(directions[node][1]),
                                       1e-6 * largest,
                                       1e-6 * smallest})
              result.push_back(value);
          }
        return result;
      }

      std::string   sets              = "upstream face, downstream face";
      double        envelope_interval = 0.;
      PictureSeries pictures{"face_stresses", "Output/face stresses"};

      Schedule                    schedule;
      std::unique_ptr<FaceMesh>   mesh;
      std::unique_ptr<FaceStress> stress;

      // of each node: arch, cantilever
      std::vector<std::array<Tensor<1, 3>, 2>> directions;

      // of each node: largest and smallest arch and cantilever stress, largest
      // of the largest and smallest of the smallest principal stress [MPa];
      // their times [s]; and the four stresses at t = 0 [MPa]
      std::vector<double> envelopes;
    };

    const Registry<Observer>::Add<FaceStresses> registered_face_stresses(
      "face stresses",
      "Arch, cantilever and principal stresses on the faces of the dam: "
      "pictures in face_stresses.pvd, extremes, their times and the start in "
      "face_stress_envelopes.vtu.");
  } // namespace
} // namespace Voussoir
