#include <voussoir/base/usual_range.h>
#include <voussoir/loads/reservoir_parameters.h>

namespace Voussoir
{
  using namespace dealii;

  void
  ReservoirParameters::declare(ParameterHandler &prm)
  {
    add_option(
      prm,
      "Model",
      model,
      "How the water moves with the dam. Added mass: incompressible, for low "
      "dams or first estimates. Compressible: cells of compressible water, "
      "needed where the dam's frequencies come near to sound speed / (4 "
      "depth), 1.25 Hz at 289 m.");
    prm.add_parameter("Density",
                      density,
                      "Density of the water [kg/m3]." +
                        usually(Usual::water_density),
                      Patterns::Double(1.));
    prm.enter_subsection("added mass");
    added_mass.declare(prm);
    prm.leave_subsection();
    prm.add_parameter(
      "Cell sets",
      cell_sets,
      "Cell sets of the water, for the model compressible and where section "
      "\"Modes\" needs them.");
    prm.add_parameter("Sound speed",
                      sound_speed,
                      "Compressible: speed of sound in the water [m/s]." +
                        usually(Usual::sound_speed),
                      Patterns::Double(1.));
    prm.add_parameter(
      "Free surface",
      surface,
      "Face sets of the free surface of the cells of water, where the pressure "
      "is zero.");
    prm.add_parameter(
      "Radiating end",
      end,
      "Compressible: face sets of the water, upright, through which pressure "
      "waves leave upstream; other ends reflect.");
    add_option(
      prm,
      "Far reservoir",
      far_reservoir,
      "Compressible: model of the reservoir behind the radiating end. Channel: "
      "the section of the end continues to infinity; the channel takes no "
      "energy below its cut-off frequency, sound speed / (4 depth) where the "
      "bottom is level, except by absorption at its bottom. Plane waves: a "
      "dashpot of density times sound speed, as in most programs, which takes "
      "energy below that frequency, too. Neither affects the pressure by the "
      "motion of floor and banks along the whole reservoir.");
    prm.add_parameter("Dam",
                      dam,
                      "Compressible: face sets of the dam. All other walls of "
                      "the water are its bottom.");
    prm.add_parameter(
      "Bottom reflection coefficient",
      bottom_reflection,
      "Compressible: ratio of reflected to incident pressure at the sediment "
      "of the bottom, at normal incidence; 1 without sediment. The rock below "
      "radiates by its own motion [-].",
      Patterns::Double(0., 1.));
  }
} // namespace Voussoir
