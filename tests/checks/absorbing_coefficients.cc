#include <numeric>

#include "check.h"
#include "reflected_shares.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Spring times distance [Pa] and dashpot [Pa s/m] per area. */
    struct Published
    {
      double normal_spring, tangential_spring, normal_dashpot,
        tangential_dashpot;
    };


    /** The published sets, of rock with these constants. */
    std::map<std::string, Published>
    published(const double E, const double nu, const double rho)
    {
      const double G      = E / (2. * (1. + nu));
      const double M      = E * (1. - nu) / ((1. + nu) * (1. - 2. * nu));
      const double normal = std::sqrt(rho * M), // rho c
        tangential        = std::sqrt(rho * G);
      const double A = 0.8, B = 1.1; // Du and Zhao
      return {{"paper", {E / 2., G / 2., normal, tangential}},
              {"Liu 3D", {4. / 3. * G, 2. / 3. * G, normal, tangential}},
              {"Liu 2D", {G, 0.5 * G, normal, tangential}},
              {"Deeks-Randolph", {G, 0.5 * G, normal, tangential}},
              {"Du-Zhao",
               {M / (1. + A), G / (1. + A), B * normal, B * tangential}}};
    }


    /** Springs and dashpots at the nodes of a box, with areas and distances of
     *  its nodes calculated by hand. */
    class BoundaryCoefficients : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        for (const auto &[name, set] : published(5e9, 0.3, 2500.))
          for (const double radius : {0., 70.})
            compare(name, set, radius, file, communicator, verdicts);
        Published viscous     = published(5e9, 0.3, 2500.).at("paper");
        viscous.normal_spring = viscous.tangential_spring = 0.;
        for (const std::string set : {"Liu 3D", "Du-Zhao"})
          compare(set,
                  viscous,
                  0.,
                  file.with({"Boundaries/Absorbing type=viscous"}),
                  communicator,
                  verdicts,
                  ", viscous");
      }

    private:
      using Matrix = SymmetricTensor<2, 3>;

      // the box of the case, its free surface above
      static inline const Point<3> upper{20., 30., 40.}, source{8., 18., 40.};
      static inline const std::array<unsigned int, 3> cells{{2, 3, 4}};


      /** Area of a face across direction @p d that a node has. */
      static double
      area_at(const Point<3> &x, const unsigned int d)
      {
        double area = 1.;
        for (unsigned int e = 0; e < 3; ++e)
          if (e != d)
            area *= upper[e] / cells[e] *
                    (x[e] < 1e-9 || x[e] > upper[e] - 1e-9 ? 0.5 : 1.);
        return area;
      }


      static std::pair<Matrix, Matrix>
      expected_at(const Point<3> &x, const Published &set, const double radius)
      {
        const double r = radius > 0. ? radius : (x - source).norm();
        Matrix       spring, dashpot;
        for (unsigned int d = 0; d < 3; ++d)
          for (const double side : {0., upper[d]})
            if (std::abs(x[d] - side) < 1e-9 && !(d == 2 && side > 0.))
              for (unsigned int e = 0; e < 3; ++e)
                {
                  const double area = area_at(x, d);
                  spring[e][e] +=
                    area / r *
                    (e == d ? set.normal_spring : set.tangential_spring);
                  dashpot[e][e] += area * (e == d ? set.normal_dashpot :
                                                    set.tangential_dashpot);
                }
        return {spring, dashpot};
      }


      static void
      compare(const std::string   &name,
              const Published     &set,
              const double         radius,
              const ParameterFile &file,
              const MPI_Comm       communicator,
              Verdicts            &verdicts,
              const std::string   &type = "")
      {
        const auto parameters =
          make_case(file.with({"Boundaries/Coefficients=" + name,
                               "Boundaries/Radius=" + std::to_string(radius)}));
        const auto simulation = make_simulation(*parameters, communicator);
        const NodalTerms     &terms = simulation->model.terms;
        const Discretization &discretization =
          simulation->model.solid.discretization;

        double of_springs = 0., of_dashpots = 0., spring = 0., dashpot = 0.;
        for (unsigned int node = 0; node < discretization.n_owned_nodes();
             ++node)
          {
            const auto [k, c] =
              expected_at(discretization.node_positions[node], set, radius);
            const auto slot = terms.slot_at(node);
            keep_largest(spring, k.norm());
            keep_largest(dashpot, c.norm());
            keep_largest(of_springs,
                         ((slot ? terms.springs[*slot] : Matrix()) - k).norm());
            keep_largest(
              of_dashpots,
              ((slot ? terms.dashpots[*slot] : Matrix()) - c).norm());
          }
        const std::string where =
          name + type + (radius > 0. ? ", given radius" : "");
        verdicts.below(where + ": springs",
                       spring > 0. ? of_springs / spring : of_springs,
                       1e-12);
        verdicts.below(where + ": dashpots", of_dashpots / dashpot, 1e-12);
      }
    };

    // Reference: published
    const Registry<Check>::Add<BoundaryCoefficients>
      registered("boundary coefficients", "The published sets.");


    /**
     * A P pulse runs down a column and meets a spring k and a dashpot b rho c
     * per area:
     *   |R|^2 = ((1-b)^2 x^2 + 1) / ((1+b)^2 x^2 + 1) ,  x = w rho c / k ,
     * which is small where k r is large for the wave.
     */
    class Absorption : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Frequencies",
                          frequencies,
                          "Frequencies of the comparison [Hz].");
        prm.add_parameter("Tolerance", tolerance, "On |R| itself.");
        prm.add_parameter("Largest", largest, "Upper bound of |R|.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   sets = published(5e9, 0.25, 2000.);
        const double r    = std::stod(file.given("Boundaries/Radius"));
        for (const std::string name : {"Liu 2D", "Deeks-Randolph", "Du-Zhao"})
          {
            const Published &set   = sets.at(name);
            const double     rho_c = sets.at("paper").normal_dashpot;
            const double     b     = set.normal_dashpot / rho_c;
            for (const auto &[f, R] :
                 reflections(file.with({"Boundaries/Coefficients=" + name}),
                             rho_c / 2000.,
                             communicator))
              {
                const double x =
                  2. * numbers::PI * f * rho_c * r / set.normal_spring;
                std::ostringstream text;
                text << name << ", " << f << " Hz: |R|";
                const double expected =
                  std::hypot((1. - b) * x, 1.) / std::hypot((1. + b) * x, 1.);
                verdicts.near(text.str(), R, expected, tolerance / expected);
                verdicts.below(text.str(), R, largest);
              }
          }
      }

    private:
      std::map<double, double>
      reflections(const ParameterFile &file,
                  const double         c,
                  const MPI_Comm       communicator) const
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const double height     = -simulation->model.boundary.extent().first[2];
        const auto   histories =
          run_and_record(*simulation,
                         {{"middle", Point<3>(0., 0., -0.5 * height)}});

        // velocities, which decay faster than displacements
        auto v = histories.component(0, 2);
        std::adjacent_difference(v.begin(), v.end(), v.begin());
        return reflected_shares(histories.times, v, frequencies, height / c);
      }

      std::vector<double> frequencies{2., 4.};
      double              tolerance = 0.01, largest = 0.1;
    };

    // Reference: closed form
    const Registry<Check>::Add<Absorption>
      registered_absorption("absorption", "Of a P pulse by the other sets.");
  } // namespace
} // namespace Voussoir
