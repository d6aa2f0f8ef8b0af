// Laws, keys and bars of an interface, on a thin layer that is pulled off or
// sheared against its base.

#include "contact_sums.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // stresses are means over the interface
    struct Sample
    {
      double time, pressure, shear, bars; // [s], [Pa]
      double opening, slip;               // mean [m]
    };


    struct Run
    {
      std::vector<Sample> samples;
      double              bond = 0., friction = 0., bars = 0.; // lost [J/m2]

      double
      largest_tension(const double from = 0.) const
      {
        double largest = 0.;
        for (const Sample &sample : samples)
          if (sample.time >= from)
            keep_largest(largest, -sample.pressure);
        return largest;
      }

      double
      largest_shear() const
      {
        double largest = 0.;
        for (const Sample &sample : samples)
          keep_largest(largest, sample.shear);
        return largest;
      }

      /** The sample nearest to a time. */
      const Sample &
      at(const double time) const
      {
        return *std::min_element(samples.begin(),
                                 samples.end(),
                                 [&](const Sample &a, const Sample &b) {
                                   return std::abs(a.time - time) <
                                          std::abs(b.time - time);
                                 });
      }
    };


    /** Moves the base of the layer along a direction. */
    Run
    drive(const ParameterFile                             &file,
          const Tensor<1, 3>                              &way,
          const MPI_Comm                                   communicator,
          std::vector<std::string>                         changes  = {},
          const std::function<void(const ContactPoint &)> &callback = {})
    {
      changes.push_back(vector_entry("Constraints/base/Displacement", way));
      const auto parameters = make_case(file.with(changes));
      const auto simulation = make_simulation(*parameters, communicator);
      Run        run;
      double     area = 0.;
      while (simulation->run.state.time < parameters->time.end_time)
        {
          simulation->run.scheme.step(simulation->run.state);
          const ContactSums sums = contact_sums(*simulation, 0);
          area                   = sums.area;
          const double shear =
            Tensor<1, 3>({sums.force[0], sums.force[1], 0.}).norm();
          run.samples.push_back({simulation->run.state.time,
                                 sums.pressure / area,
                                 shear / area,
                                 -sums.given / area,
                                 sums.opening,
                                 sums.slip});
          if (callback)
            for (const ContactPoint &point : simulation->run.contact->points())
              callback(point);
        }
      const ContactEnergy &lost = simulation->run.contact->surfaces()[0].energy;
      const auto           sum =
        sum_over_ranks(std::vector<double>{lost.bond, lost.friction, lost.bars},
                       communicator);
      run.bond     = sum[0] / area;
      run.friction = sum[1] / area;
      run.bars     = sum[2] / area;
      return run;
    }


    /** Base class: common part of the laws. */
    class LayerCheck : public Check
    {
    protected:
      static double
      entry(const ParameterFile &file, const std::string &name)
      {
        return std::stod(file.given("Interfaces/plane/" + name));
      }

      static Tensor<1, 3>
      opening(const double size)
      {
        return Tensor<1, 3>({0., 0., -size});
      }

      static Tensor<1, 3>
      shearing(const double size)
      {
        return Tensor<1, 3>({size, 0., 0.});
      }
    };


    /** Strengths before and after, and the energy dissipated in between. */
    class Bond : public LayerCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Opening",
                          way_apart,
                          "Displacement of the base [m].");
        prm.add_parameter("Slip", way_along, "Displacement of the base [m].");
        prm.add_parameter("Turn", turn, "Time at which it turns back [s].");
        prm.add_parameter("Pressure", pressure, "In the shear test [Pa].");
        prm.add_parameter("Modulus over height",
                          stiffness,
                          "Modulus over height of the layer [Pa/m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const Run pulled = drive(file, opening(way_apart), communicator);
        verdicts.near("pulled: tensile strength [MPa]",
                      1e-6 * pulled.largest_tension(),
                      1e-6 * entry(file, "Tensile strength"),
                      0.01);
        verdicts.near("  opening at the turn [mm]",
                      1e3 * pulled.at(turn).opening,
                      1e3 * way_apart,
                      0.01);
        verdicts.below("  tension from there on [MPa]",
                       1e-6 * pulled.largest_tension(turn),
                       0.);
        const bool softening =
          file.given("Interfaces/plane/Law") == "softening bond";
        if (softening)
          verdicts.near("  energy lost [J/m2]",
                        pulled.bond,
                        entry(file, "Fracture energy"),
                        0.01);

        const Run sheared =
          drive(file,
                shearing(way_along),
                communicator,
                {vector_entry("Constraints/top/Displacement",
                              Tensor<1, 3>({0., 0., -pressure / stiffness}))});
        verdicts.near("sheared: pressure [MPa]",
                      1e-6 * sheared.at(turn).pressure,
                      1e-6 * pressure,
                      0.001);
        verdicts.near("  strength [MPa]",
                      1e-6 * sheared.largest_shear(),
                      1e-6 * (entry(file, "Cohesion") +
                              entry(file, "Friction coefficient") * pressure),
                      0.01);
        const double residual =
          entry(file, "Residual cohesion") +
          entry(file, "Residual friction coefficient") * pressure;
        verdicts.near("  residual strength [MPa]",
                      1e-6 * sheared.at(0.95 * turn).shear,
                      1e-6 * residual,
                      0.01);
        if (softening)
          verdicts.near("  energy lost in the bond [J/m2]",
                        sheared.bond,
                        entry(file, "Shear fracture energy"),
                        0.01);
      }

    private:
      double way_apart = 0., way_along = 0., turn = 0., pressure = 0.,
             stiffness = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<Bond>
      registered_bond("contact bond", "Laws of a bond in tension and shear.");


    /** Keys prevent slip up to an opening of their depth. */
    class Keys : public LayerCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Way",
                          way,
                          "Displacement of the base, away and along [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double depth      = entry(file, "Key depth");
        double       early_slip = 0., first = 1e300;
        const Run    run =
          drive(file,
                opening(way) + shearing(way),
                communicator,
                {},
                [&](const ContactPoint &point) {
                  const double slip = std::hypot(point.gap[1], point.gap[2]);
                  if (point.history.opening < depth)
                    keep_largest(early_slip, slip);
                  else if (slip > 0.01 * way)
                    first = std::min(first, point.history.opening);
                });
        verdicts.below("slip before the opening of the depth [m]",
                       early_slip,
                       1e-12);
        verdicts.near("opening at the first slip [mm]",
                      1e3 * first,
                      1e3 * depth,
                      0.02);
        verdicts.near("slip at the end [mm]",
                      1e3 * run.samples.back().slip,
                      1e3 * way,
                      0.02);
      }

    private:
      double way = 1e-3;
    };

    // Reference: closed form
    const Registry<Check>::Add<Keys>
      registered_keys("contact keys", "Shear keys of a joint that opens.");


    /** Bars across a joint that opens and closes: elastic, perfectly plastic.
     */
    class Bars : public LayerCheck
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Way", way, "Displacement of the base [m].");
        prm.add_parameter("Modulus over height",
                          stiffness,
                          "Modulus over height of the layer [Pa/m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const double ratio = entry(file, "Steel ratio");
        const double slope =
          ratio * entry(file, "Steel modulus") / entry(file, "Free length");
        const double strength = ratio * entry(file, "Yield stress");
        const Run    run      = drive(file, opening(way), communicator);

        double plastic = 0., difference = 0., unbalanced = 0.;
        double largest = 0., smallest = 0., at_half_yield = 0., widest = 0.;
        for (unsigned int i = 0; i < run.samples.size(); ++i)
          {
            const Sample &now = run.samples[i];
            const double  end = run.samples.back().time;
            plastic =
              std::max(now.opening - strength / slope,
                       std::min(now.opening + strength / slope, plastic));
            keep_largest(difference,
                         std::abs(now.bars - slope * (now.opening - plastic)));
            keep_largest(widest, now.opening);
            keep_largest(largest, now.bars);
            keep_smallest(smallest, now.bars);
            if (at_half_yield == 0. && now.opening > 0.5 * strength / slope)
              at_half_yield = now.bars;
            // the force of the bars stretches the layer
            const double base =
              0.5 * way * (1. - std::cos(2. * numbers::PI * now.time / end));
            if (now.pressure == 0.)
              keep_largest(unbalanced,
                           std::abs(stiffness * (base - now.opening) -
                                    now.bars));
          }
        verdicts.near("stress at half the opening of yield [MPa]",
                      1e-6 * at_half_yield,
                      0.5e-6 * strength,
                      0.01);
        verdicts.near("largest stress [MPa]",
                      1e-6 * largest,
                      1e-6 * strength,
                      1e-9);
        verdicts.near("smallest stress, as it closes [MPa]",
                      1e-6 * smallest,
                      -1e-6 * strength,
                      1e-9);
        verdicts.below("difference from the law, over the strength",
                       difference / strength,
                       1e-9);
        verdicts.below("stress of the layer without that of the bars, over the "
                       "strength",
                       unbalanced / strength,
                       0.02);
        const double yields = strength / slope;
        verdicts.near("work on the bars [kJ/m2]",
                      1e-3 * run.bars,
                      1e-3 * strength *
                        (2. * widest - run.samples.back().opening -
                         2.5 * yields),
                      0.01);
      }

    private:
      double way = 1e-3, stiffness = 0.;
    };

    // Reference: closed form
    const Registry<Check>::Add<Bars>
      registered_bars("contact bars", "Joint reinforcement that yields.");
  } // namespace
} // namespace Voussoir
