#include <voussoir/base/error.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/loads/ground_motion.h>

#include <deal.II/base/patterns.h>

namespace Voussoir
{
  void
  GroundMotion::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    add_option(prm,
               "Type",
               type,
               "The earthquake: none, recorded accelerations from files "
               "(record), a Ricker wavelet, a sine, a single pulse, or an "
               "artificial motion that follows a design spectrum (spectrum). "
               "Its details are in the section of that name; the other "
               "sections are not used.");
    add_option(
      prm,
      "Given at",
      given_at,
      "Place of the given motion. outcrop: on bare rock at the bottom of the "
      "model, twice the incident wave there, as in most codes; damping of the "
      "rock then weakens it on its way up. level rock: on bare rock at the "
      "height of the model's surface, like the rock at its bottom, whose "
      "damping is taken into account. free surface: on top of the modelled ground "
      "without dam and canyon, from where the wave is deconvolved. incident "
      "wave: the upgoing wave itself at the bottom of the model.");
    for (unsigned int c = 0; c < 3; ++c)
      prm.add_parameter(
        "Peak acceleration " + axis_names[c],
        peak_entries[c],
        "Largest acceleration, " + axis_meanings[c] +
          ", before the overload factor, from 0 to 10 [g = 9.81 m/s2]; 0 for "
          "no motion. \"as recorded\" takes a record unscaled; with other "
          "types it means no motion.",
        Anything());
    prm.add_parameter(
      "Reversed",
      reversed,
      "Components whose sign is reversed, \"y\" or \"x, z\"; empty: none. Joints "
      "and cracks respond to the two signs differently.",
      MultipleSelection("x|y|z"));
    prm.add_parameter("Overload factor",
                      overload_factor,
                      "Factor on all components, for studies beyond the design "
                      "earthquake [-]." +
                        usually(Usual::overload),
                      Double(0.));

    const auto declare_section = [&prm](const std::string &name,
                                        auto              &parameters) {
      prm.enter_subsection(name);
      parameters.declare(prm);
      prm.leave_subsection();
    };
    declare_section("Record", record);
    declare_section("Ricker", ricker);
    declare_section("Sine", sine);
    declare_section("Pulse", pulse);
    declare_section("Spectrum", spectrum);
    declare_section("Matching", match);
  }


  void
  GroundMotion::Record::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    for (unsigned int c = 0; c < 3; ++c)
      prm.add_parameter("File " + axis_names[c],
                        files[c],
                        "Accelerations, " + axis_meanings[c] +
                          ": an AT2 file, or a table with the time in the "
                          "first column; relative to the folder of the "
                          "parameter file. Empty: no motion in this "
                          "direction.",
                        Anything());
    for (unsigned int c = 0; c < 3; ++c)
      prm.add_parameter("Column " + axis_names[c],
                        columns[c],
                        "Column of File " + axis_names[c] +
                          " if that is a table, counted from 1 without the "
                          "time column.",
                        Integer(1));
    add_option(
      prm,
      "Unit",
      unit,
      "Unit of the accelerations in the files; g = 9.81 m/s2, cm/s2 = gal.");
    prm.add_parameter(
      "Time step",
      time_step,
      "Time step of tables that have a single column and no time [s]; 0 for "
      "all other files.",
      Double(0.));
    prm.add_parameter("Start time",
                      start_time,
                      "The part of the records before this time is left out "
                      "[s].",
                      Double(0.));
    prm.add_parameter("Duration",
                      duration,
                      "Duration of the part used [s]; 0: to the end.",
                      Double(0.));
    baseline.declare(prm);
  }


  void
  GroundMotion::Ricker::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    add_option(prm,
               "Quantity",
               quantity,
               "Quantity with the shape of the Ricker wavelet.");
    prm.add_parameter("Frequency",
                      frequency,
                      "Central frequency f [Hz]; there is hardly any motion "
                      "above 3 f.",
                      Double(0.01, 1000.));
    prm.add_parameter(
      "Middle",
      middle,
      "Time of the middle of the wavelet [s], at least 1.5/f; 0: 1.5/f.",
      Double(0.));
  }


  void
  GroundMotion::Sine::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.add_parameter("Frequency",
                      frequency,
                      "Frequency [Hz].",
                      Double(0.01, 1000.));
    prm.add_parameter("Cycles",
                      cycles,
                      "Number of cycles; 0 for motion without end.",
                      Integer(0));
    prm.add_parameter(
      "Ramp cycles",
      ramp_cycles,
      "Number of cycles in which the motion is faded in and, at the end, out; "
      "meanwhile the motion exceeds the peak acceleration, by 15 % for 1 and "
      "by 2 % for 2. 0: the acceleration is a full sine from the start, so "
      "that the ground drifts to one side.",
      Integer(0));
  }


  void
  GroundMotion::Pulse::declare(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    add_option(prm,
               "Quantity",
               quantity,
               "Quantity with the shape of a single pulse. displacement: the "
               "ground returns. velocity: the ground stays displaced.",
               {Quantity::displacement, Quantity::velocity});
    prm.add_parameter("Duration",
                      duration,
                      "Duration of the pulse [s].",
                      Double(1e-4, 1000.));
  }


  std::vector<std::string>
  GroundMotion::warnings() const
  {
    std::vector<std::string> result;
    for (unsigned int c = 0; c < 3; ++c)
      if (has_record(c) && !moves(c))
        result.push_back(
          "\"Peak acceleration " + axis_names[c] +
          "\" in section \"Ground motion\" is 0, so that \"File " +
          axis_names[c] + "\" is not used; write \"" + as_recorded +
          "\" to take the record as it is, or leave \"File " + axis_names[c] +
          "\" empty");
    return result;
  }


  void
  GroundMotion::check() const
  {
    std::array<std::optional<double>, 3> peaks;
    for (unsigned int c = 0; c < 3; ++c)
      peaks[c] = peak_acceleration(c);
    if (type == GroundMotionType::none)
      return;

    for (unsigned int c = 0; c < 3; ++c)
      if (type == GroundMotionType::record && record.files[c].empty() &&
          peaks[c].value_or(0.) > 0.)
        throw UserError("\"Peak acceleration " + axis_names[c] +
                        "\" in section \"Ground motion\" is set, but \"File " +
                        axis_names[c] +
                        "\" in section \"Ground motion/Record\" is empty; name "
                        "a file or set the peak to 0.");

    if (type == GroundMotionType::record &&
        std::all_of(record.files.begin(),
                    record.files.end(),
                    [](const std::string &file) { return file.empty(); }))
      throw UserError("\"File x\", \"File y\" and \"File z\" in section "
                      "\"Ground motion/Record\" are all empty; name a file, or "
                      "set \"Type = none\" in section \"Ground motion\".");

    if (!moves(0) && !moves(1) && !moves(2))
      throw UserError(
        "\"Peak acceleration x\", y and z in section \"Ground motion\" leave "
        "no motion; one of them must be above 0" +
        std::string(type == GroundMotionType::record ?
                      ", or \"as recorded\", of a component with a file" :
                      "") +
        "; set one of them, or \"Type = none\".");

    if (type == GroundMotionType::ricker && ricker.middle > 0 &&
        ricker.middle * ricker.frequency < 1.5 - 1e-9)
      throw UserError(
        "\"Middle\" in section \"Ground motion/Ricker\" must be 0 or at least "
        "1.5 / \"Frequency\", so that the ground starts at rest.");

    if (type == GroundMotionType::sine && sine.cycles > 0 &&
        sine.cycles < 2 * sine.ramp_cycles)
      throw UserError(
        "\"Cycles\" in section \"Ground motion/Sine\" must be 0 or at least "
        "twice \"Ramp cycles\", for the rise and the fall.");

    if (type == GroundMotionType::spectrum)
      spectrum.check();

    if (!match.wanted())
      return;
    if (type != GroundMotionType::record)
      throw UserError("\"Method\" in section \"Ground motion/Matching\" "
                      "matches records to a spectrum, but \"Type\" in section "
                      "\"Ground motion\" is \"" +
                      option_name(type) + "\"; set \"Method = none\".");
    for (unsigned int c = 0; c < 3; ++c)
      if (has_record(c) && !peaks[c])
        throw UserError("\"Peak acceleration " + axis_names[c] +
                        "\" in section \"Ground motion\" is \"" + as_recorded +
                        "\", but the target spectrum of a record that is "
                        "matched is a multiple of this peak; give a number.");
    match.check(spectrum.spectrum, "Ground motion/Spectrum");
    if (spectrum.vertical.shape != SpectrumShape::as_horizontal)
      match.check(spectrum.vertical, "Ground motion/Spectrum/Vertical");
  }
} // namespace Voussoir
