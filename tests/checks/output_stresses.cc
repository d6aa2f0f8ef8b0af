#include "observed.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Stresses on the faces and section forces of a block with a known stress:
     * y is the direction of the river, the face "back" is upstream.
     */
    class OutputStresses : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Bending",
                          bending,
                          "With stresses that vary linearly in y.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        verdict               = &verdicts;
        this->model           = simulation.get();
        const auto elastic =
          simulation->model.solid.materials[0]->elastic_constants();
        young = elastic.young_modulus;
        nu    = elastic.poisson_ratio;

        // 1.5 MPa along x, y or z
        for (unsigned int d = 0; d < 3; ++d)
          uniaxial(d);
        shear(elastic.shear_modulus());
        if (bending)
          for (const unsigned int d : {0, 2})
            bend(d);
      }

    private:
      using Field = std::function<Tensor<1, 3>(const Point<3> &)>;

      State
      state_of(const Field &displacement) const
      {
        State state        = model->run.state;
        state.displacement = 0.;
        const auto &positions =
          model->model.solid.discretization.node_positions;
        for (unsigned int node = 0; node < positions.size(); ++node)
          {
            const auto u = displacement(positions[node]);
            for (unsigned int d = 0; d < 3; ++d)
              state.displacement.local_element(3 * node + d) = u[d];
          }
        return state;
      }


      nlohmann::json
      on_faces(const Field &field) const
      {
        return observed("face stresses",
                        {{"Face sets", "front, back"}},
                        *model,
                        {state_of(field)});
      }


      nlohmann::json
      in_section(const Field &field) const
      {
        // the block is 10 m thick; this line crosses its cells between their
        // nodes
        return observed("section forces",
                        {{"Sections", "line: 3.7 5.3; edge: 4 10 8"},
                         {"Upstream", "back"},
                         {"Downstream", "front"}},
                        *model,
                        {state_of(field)});
      }


      Tensor<1, 3>
      stretched(const Point<3> &x, const unsigned int d) const
      {
        Tensor<1, 3> u;
        for (unsigned int i = 0; i < 3; ++i)
          u[i] = 1.5e6 / young * (i == d ? 1. : -nu) * x[i];
        return u;
      }


      void
      uniaxial(const unsigned int d)
      {
        const std::string along = std::string(", pulled along ") + "xyz"[d];
        const Field field = [&](const Point<3> &x) { return stretched(x, d); };
        const auto  faces = on_faces(field);
        near_or_zero("arch stress [MPa]" + along,
                     faces.at("largest arch stress [MPa]"),
                     d == 0 ? 1.5 : 0.);
        near_or_zero("cantilever stress [MPa]" + along,
                     faces.at("smallest cantilever stress [MPa]"),
                     d == 2 ? 1.5 : 0.);
        near_or_zero("largest principal stress [MPa]" + along,
                     faces.at("largest principal stress [MPa]"),
                     1.5);
        // a double eigenvalue is accurate to the root of the round-off only
        verdict->below("smallest principal stress [MPa]" + along,
                       faces.at("smallest principal stress [MPa]"),
                       1e-7);
        const auto forces = in_section(field);
        for (const std::string section : {"line", "edge"})
          {
            const auto &here = forces.at(section);
            near_or_zero(section + ": arch thrust [MN/m]" + along,
                         here.at("largest arch thrust [MN/m]"),
                         d == 0 ? 15. : 0.);
            near_or_zero(section + ": arch moment [MNm/m]" + along,
                         here.at("largest arch moment [MNm/m]"),
                         0.);
            near_or_zero(section + ": cantilever force [MN/m]" + along,
                         here.at("largest cantilever force [MN/m]"),
                         d == 2 ? 15. : 0.);
            near_or_zero(section + ": cantilever shear [MN/m]" + along,
                         here.at("largest cantilever shear [MN/m]"),
                         0.);
          }
      }


      // 1, 2, 3 MPa in the planes xy, yz, zx; the arch runs along -x
      void
      shear(const double modulus)
      {
        const auto here =
          in_section([&](const Point<3> &x) {
            return 1e6 / modulus * Tensor<1, 3>({x[1], 2. * x[2], 3. * x[0]});
          }).at("line");
        near_or_zero("arch shear [MN/m]",
                     here.at("largest arch shear [MN/m]"),
                     -10.);
        near_or_zero("cantilever shear [MN/m]",
                     here.at("largest cantilever shear [MN/m]"),
                     20.);
        near_or_zero("tangential shear [MN/m]",
                     here.at("largest tangential shear [MN/m]"),
                     -30.);
      }


      // 15 MN/m along x or z, 2 m upstream of the middle: besides the mean of
      // 1.5 MPa a stress c xi with c T^3/12 = 30 MNm/m
      void
      bend(const unsigned int d)
      {
        const double c     = 30e6 * 12. / 1000.;
        const Field  field = [&](const Point<3> &x) {
          const unsigned int other = 2 - d;
          const double       xi    = x[1] - 5.;
          Tensor<1, 3>       u     = stretched(x, d);
          u[d] += c / young * x[d] * xi;
          u[other] -= nu * c / young * xi * x[other];
          u[1] -= 0.5 * c / young *
                  (x[d] * x[d] + nu * (xi * xi - x[other] * x[other]));
          return u;
        };
        const std::string part  = d == 0 ? "arch" : "cantilever";
        const auto        faces = on_faces(field);
        near_or_zero(part + " stress upstream [MPa]",
                     faces.at("largest " + part + " stress [MPa]"),
                     1.5 + 1e-6 * 5. * c);
        near_or_zero(part + " stress downstream [MPa]",
                     faces.at("smallest " + part + " stress [MPa]"),
                     1.5 - 1e-6 * 5. * c);
        const auto here = in_section(field).at("line");
        near_or_zero(part + (d == 0 ? " thrust" : " force") +
                       " of an eccentric pull [MN/m]",
                     here.at("largest " + part +
                             (d == 0 ? " thrust" : " force") + " [MN/m]"),
                     15.);
        near_or_zero(part + " moment: pull times eccentricity [MNm/m]",
                     here.at("largest " + part + " moment [MNm/m]"),
                     30.);
      }


      void
      near_or_zero(const std::string &name,
                   const double       value,
                   const double       reference)
      {
        if (reference == 0.)
          verdict->below(name, value, 1e-8);
        else
          verdict->near(name, value, reference, 1e-8);
      }

      bool              bending = false;
      Verdicts         *verdict = nullptr;
      const Simulation *model   = nullptr;
      double            young = 0., nu = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<OutputStresses>
      registered("output stresses",
                 "Face stresses and section forces of known stress fields.");


    /** The stresses in the static state of a body: loads and the
     *  static factor of the material, or a change of temperature. */
    class StressesAtRest : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Vertical stress", stress, "Expected [MPa].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        const auto faces      = observed("face stresses",
                                    {{"Face sets", "front, back"}},
                                    *simulation,
                                    {simulation->run.state});
        for (const std::string which : {"largest", "smallest"})
          verdicts.near(which + " cantilever stress [MPa]",
                        faces.at(which + " cantilever stress [MPa]"),
                        stress,
                        1e-6);
        const auto forces = observed("section forces",
                                     {{"Sections", "line: 3.7 5.3"},
                                      {"Upstream", "back"},
                                      {"Downstream", "front"}},
                                     *simulation,
                                     {simulation->run.state});
        verdicts.near("cantilever force over the thickness [MPa]",
                      forces.at("line")
                          .at("largest cantilever force [MN/m]")
                          .get<double>() /
                        forces.at("line").at("thickness [m]").get<double>(),
                      stress,
                      1e-6);
      }

    private:
      double stress = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<StressesAtRest>
      registered_at_rest("stresses at rest",
                         "Face stresses and section forces of static stages.");
  } // namespace
} // namespace Voussoir
