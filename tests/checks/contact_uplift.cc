#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A block on a base with water in the joint under it, from a heel at x = 0
     * to a toe: head linear between them, or with drains between. The uplift
     * reduces the pressure of contact, while the base still carries all of the
     * weight.
     */
    class Uplift : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Length", length, "From heel to toe [m].");
        prm.add_parameter("Width", width, "Width of the block [m].");
        prm.add_parameter("Weight", weight, "Weight of the block [N].");
        prm.add_parameter("Heads", heads, "Heel, toe [m].");
        prm.add_parameter("Drains", drains, "Position, factor.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto mean = [](const double a, const double b) {
          return 0.5 * (a + b);
        };
        const double specific = 1000. * 9.81, area = length * width;

        const double linear = specific * mean(heads[0], heads[1]) * area;
        compare("linear: ",
                file.with(
                  {drain_entry("position", 0.), drain_entry("factor", 1.)}),
                linear,
                linear_centre(0., heads[0], length, heads[1]),
                verdicts,
                communicator);

        // heads over the downstream one: at the heel, at the drains, none
        const double way    = drains[0] * length;
        const double at_way = heads[1] + drains[1] * (heads[0] - heads[1]);
        const double first  = mean(heads[0], at_way) * way,
                     last   = mean(at_way, heads[1]) * (length - way);
        compare("with drains: ",
                file.with({drain_entry("position", drains[0]),
                           drain_entry("factor", drains[1])}),
                specific * width * (first + last),
                (first * linear_centre(0., heads[0], way, at_way) +
                 last * linear_centre(way, at_way, length, heads[1])) /
                  (first + last),
                verdicts,
                communicator);
      }

    private:
      static std::string
      drain_entry(const std::string &name, const double value)
      {
        return "Interfaces/plane/Uplift/Drain " + name + "=" +
               std::to_string(value);
      }

      /** Where the resultant of a linear head acts. */
      static double
      linear_centre(const double begin,
                    const double at_begin,
                    const double end,
                    const double at_end)
      {
        return begin + (end - begin) / 3. * (at_begin + 2. * at_end) /
                         (at_begin + at_end);
      }

      void
      compare(const std::string   &name,
              const ParameterFile &file,
              const double         uplift,
              const double         centre,
              Verdicts            &verdicts,
              const MPI_Comm       communicator) const
      {
        const auto parameters  = make_case(file);
        const auto simulation  = make_simulation(*parameters, communicator);
        const ContactSums sums = contact_sums(*simulation, 0);
        verdicts.near(name + "resultant of the uplift [kN]",
                      1e-3 * sums.given,
                      1e-3 * uplift,
                      1e-8);
        double moment = 0.;
        for (unsigned int k = 0; k < simulation->run.contact->points().size();
             ++k)
          moment += simulation->run.contact->points()[k].given_force *
                    simulation->run.contact->positions()[k][0];
        verdicts.near(name + "its place, from the heel [m]",
                      Utilities::MPI::sum(moment, communicator) / sums.given,
                      centre,
                      0.02);
        verdicts.near(name + "resultant of the contact pressure [kN]",
                      1e-3 * sums.pressure,
                      1e-3 * (weight - uplift),
                      1e-8);
        verdicts.near(name + "force of the joint on the block [kN]",
                      1e-3 * (sums.force[2] + sums.given),
                      1e-3 * weight,
                      1e-8);
      }

      double length = 1., width = 1., weight = 1.;

      Tensor<1, 2> heads{{1., 0.}}, drains{{0.25, 0.5}};
    };

    /** A lift joint of a section whose faces lean: the head is linear along
     *  the joint. */
    class UpliftOfSection : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Head", head, "At the upstream end [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto parameters  = make_case(file);
        const auto simulation  = make_simulation(*parameters, communicator);
        const ContactSums sums = contact_sums(*simulation, 0);
        verdicts.near("resultant of the uplift [MN]",
                      1e-6 * sums.given,
                      1e-6 * 0.5 * 1000. * 9.81 * head * sums.area,
                      1e-6);
      }

    private:
      double head = 1.;
    };

    /**
     * A block that the water in its joint lifts, unless the water on its top
     * presses it down: the uplift must not act before the reservoir.
     */
    class UpliftByStage : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Area", area, "Area of the joint [m2].");
        prm.add_parameter("Weight", weight, "Weight of the block [N].");
        prm.add_parameter("Heads", heads, "On the top, in the joint [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto with = [&](const std::string &load) {
          return file.with({"Interfaces/plane/Uplift/Comes with=" + load});
        };
        verdicts.is_true("it floats if the uplift comes with its weight",
                         !stands(with("weight"), communicator));
        for (const std::string load : {"", "reservoir"})
          {
            const auto parameters  = make_case(with(load));
            const auto simulation  = make_simulation(*parameters, communicator);
            const ContactSums sums = contact_sums(*simulation, 0);
            const std::string name =
              load.empty() ? "by default: " : "with the reservoir: ";
            const double specific = 1000. * 9.81 * area;
            verdicts.near(name + "resultant of the uplift [kN]",
                          1e-3 * sums.given,
                          1e-3 * specific * heads[1],
                          1e-8);
            verdicts.near(name + "resultant of the contact pressure [kN]",
                          1e-3 * sums.pressure,
                          1e-3 * (weight + specific * (heads[0] - heads[1])),
                          1e-8);
          }
      }

    private:
      double       area = 1., weight = 1.;
      Tensor<1, 2> heads;
    };

    // Reference: closed form
    const Registry<Check>::Add<UpliftByStage>
      registered_by_stage("contact uplift by stage",
                          "Uplift that comes with the reservoir.");

    // Reference: closed form
    const Registry<Check>::Add<UpliftOfSection>
      registered_of_section("contact uplift of a section",
                            "Uplift between faces that lean.");

    // Reference: closed form
    const Registry<Check>::Add<Uplift>
      registered("contact uplift", "Water pressure under a block.");
  } // namespace
} // namespace Voussoir
