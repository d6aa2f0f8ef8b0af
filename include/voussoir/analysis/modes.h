#ifndef voussoir_analysis_modes_h
#define voussoir_analysis_modes_h

#include <voussoir/base/log.h>
#include <voussoir/base/option.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/loads/boundary_parameters.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/materials/solid.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  enum class InterfacesInModes
  {
    tied_where_closed,
    all_tied
  };

  inline OptionNames<InterfacesInModes>
  option_names(const InterfacesInModes)
  {
    return {{InterfacesInModes::tied_where_closed, "tied where closed"},
            {InterfacesInModes::all_tied, "all tied"}};
  }


  enum class WaterInModes
  {
    none,
    by_reservoir,
    incompressible,
    compressible
  };

  inline OptionNames<WaterInModes>
  option_names(const WaterInModes)
  {
    return {{WaterInModes::none, "none"},
            {WaterInModes::by_reservoir, "by reservoir"},
            {WaterInModes::incompressible, "incompressible"},
            {WaterInModes::compressible, "compressible"}};
  }


  /** The entries of the section "Modes". */
  struct ModeParameters
  {
    unsigned int      number = 0;
    std::string       held_materials, massless_materials;
    InterfacesInModes interfaces = InterfacesInModes::tied_where_closed;
    WaterInModes      water      = WaterInModes::by_reservoir;
    double            tolerance  = 1e-5;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether they want the cells of water, in this model of section
     *  "Reservoir". */
    bool
    want_cells_of_water(const ReservoirParameters &reservoir) const;

    /** Refuses unknown materials and a model that nothing holds. */
    void
    check(const std::vector<std::string> &materials,
          const BoundaryParameters       &boundaries) const;
  };

  /** What the modes are computed from. */
  struct ModalModel
  {
    const Solid              &solid;
    std::vector<std::string>  material_names;
    const BoundaryParameters &boundaries;
    const NodalTerms         &terms;

    /** The interfaces at rest, or null. */
    const Contact *contact = nullptr;

    /** Cells of water that move along, or null. */
    const Reservoir *reservoir = nullptr;
  };

  /** A natural mode. Phi has the pressure of compressible water as well, see
   *  ModalWater. */
  struct Mode
  {
    double frequency; // [Hz]
    Vector shape;     // largest displacement 1
    double mass;      // phi^T (M + M_a) phi [kg]
    double residual;  // |K phi - omega^2 (M + M_a) phi| / |K phi|

    /** phi^T (M + M_a) r / mass, with r = 1 in one direction, at what is held
     * as well: held walls of a canyon push the water. */
    dealii::Tensor<1, 3> participation;

    /** participation^2 mass, by direction [kg]. */
    dealii::Tensor<1, 3> effective_mass;
  };

  struct Modes
  {
    std::vector<Mode> list; // from the lowest frequency upwards

    /** Mass that can move in each direction, with the water that pushes it:
     * what the effective masses of all modes add up to [kg]. */
    dealii::Tensor<1, 3> moving_mass;

    /** [Hz] */
    std::vector<double>
    frequencies() const;

    nlohmann::json
    summary() const;
  };

  /** Refuses more modes than the model can have. */
  void
  check_modes(const ModalModel &model, const ModeParameters &parameters);

  /**
   * The lowest natural modes, K phi = omega^2 (M + M_a) phi, with the moduli as
   * given, absorbing faces held, interfaces tied. Called on all ranks.
   */
  Modes
  find_modes(const ModalModel     &model,
             const ModeParameters &parameters,
             Log                  &log);
} // namespace Voussoir

#endif
