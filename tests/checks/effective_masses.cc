#include <deal.II/lac/lapack_full_matrix.h>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** All natural modes of a small model of one rank, by LAPACK. */
    class AllModes
    {
    public:
      explicit AllModes(const Simulation &simulation)
      {
        const Vector &inverse = simulation.model.solid.mass.inverse;
        for (unsigned int i = 0; i < inverse.locally_owned_size(); ++i)
          if (inverse.local_element(i) > 0.)
            free.push_back(i);
        LAPACKFullMatrix<double> stiffness = stiffness_of(simulation);
        mass                               = mass_of(simulation);
        LAPACKFullMatrix<double> copy      = mass;
        shapes.resize(free.size());
        stiffness.compute_generalized_eigenvalues_symmetric(copy, shapes);
        for (unsigned int j = 0; j < free.size(); ++j)
          frequencies.push_back(std::sqrt(stiffness.eigenvalue(j).real()) /
                                (2. * numbers::PI));
      }

      /** phi^T M r / sqrt(phi^T M phi), squared. */
      double
      effective_mass(const unsigned int mode, const unsigned int d) const
      {
        dealii::Vector<double> momentum(free.size());
        mass.vmult(momentum, rigid_motion(d));
        const auto            &shape = shapes[mode];
        dealii::Vector<double> product(free.size());
        mass.vmult(product, shape);
        return std::pow(shape * momentum, 2) / (shape * product);
      }

      /** r^T M r. */
      double
      moving_mass(const unsigned int d) const
      {
        dealii::Vector<double> momentum(free.size());
        mass.vmult(momentum, rigid_motion(d));
        return rigid_motion(d) * momentum;
      }

      std::vector<double> frequencies; // [Hz]

    private:
      dealii::Vector<double>
      rigid_motion(const unsigned int d) const
      {
        dealii::Vector<double> motion(free.size());
        for (unsigned int i = 0; i < free.size(); ++i)
          motion[i] = free[i] % 3 == d ? 1. : 0.;
        return motion;
      }

      LAPACKFullMatrix<double>
      stiffness_of(const Simulation &simulation) const
      {
        LAPACKFullMatrix<double> matrix(free.size());
        Vector u = simulation.model.solid.discretization.create_vector(),
               force(u);
        for (unsigned int j = 0; j < free.size(); ++j)
          {
            u                        = 0.;
            u.local_element(free[j]) = 1.;
            simulation.model.solid.internal_force.apply(force, u);
            for (unsigned int i = 0; i < free.size(); ++i)
              matrix(i, j) = force.local_element(free[i]);
          }
        return matrix;
      }

      LAPACKFullMatrix<double>
      mass_of(const Simulation &simulation) const
      {
        LAPACKFullMatrix<double> matrix(free.size());
        const NodalTerms        &terms = simulation.model.terms;
        for (unsigned int i = 0; i < free.size(); ++i)
          {
            matrix(i, i) =
              simulation.model.solid.mass.mass.local_element(free[i]);
            if (const auto slot = terms.slot_at(free[i] / 3))
              for (unsigned int j = 0; j < free.size(); ++j)
                if (free[j] / 3 == free[i] / 3)
                  matrix(i, j) +=
                    terms.added_mass[*slot][free[i] % 3][free[j] % 3];
          }
        return matrix;
      }

      std::vector<unsigned int>           free; // unknowns that are not fixed
      LAPACKFullMatrix<double>            mass;
      std::vector<dealii::Vector<double>> shapes;
    };


    /**
     * Effective masses, of structure and water that move together, against
     * those of all modes, which add up to the mass that moves.
     */
    class EffectiveMasses : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Moving mass", moving_mass, "By hand [kg].");
        prm.add_parameter("Modes to all",
                          modes_to_all,
                          "Number of modes that have all of the mass; 0 if "
                          "the computed ones have less.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto     parameters = make_case(file);
        const auto     simulation = make_simulation(*parameters, communicator);
        const AllModes all(*simulation);
        const auto     summary = simulation->modes.summary();
        const auto    &list    = summary.at("modes");

        double difference = 0.;
        for (unsigned int j = 0; j < list.size(); ++j)
          keep_largest(difference,
                       std::abs(list[j].at("frequency [Hz]").get<double>() /
                                  all.frequencies[j] -
                                1.));
        verdicts.below("frequencies against LAPACK", difference, 1e-9);
        for (unsigned int d = 0; d < 3; ++d)
          if (moving_mass[d] > 0.)
            compare(summary, all, d, verdicts);
          else
            verdicts.below(std::string(1, "xyz"[d]) + ": mass that moves",
                           summary.at("moving mass [kg]")[d],
                           1e-12);
      }

    private:
      void
      compare(const nlohmann::json &summary,
              const AllModes       &all,
              const unsigned int    d,
              Verdicts             &verdicts) const
      {
        const std::string name(1, "xyz"[d]);
        verdicts.near(name + ": mass that moves, water included",
                      summary.at("moving mass [kg]")[d],
                      moving_mass[d],
                      1e-12,
                      "kg");
        double sum = 0., last = 0., smallest_step = 1., largest = 0.,
               difference = 0.;
        const auto &list  = summary.at("modes");
        for (unsigned int j = 0; j < all.frequencies.size(); ++j)
          {
            sum += all.effective_mass(j, d) / all.moving_mass(d);
            if (j >= list.size())
              continue;
            const double now = list[j].at("cumulative effective mass [-]")[d];
            keep_smallest(smallest_step, now - last);
            keep_largest(largest, now);
            last = now;
            // modes of the same frequency may share their effective mass
            // differently
            if (all.frequencies[j + 1] > (1. + 1e-6) * all.frequencies[j])
              keep_largest(difference, std::abs(now - sum));
            if (j + 1 == modes_to_all)
              verdicts.near(name + ": share of these modes", now, 1., 1e-9);
          }
        verdicts.is_true(name + ": the sum over the modes never falls",
                         smallest_step >= 0.);
        verdicts.below(name + ": the sum over the modes", largest, 1. + 1e-9);
        verdicts.below(name + ": sums against LAPACK", difference, 1e-6);
        verdicts.near(name + ": sum over all modes of LAPACK", sum, 1., 1e-9);
      }

      std::vector<double> moving_mass{0., 0., 0.};
      unsigned int        modes_to_all = 0;
    };

    // Reference: closed form
    const Registry<Check>::Add<EffectiveMasses>
      registered("effective masses", "Of nearly all modes, with added mass.");


    /**
     * A rod of n cells that moves along its axis is a chain: masses m, m/2 at
     * its free end, and springs. Mode j has the shape sin(i a), a = (2j-1)
     * pi/2n, with omega = 2 c/h sin(a/2), effective mass cot^2(a/2)/(2n) m of
     * (n - 1/2) m that move; 8/pi^2 of n m for the first one of many cells.
     */
    class Chain : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cells", n, "Along the rod.");
        prm.add_parameter("Length", length, "[m]");
        prm.add_parameter("Tolerance", tolerance, "Against a continuous rod.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto   parameters = make_case(file);
        const auto   simulation = make_simulation(*parameters, communicator);
        const Modes &modes      = simulation->modes;
        const double c          = simulation->model.solid.materials[0]
                           ->elastic_constants()
                           .p_wave_speed();

        double of_frequency = 0., of_mass = 0.;
        for (unsigned int j = 0;
             j < std::min<std::size_t>(modes.list.size(), n);
             ++j)
          {
            const double half  = (j + 0.5) * numbers::PI / (2. * n);
            const double omega = 2. * c * n / length * std::sin(half);
            const double share =
              std::pow(std::tan(half), -2) / (2. * n * (n - 0.5));
            keep_largest(of_frequency,
                         std::abs(2. * numbers::PI * modes.list[j].frequency /
                                    omega -
                                  1.));
            keep_largest(of_mass,
                         std::abs(modes.list[j].effective_mass[2] /
                                    modes.moving_mass[2] -
                                  share));
          }
        verdicts.below("frequencies against the chain's", of_frequency, 1e-9);
        verdicts.below("effective masses against the chain's", of_mass, 1e-6);
        verdicts.near("first effective mass over that of the rod, 8/pi^2",
                      modes.list[0].effective_mass[2] /
                        simulation->model.solid.mass.total[0],
                      8. / (numbers::PI * numbers::PI),
                      tolerance);
      }

    private:
      unsigned int n         = 1;
      double       length    = 1.;
      double       tolerance = 0.01;
    };

    // Reference: closed form
    const Registry<Check>::Add<Chain> registered_chain("modes of a chain",
                                                       "A rod of few cells.");
  } // namespace
} // namespace Voussoir
