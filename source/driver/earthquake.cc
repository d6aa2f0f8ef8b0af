#include <voussoir/base/error.h>
#include <voussoir/driver/earthquake.h>
#include <voussoir/signals/fourier.h>

#include <algorithm>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    struct Peak
    {
      double acceleration = 0.; // [m/s2]
      double time         = 0.;
    };


    /** The highest peak at a distance of at least @p away from a time [s]. */
    Peak
    find_peak(const Signal &motion,
              const double  end,
              const double  time = 0.,
              const double  away = 0.)
    {
      constexpr double resolution = EarthquakeMotion::sample_interval;
      Peak             peak;
      for (std::size_t i = 0; i * resolution <= end; ++i)
        if (const double now = std::abs(motion.acceleration(i * resolution));
            !(now <= peak.acceleration) &&
            std::abs(i * resolution - time) >= away)
          peak = {now, i * resolution};
      return peak;
    }


    /** Warns of a single extreme sample: a wrong digit in a record becomes its
     *  peak, and scaling to a peak acceleration then makes the rest small. */
    void
    check_single_sample(const Signal      &motion,
                        const Peak        &peak,
                        const std::string &text,
                        Log               &log)
    {
      constexpr double away = 0.05;
      const double     rest =
        find_peak(motion, motion.end(), peak.time, away).acceleration;
      if (rest < 0.2 * peak.acceleration)
        log.warn(std::setprecision(3),
                 text,
                 ", but stays below ",
                 rest / standard_gravity,
                 " g where this is more than ",
                 away,
                 " s away; check whether a sample of the record is wrong");
    }


    void
    report_fit(const SpectrumFit &fit, const SpectrumMatch &match, Log &log)
    {
      constexpr double accepted = 0.1;
      const auto [largest, at]  = fit.largest_misfit();
      const char axis           = "xyz"[fit.component];
      log.line(std::setprecision(3),
               "Ground motion ",
               axis,
               ": the record times ",
               fit.factor,
               match.method == MatchMethod::one_factor ?
                 "" :
                 ", changed by wavelets,",
               " is off its target spectrum by ",
               100. * fit.mean_misfit(),
               " % on average and ",
               100. * largest,
               " % at most, at ",
               at,
               " s, between ",
               match.shortest_period,
               " and ",
               match.longest_period,
               " s; Arias intensity ",
               fit.arias_before,
               " m/s before, ",
               fit.arias_after,
               " m/s after");
      if (match.method == MatchMethod::each_component &&
          fit.mean_misfit() > accepted)
        log.warn(std::setprecision(3),
                 "the ground motion ",
                 axis,
                 " is off its target spectrum by ",
                 100. * fit.mean_misfit(),
                 " % on average; choose a record whose own spectrum is more "
                 "like the target, or match fewer periods in section \"Ground "
                 "motion/Matching\"");
    }


    // Warns of probable mistakes in the earthquake.
    void
    check_peaks(const GroundMotionSignals &motion,
                const GroundMotion        &parameters,
                const double               end_time,
                Log                       &log)
    {
      constexpr double                 design = 1.5, recorded = 5.; // [g]
      const std::array<std::string, 3> axes{{"x", "y", "z"}};
      for (unsigned int d = 0; d < 3; ++d)
        if (motion[d])
          {
            const double end     = motion[d]->end();
            const Peak   reached = find_peak(*motion[d], end_time);
            const Peak   whole =
              std::isfinite(end) ? find_peak(*motion[d], end) : reached;
            const double       g = whole.acceleration / standard_gravity;
            std::ostringstream text;
            text << std::setprecision(3) << "the ground motion " << axes[d]
                 << " has its peak acceleration of " << g
                 << " g at t = " << whole.time << " s";
            const std::string remedy =
              "check the file and its \"Unit\", \"Peak acceleration " +
              axes[d] +
              "\" and \"Overload factor\" in section \"Ground "
              "motion\"";
            if (!(g < 1e6))
              throw UserError("Nothing can be computed, as " + text.str() +
                              "; " + remedy + ".");
            if (g > recorded)
              log.warn(text.str(), ", more than was ever recorded; ", remedy);
            else if (const double own = g / parameters.overload_factor;
                     own > design)
              log.warn(text.str(),
                       own < g ? " with the overload factor" : "",
                       ", more than dams are designed for; ",
                       remedy,
                       ", as 1 g is 9.81 m/s2");
            if (g < 1e-3)
              log.warn(text.str(), ", which is not perceptible; ", remedy);
            if (parameters.type == GroundMotionType::record)
              check_single_sample(*motion[d], whole, text.str(), log);
            if (reached.acceleration < 0.99 * whole.acceleration)
              log.warn(std::setprecision(3),
                       text.str(),
                       ", but reaches ",
                       reached.acceleration / standard_gravity,
                       " g only up to the \"End time\" of ",
                       end_time,
                       " s in section \"Time\"");
          }
    }


    // Warns of waves that are too short for the cells of the rock, and so do
    // not reach the dam.
    void
    check_frequencies(const Model &model, const double middle, Log &log)
    {
      constexpr double          fairly  = 8. / 5.; // nodes per wavelength
      const std::vector<double> carried = model.carried_frequencies();
      for (unsigned int m = 0; m < carried.size(); ++m)
        if (carried[m] > 0. && model.solid.materials[m]->inertia_factor == 1. &&
            fairly * carried[m] < middle)
          log.warn(std::setprecision(3),
                   "half of the power of the ground motion lies above ",
                   middle,
                   " Hz, but the largest cells of \"",
                   model.parameters.materials.objects[m].first,
                   "\" carry waves up to ",
                   carried[m],
                   " Hz with 8 nodes per wavelength, and up to ",
                   fairly * carried[m],
                   " Hz with 5; make them smaller in section \"Mesh\"");
    }


    bool
    alike(const Material &first, const Material &second)
    {
      const auto numbers = [](const Material &material) {
        const ElasticConstants c = material.elastic_constants();
        return std::array<double, 4>{{c.density,
                                      c.young_modulus,
                                      c.poisson_ratio,
                                      material.damping_factor()}};
      };
      return numbers(first) == numbers(second);
    }


    // Reports damping on the way to the surface: the more rock lies below the
    // dam, the more it weakens an outcrop motion given at its bottom.
    void
    report_loss(const Model &model, const double frequency, Log &log)
    {
      constexpr double noteworthy = 0.05;
      const auto      &damping    = model.parameters.damping;
      if (damping.model == DampingModel::none)
        return;
      std::vector<SideFace> faces = model.boundary.side_faces();
      std::sort(faces.begin(),
                faces.end(),
                [](const SideFace &one, const SideFace &other) {
                  return one.lower < other.lower;
                });
      // each height once, as faces side by side may begin at different heights
      double exponent = 0., reached = std::numeric_limits<double>::lowest();
      for (const SideFace &face : faces)
        if (face.upper > reached)
          {
            const Material &material = *model.solid.materials[face.material];
            exponent += 2. * numbers::PI * frequency * damping.ratio *
                        material.damping_factor() *
                        (face.upper - std::max(face.lower, reached)) /
                        material.elastic_constants().s_wave_speed();
            reached = face.upper;
          }
      const double share =
        Utilities::MPI::max(-std::expm1(-exponent), log.communicator());
      if (share > noteworthy)
        log.line(std::setprecision(2),
                 "Ground motion: damping takes ",
                 100. * share,
                 " % of an S wave of ",
                 frequency,
                 " Hz on its way from the bottom of the model, where the "
                 "outcrop is, to its surface; \"Given at = level rock\" "
                 "compensates for it");
    }


    // Warns where the sides differ, as a vertical wave is computed in one
    // column of layers.
    void
    check_layers(const Model &model, Log &log)
    {
      std::vector<SideFace> faces = model.boundary.side_faces();
      std::sort(faces.begin(), faces.end(), [](const auto &a, const auto &b) {
        return a.lower < b.lower;
      });
      // of each material the face that reaches highest so far
      std::vector<const SideFace *> highest(model.solid.materials.size(),
                                            nullptr);
      for (const SideFace &face : faces)
        {
          const double least = 1e-6 * (face.upper - face.lower);
          for (unsigned int m = 0; m < highest.size(); ++m)
            if (highest[m] != nullptr &&
                highest[m]->upper > face.lower + least &&
                !alike(*model.solid.materials[m],
                       *model.solid.materials[face.material]))
              {
                const auto &names = model.parameters.materials.objects;
                log.warn(
                  "the sides of the model consist at the same height of \"",
                  names[m].first,
                  "\", at (",
                  highest[m]->middle,
                  ") m, and of \"",
                  names[face.material].first,
                  "\", at (",
                  face.middle,
                  ") m, but the earthquake rises as in one column of "
                  "horizontal layers, which has the material of the "
                  "larger area there");
                return;
              }
          if (const SideFace *&top = highest[face.material];
              top == nullptr || top->upper < face.upper)
            top = &face;
        }
    }


    /** Criteria for the time after the earthquake require that its strong part
     *  is over at the end of the run. */
    void
    check_strong_part(const GroundMotionSignals  &signals,
                      const AcceptanceParameters &acceptance,
                      const double                end_time,
                      Log                        &log)
    {
      constexpr double resolution = EarthquakeMotion::sample_interval,
                       most_left  = 5.; // [% of the Arias intensity]
      for (const AcceptanceCriterion &criterion : acceptance.of_the_run())
        if (criterion.load_case == LoadCase::after_earthquake)
          {
            double whole = 0., left = 0.;
            for (const auto &signal : signals)
              if (signal && std::isfinite(signal->end()))
                for (std::size_t i = 0; i * resolution <= signal->end(); ++i)
                  {
                    const double power =
                      std::pow(signal->acceleration(i * resolution), 2);
                    whole += power;
                    left += i * resolution > end_time ? power : 0.;
                  }
            if (const double share = 100. * left / whole; share > most_left)
              log.warn(std::setprecision(3),
                       "the criterion \"",
                       criterion.name,
                       "\" in section \"Acceptance\" is for the time after the "
                       "earthquake, but ",
                       share,
                       " % of the Arias intensity of the motion come after the "
                       "\"End time\" of ",
                       end_time,
                       " s in section \"Time\"; make that longer");
            return;
          }
    }
  } // namespace


  EarthquakeMotion::EarthquakeMotion(const Model &model, Log &log)
  {
    const Case         &parameters    = model.parameters;
    const GroundMotion &ground_motion = parameters.ground_motion;
    if (ground_motion.type == GroundMotionType::none)
      return;
    const double end_time = parameters.time.end_time;
    signals = ground_motion.build(parameters.file.folder(), &fits);
    log(ground_motion.summary(signals, end_time));
    for (const SpectrumFit &fit : fits)
      report_fit(fit, ground_motion.match, log);
    for (unsigned int d = 0; d < 3; ++d)
      if (signals[d])
        for (std::size_t i = 0; i * sample_interval <= end_time; ++i)
          accelerations[d].push_back(
            signals[d]->acceleration(i * sample_interval));
    // half of the power of the acceleration lies below
    const double middle =
      frequency_of_intensity(accelerations, sample_interval, 0.5);
    if (end_time > 0.)
      {
        check_peaks(signals, ground_motion, end_time, log);
        check_frequencies(model, middle, log);
        check_strong_part(signals, parameters.acceptance, end_time, log);
      }
    if (model.rigid_base())
      {
        if (std::all_of(model.solid.materials.begin(),
                        model.solid.materials.end(),
                        [](const Material *material) {
                          return material->inertia_factor < 1.;
                        }))
          throw UserError("The earthquake of section \"Ground motion\" moves "
                          "nothing, because the \"Inertia factor\" of all "
                          "materials is below one, as that of rock without "
                          "inertial force; set it to 1 for the dam.");
        return;
      }
    if (is_at_surface(ground_motion.given_at))
      for (const auto &component : signals)
        if (component && std::isinf(component->end()))
          followed_to = end_time;
    for (const unsigned int m : model.boundary.materials_at_boundary())
      if (!model.solid.materials[m]->isotropic())
        throw UserError("The earthquake of section \"Ground motion\" enters "
                        "through an absorbing boundary of \"" +
                        parameters.materials.objects[m].first +
                        "\", whose stiffness depends on the direction; free "
                        "field and dashpots are those of isotropic rock: give "
                        "the cells at the boundary such a material, or set "
                        "\"Enters through = rigid base\" in section \"Wave "
                        "field\".");
    check_wave(model.boundary,
               model.solid,
               parameters.wave,
               ground_motion.given_at,
               signals);
    if (parameters.wave.type == WaveType::vertical)
      {
        check_layers(model, log);
        if (end_time > 0. && ground_motion.given_at == MotionPlace::outcrop)
          report_loss(model, middle, log);
      }
  }


  Earthquake::Earthquake(const Model          &model,
                         GroundMotionSignals &&motion,
                         const Damping        &damping,
                         const TimeStep       &time_step)
  {
    const Case &parameters = model.parameters;
    if (parameters.ground_motion.type == GroundMotionType::none)
      return;
    if (model.rigid_base())
      {
        base = RigidBase(std::move(motion));
        return;
      }
    auto field = make_free_field(model.boundary,
                                 model.solid,
                                 {parameters.wave,
                                  parameters.ground_motion.given_at,
                                  parameters.discretization.quadrature,
                                  parameters.time.end_time},
                                 std::move(motion),
                                 damping,
                                 time_step.leap_frog());
    if (field)
      wave = std::make_unique<IncomingWave>(model.boundary, std::move(field));
  }
} // namespace Voussoir
