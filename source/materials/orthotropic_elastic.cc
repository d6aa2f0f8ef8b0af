// Rock with one or more sets of joints, taken as a continuum.

#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/materials/material_of.h>
#include <voussoir/materials/spectral.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * Hooke's law with three planes of symmetry. Axis 1 is the strike of the
     * joints (or layers), 2 points down their dip and 3 is normal to them; the
     * compliances are 1 / E_i, -nu_ij / E_i and 1 / G_ij.
     */
    struct OrthotropicElastic : LawDefaults
    {
      static constexpr bool isotropic = false;

      Tensor<1, 3> young{{15e9, 15e9, 6e9}};     // E1, E2, E3 [Pa]
      Tensor<1, 3> shear{{6e9, 2.5e9, 2.5e9}};   // G12, G13, G23 [Pa]
      Tensor<1, 3> poisson{{0.2, 0.2, 0.2}};     // nu12, nu13, nu23
      double       dip_direction = 0., dip = 0.; // [degrees]

      // equivalent for boundaries
      double young_modulus = 0., poisson_ratio = 0.;

      // stress of a unit of each component of strain
      std::array<SymmetricTensor3<double>, 6> stiffness;

      void
      declare_parameters(ParameterHandler &prm)
      {
        const std::array<std::string, 3> single{{"1", "2", "3"}},
          pairs{{"12", "13", "23"}};
        const auto text = [](const std::string &axes) {
          return axes.size() == 1 ? axes :
                                    axes.substr(0, 1) + " and " + axes[1];
        };
        for (unsigned int i = 0; i < 3; ++i)
          prm.add_parameter("E" + single[i],
                            young[i],
                            "Young's modulus along axis " + single[i] +
                              " [Pa]; axis 1 is the strike of the joints, 2 "
                              "points down their dip, 3 is normal to them." +
                              usually(Usual::modulus),
                            Patterns::Double(1.));
        for (unsigned int i = 0; i < 3; ++i)
          prm.add_parameter("G" + pairs[i],
                            shear[i],
                            "Shear modulus between the axes " + text(pairs[i]) +
                              " [Pa]." + usually(Usual::modulus),
                            Patterns::Double(1.));
        for (unsigned int i = 0; i < 3; ++i)
          prm.add_parameter("nu" + pairs[i],
                            poisson[i],
                            "Shortening along axis " + pairs[i].substr(1) +
                              " over the extension along axis " +
                              pairs[i].substr(0, 1) +
                              " under a stress along the latter.",
                            Patterns::Double(-1., 10.));
        prm.add_parameter(
          "Dip direction",
          dip_direction,
          "Dip direction of the joints, from the y axis towards the x axis "
          "[degrees]: a compass with y to the north.",
          Patterns::Double(-360., 360.));
        prm.add_parameter("Dip",
                          dip,
                          "Angle of the joints with the horizontal [degrees].",
                          Patterns::Double(0., 90.));
      }

      void
      check(const std::string &place)
      {
        Tensor<2, 3> compliance; // of the normal components
        for (unsigned int i = 0; i < 3; ++i)
          compliance[i][i] = 1. / young[i];
        compliance[0][1] = compliance[1][0] = -poisson[0] / young[0];
        compliance[0][2] = compliance[2][0] = -poisson[1] / young[0];
        compliance[1][2] = compliance[2][1] = -poisson[2] / young[1];
        if (compliance[0][0] * compliance[1][1] <=
              compliance[0][1] * compliance[0][1] ||
            determinant(compliance) * young[0] * young[1] * young[2] < 1e-10)
          throw UserError(place +
                          ": with these constants some strains would have a "
                          "negative energy; lower the Poisson's ratios, each "
                          "\"nu_ij\" to below the root of E_i / E_j, and "
                          "further if two or three of them are high.");
        find_stiffness(invert(compliance));
        find_equivalent();
      }

      template <typename Number>
      SymmetricTensor3<Number>
      stress(const SymmetricTensor3<Number> &strain) const
      {
        SymmetricTensor3<Number> result;
        for (unsigned int i = 0; i < 6; ++i)
          for (unsigned int j = 0; j < 6; ++j)
            result.access_raw_entry(i) +=
              stiffness[j].access_raw_entry(i) * strain.access_raw_entry(j);
        return result;
      }

    private:
      void
      find_stiffness(const Tensor<2, 3> &normal)
      {
        const double b = dip_direction * numbers::PI / 180.,
                     d = dip * numbers::PI / 180.;
        const Tensor<1, 3> down{
          {std::sin(b) * std::cos(d), std::cos(b) * std::cos(d), -std::sin(d)}};
        const Tensor<1, 3> up{
          {std::sin(b) * std::sin(d), std::cos(b) * std::sin(d), std::cos(d)}};
        const std::array<Tensor<1, 3>, 3> axes{
          {cross_product_3d(down, up), down, up}};

        const unsigned int of_pair[3][3] = {{0, 0, 1}, {0, 0, 2}, {1, 2, 0}};
        for (unsigned int component = 0; component < 6; ++component)
          {
            SymmetricTensor3<double> unit;
            unit.access_raw_entry(component) = 1.;
            stiffness[component]             = SymmetricTensor3<double>();
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                {
                  // stress of the plane (i, j) of the joints' axes
                  double value = 0.;
                  if (i == j)
                    for (unsigned int k = 0; k < 3; ++k)
                      value += normal[i][k] * (axes[k] * (unit * axes[k]));
                  else
                    value =
                      2. * shear[of_pair[i][j]] * (axes[i] * (unit * axes[j]));
                  stiffness[component] +=
                    value * symmetrize(outer_product(axes[i], axes[j]));
                }
          }
      }

      /** Largest x . (C : (d x)) of all unit vectors x, and its direction x. */
      std::pair<double, Tensor<1, 3>>
      stiffest(const Tensor<1, 3> &direction) const
      {
        SymmetricTensor3<double> acoustic;
        for (unsigned int k = 0; k < 3; ++k)
          {
            Tensor<1, 3> unit;
            unit[k] = 1.;
            const Tensor<1, 3> traction =
              stress(symmetrize(outer_product(direction, unit))) * direction;
            for (unsigned int i = k; i < 3; ++i)
              acoustic[i][k] = traction[i];
          }
        const auto         principal = spectrum(acoustic);
        const unsigned int largest =
          std::max_element(principal.values.begin(), principal.values.end()) -
          principal.values.begin();
        return {principal.values[largest], principal.directions[largest]};
      }

      /**
       * Equivalent constants: the shear modulus of Voigt's mean, and the P-wave
       * speed of the fastest wave of all directions. Direction and polarisation
       * of that wave can be exchanged without changing its speed, so that each
       * is optimised for the other in turn.
       */
      void
      find_equivalent()
      {
        double p_modulus = 0.;
        for (int x = -1; x <= 1; ++x)
          for (int y = -1; y <= 1; ++y)
            for (int z = 0; z <= 1; ++z)
              {
                Tensor<1, 3> direction{{x + 0.01, y + 0.02, z + 0.03}};
                direction /= direction.norm();
                for (unsigned int turn = 0; turn < 200; ++turn)
                  {
                    const auto [value, polarisation] = stiffest(direction);
                    p_modulus = std::max(p_modulus, value);
                    direction = polarisation;
                  }
              }

        double mean_shear = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < i; ++j)
            {
              SymmetricTensor3<double> unit, normal_i, normal_j;
              unit[i][j]     = 0.5;
              normal_i[i][i] = normal_j[j][j] = 1.;
              mean_shear +=
                (3. * (stress(unit)[i][j]) +
                 0.5 * (stress(normal_i)[i][i] + stress(normal_j)[j][j]) -
                 stress(normal_i)[j][j]) /
                15.;
            }
        poisson_ratio = std::max(0.,
                                 0.5 * (p_modulus - 2. * mean_shear) /
                                   (p_modulus - mean_shear));
        young_modulus = p_modulus * (1. + poisson_ratio) *
                        (1. - 2. * poisson_ratio) / (1. - poisson_ratio);
      }
    };

    const Registry<Material>::Add<MaterialOf<OrthotropicElastic>>
      registered_orthotropic_elastic(
        "orthotropic elastic",
        "Hooke's law with three axes, for jointed or layered rock.");
  } // namespace
} // namespace Voussoir
