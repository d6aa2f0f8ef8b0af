#include <voussoir/base/time_factor.h>
#include <voussoir/loads/load.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    class SurfaceLoad : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Face sets", face_sets, "Face sets it acts on.");
        prm.add_parameter("Traction",
                          traction,
                          "Force per area, x, y, z [Pa].");
        prm.add_parameter("Pressure",
                          pressure,
                          "Pressure against the surface [Pa].");
        factor.declare(prm, "Time function", "Factor on the load.");
      }

      void
      prepare(const Discretization &discretization,
              NodalTerms           &terms,
              const ParameterFile &,
              const std::string &place) override
      {
        factor.prepare("\"Time function\" in section \"" + place + "\"");
        const auto     &scalar = discretization.fe.base_element(0);
        FEFaceValues<3> values(discretization.mapping,
                               scalar,
                               QGauss<2>(discretization.degree + 1),
                               update_values | update_normal_vectors |
                                 update_JxW_values);

        struct Force
        {
          double components[3];
        };
        std::vector<std::pair<types::global_dof_index, Force>> forces;
        const auto sets = split_list(face_sets);
        if (sets.empty())
          throw UserError("\"Face sets\" in section \"" + place +
                          "\" is empty; name the face sets it acts on.");
        for (const std::string &set : sets)
          {
            discretization.grid.check_face_set(set,
                                               "\"Face sets\" in section \"" +
                                                 place + "\"");
            discretization.grid.for_each_face(
              set, [&](const auto &cell, const unsigned int face) {
                values.reinit(cell, face);
                const auto nodes =
                  discretization.cell_nodes(discretization.dof_cell(cell));
                for (unsigned int j = 0; j < nodes.size(); ++j)
                  if (scalar.has_support_on_face(j, face))
                    {
                      Tensor<1, 3> sum;
                      for (const unsigned int q :
                           values.quadrature_point_indices())
                        sum += values.shape_value(j, q) * values.JxW(q) *
                               (traction - pressure * values.normal_vector(q));
                      for (const auto &share :
                           discretization.carriers(nodes[j]))
                        forces.push_back({share.node,
                                          {{share.weight * sum[0],
                                            share.weight * sum[1],
                                            share.weight * sum[2]}}});
                    }
              });
          }
        for (const auto &[node, force] : discretization.send_to_owners(forces))
          shares.emplace_back(terms.add_node(node),
                              Tensor<1, 3>(force.components));
      }

      void
      add_forces(const double time, NodalTerms &terms) const override
      {
        const double now = factor(time);
        for (const auto &[slot, force] : shares)
          terms.forces[slot] += now * force;
      }

    private:
      std::string  face_sets;
      Tensor<1, 3> traction;
      double       pressure = 0.;
      TimeFactor   factor;

      std::vector<std::pair<unsigned int, Tensor<1, 3>>> shares;
    };

    const Registry<Load>::Add<SurfaceLoad>
      registered("surface load", "A traction or pressure on faces, over time.");
  } // namespace
} // namespace Voussoir
