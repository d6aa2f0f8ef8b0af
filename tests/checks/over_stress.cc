#include "csv_table.h"
#include "observed.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Times and areas above the strength, for given stresses over time along
     *  the front of a block. */
    class OverStress : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters = make_case(file);
        const auto simulation = make_simulation(*parameters, communicator);
        verdict               = &verdicts;
        model                 = simulation.get();
        young =
          model->model.solid.materials[0]->elastic_constants().young_modulus;
        step = model->run.time_step.length;
        for (const std::string stress : {"principal", "arch and cantilever"})
          sine(stress);
        two_moments();
        at_rest();
        limits();
      }

    private:
      static constexpr double strength = 2e6;             // [Pa]
      static constexpr double length = 40., height = 20.; // of the front

      /** @p stress along x [Pa] at a height [m] and a time [s], over a number
       *  of steps; Poisson's ratio is 0. */
      nlohmann::json
      found(const std::function<double(const double, const double)> &stress,
            const unsigned int                                       n_steps,
            const std::string &which) const
      {
        std::vector<State> states;
        const auto        &positions =
          model->model.solid.discretization.node_positions;
        for (unsigned int n = 0; n <= n_steps; ++n)
          {
            states.push_back(model->run.state);
            states.back().step         = n;
            states.back().time         = n * step;
            states.back().displacement = 0.;
            for (unsigned int node = 0; node < positions.size(); ++node)
              states.back().displacement.local_element(3 * node) =
                stress(positions[node][2], n * step) / young *
                positions[node][0];
          }
        return observed("over-stress",
                        {{"Face sets", "front, back"},
                         {"Stress", which},
                         {"Tensile strength", "2e6, 8e6"}},
                        *model,
                        states)
          .at("front");
      }

      // s sin(w t) over n periods T is above r f for n T (1/2 - asin(r f/s)/pi)
      void
      sine(const std::string &which) const
      {
        constexpr double       amplitude = 3.5e6;
        constexpr unsigned int periods = 2, steps = 2000;
        const double           period = steps * step / periods;
        const auto             front  = found(
          [&](const double, const double t) {
            return amplitude * std::sin(2. * numbers::PI * t / period);
          },
          steps,
          which);
        const std::string of = ", " + which + " stress";
        verdict->near("largest ratio" + of,
                      front.at("largest ratio"),
                      amplitude / strength,
                      1e-5);
        verdict->near("at the time, in periods" + of,
                      front.at("at the time [s]").get<double>() / period,
                      0.25,
                      1e-6);
        for (const std::string ratio : {"1", "1.3", "1.7"})
          {
            const auto  &above = front.at("above " + ratio);
            const double closed =
              periods *
              (0.5 - std::asin(std::stod(ratio) * strength / amplitude) /
                       numbers::PI);
            // each time above is known to a step
            verdict->near("time above ratio " + ratio + ", in periods" + of,
                          above.at("accumulated time [s]").get<double>() /
                            period,
                          closed,
                          periods * step / period / closed);
            verdict->near("share of the front above ratio " + ratio + " [%]" +
                            of,
                          above.at("share at any time [%]"),
                          100.,
                          1e-12);
          }
        verdict->below("time above ratio 1.8 [s]" + of,
                       front.at("above 1.8").at("accumulated time [s]"),
                       1e-12);
      }

      // c z first, then c (H - z): a part of the front each, together twice
      // that
      void
      two_moments() const
      {
        constexpr double c     = 1.75 * strength / height;
        const auto       front = found(
          [&](const double z, const double t) {
            return c * (t < 1.5 * step ? z : height - z);
          },
          2,
          "arch and cantilever");
        verdict->near("height of the largest ratio at rest [m]",
                      front.at("place of the largest ratio at rest [m]").at(2),
                      height,
                      1e-10);
        for (const std::string ratio : {"1", "1.5"})
          {
            const auto  &above = front.at("above " + ratio);
            const double part =
              length * (height - std::stod(ratio) * strength / c);
            verdict->near("area at once above ratio " + ratio + " [m2]",
                          above.at("largest area at once [m2]"),
                          part,
                          1e-10);
            verdict->near("area at any time above ratio " + ratio + " [m2]",
                          above.at("area at any time [m2]"),
                          std::min(2. * part, length * height),
                          1e-10);
            verdict->near("time above ratio " + ratio + " over the step",
                          above.at("accumulated time [s]").get<double>() / step,
                          1.,
                          1e-10);
          }
      }

      // 1.2 times the strength in the static state, 1.5 times it in both steps
      void
      at_rest() const
      {
        const auto front = found(
          [&](const double, const double t) {
            return (t < 0.5 * step ? 1.2 : 1.5) * strength;
          },
          2,
          "principal");
        verdict->near("largest ratio at rest",
                      front.at("largest ratio at rest"),
                      1.2,
                      1e-10);
        verdict->near(
          "time of the largest ratio at rest [s], plus 1",
          1. + front.at("time of the largest ratio at rest [s]").get<double>(),
          1.,
          1e-10);
        for (const auto &[ratio, share, beyond] :
             std::vector<std::tuple<std::string, double, double>>{
               {"1.1", 100., 0.}, {"1.3", 0., 2.}})
          {
            const auto &above = front.at("above " + ratio);
            verdict->near("share at rest above ratio " + ratio + " [%], plus 1",
                          1. + above.at("share at rest [%]").get<double>(),
                          1. + share,
                          1e-10);
            verdict->near("time above it over the step",
                          above.at("accumulated time [s]").get<double>() / step,
                          2.,
                          1e-10);
            verdict->near(
              "  of what is below at rest, plus 1",
              1. + above.at("accumulated time of what is below at rest [s]")
                       .get<double>() /
                     step,
              1. + beyond,
              1e-10);
          }
      }

      // allowed time of over_stress.csv: 0.4 s at ratio 1, 0 at ratio 2
      void
      limits() const
      {
        MPI_Barrier(model->model.grid.communicator());
        const CsvTable table("observed/over_stress.csv");
        verdict->near("allowed time above ratio 1 [s]",
                      table.numbers("allowed time [s]").at(0),
                      0.4,
                      1e-10);
        verdict->near("allowed time above ratio 1.5 [s]",
                      table.numbers("allowed time [s]").at(5),
                      0.2,
                      1e-10);
      }

      Verdicts         *verdict = nullptr;
      const Simulation *model   = nullptr;
      double            young = 0., step = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<OverStress>
      registered("over-stress",
                 "Times and areas above the strength in closed form.");
  } // namespace
} // namespace Voussoir
