#ifndef voussoir_loads_ground_motion_h
#define voussoir_loads_ground_motion_h

#include <voussoir/base/option.h>
#include <voussoir/signals/baseline.h>
#include <voussoir/signals/record.h>
#include <voussoir/signals/signal.h>
#include <voussoir/signals/spectrum_match.h>
#include <voussoir/signals/spectrum_motion.h>

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace Voussoir
{
  /** Components in x, y, z; null for a component without motion. */
  using GroundMotionSignals = std::array<std::unique_ptr<Signal>, 3>;

  enum class GroundMotionType
  {
    none,
    record,
    ricker,
    sine,
    pulse,
    spectrum
  };

  inline OptionNames<GroundMotionType>
  option_names(const GroundMotionType)
  {
    return {{GroundMotionType::none, "none"},
            {GroundMotionType::record, "record"},
            {GroundMotionType::ricker, "Ricker"},
            {GroundMotionType::sine, "sine"},
            {GroundMotionType::pulse, "pulse"},
            {GroundMotionType::spectrum, "spectrum"}};
  }


  /** Where the motion is given: at an outcrop, at the surface or in the rock.
   */
  enum class MotionPlace
  {
    outcrop,
    level_rock,
    free_surface,
    incident_wave
  };

  inline OptionNames<MotionPlace>
  option_names(const MotionPlace)
  {
    return {{MotionPlace::outcrop, "outcrop"},
            {MotionPlace::level_rock, "level rock"},
            {MotionPlace::free_surface, "free surface"},
            {MotionPlace::incident_wave, "incident wave"}};
  }

  /** Whether the incident wave follows from a motion of the surface, by
   *  deconvolution. */
  inline bool
  is_at_surface(const MotionPlace place)
  {
    return place == MotionPlace::free_surface ||
           place == MotionPlace::level_rock;
  }


  /**
   * Parameters of the prm section "Ground motion": the earthquake as functions
   * of time across the valley (x), along the river (y) and upwards (z).
   */
  struct GroundMotion
  {
    GroundMotionType type = GroundMotionType::none;

    /** Place of the given motion. */
    MotionPlace given_at = MotionPlace::outcrop;

    /** The entries "Peak acceleration x", y and z. */
    std::array<std::string, 3> peak_entries{
      {as_recorded, as_recorded, as_recorded}};

    /** Largest acceleration of a component before the overload factor [g]; none
     *  for "as recorded", which with other types than a record means no motion.
     */
    std::optional<double>
    peak_acceleration(const unsigned int component) const;

    /** Whether the component has a file to read. */
    bool
    has_record(const unsigned int component) const;

    std::string reversed; // components of reversed sign

    double overload_factor = 1.;

    /** Names in entries and messages. */
    static inline const std::array<std::string, 3> axis_names{{"x", "y", "z"}};
    static inline const std::array<std::string, 3> axis_meanings{
      {"across the valley", "along the river", "vertical"}};

    /** The value that leaves the peak of a record unscaled. */
    static constexpr const char *as_recorded = "as recorded";

    struct Record
    {
      std::array<std::string, 3>  files;
      std::array<unsigned int, 3> columns{{1, 1, 1}};
      AccelerationUnit            unit       = AccelerationUnit::g;
      double                      time_step  = 0.;
      double                      start_time = 0.;
      double                      duration   = 0.;
      BaselineCorrection          baseline;

      void
      declare(dealii::ParameterHandler &prm);
    };

    struct Ricker
    {
      Quantity quantity  = Quantity::displacement;
      double   frequency = 5.;
      double   middle    = 0.;

      void
      declare(dealii::ParameterHandler &prm);
    };

    struct Sine
    {
      double       frequency   = 2.;
      unsigned int cycles      = 10;
      unsigned int ramp_cycles = 2;

      void
      declare(dealii::ParameterHandler &prm);
    };

    struct Pulse
    {
      Quantity quantity = Quantity::displacement;
      double   duration = 0.5;

      void
      declare(dealii::ParameterHandler &prm);
    };

    Record         record;
    Ricker         ricker;
    Sine           sine;
    Pulse          pulse;
    SpectrumMotion spectrum;
    SpectrumMatch  match;

    void
    declare(dealii::ParameterHandler &prm);

    /** Throws UserError if entries contradict each other. */
    void
    check() const;

    /** A sentence for each record that is named but not used. */
    std::vector<std::string>
    warnings() const;

    /**
     * The motion in SI units, all factors included; for the type none, all
     * pointers are null. Paths of records are relative to @p folder, that of
     * the parameter file. Throws UserError on unreadable records.
     *
     * @param fits if not null, gets the misfit of records to the spectrum that
     * they are matched to
     */
    GroundMotionSignals
    build(const std::string        &folder,
          std::vector<SpectrumFit> *fits = nullptr) const;

    /**
     * Lines for the log: peaks of each component up to @p end_time [s], and for
     * motions from a design spectrum their deviation from it and their
     * correlation.
     */
    std::string
    summary(const GroundMotionSignals &signals, const double end_time) const;

  private:
    /** Whether the ground moves in this direction. */
    bool
    moves(const unsigned int component) const;

    /** 1, or -1 if the component is reversed. */
    double
    sign(const unsigned int component) const;

    /** The motion of records that are matched to a spectrum. */
    GroundMotionSignals
    build_matched(const std::string        &folder,
                  std::vector<SpectrumFit> *fits) const;
  };
} // namespace Voussoir

#endif
