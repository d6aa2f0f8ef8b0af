#ifndef voussoir_analysis_modal_model_h
#define voussoir_analysis_modal_model_h

#include <voussoir/base/option.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/loads/boundary_parameters.h>
#include <voussoir/loads/reservoir.h>
#include <voussoir/materials/solid.h>

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
    std::string       fixed_materials, massless_materials;
    std::string       points, shapes; // that were measured
    InterfacesInModes interfaces = InterfacesInModes::tied_where_closed;
    WaterInModes      water      = WaterInModes::by_reservoir;
    double            tolerance  = 1e-5;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether the modes need the cells of water, under this `Model` of section
     *  "Reservoir". */
    bool
    want_cells_of_water(const ReservoirParameters &reservoir) const;

    /** Refuses unknown materials, and a model without supports. */
    void
    check(const std::vector<std::string> &materials,
          const BoundaryParameters       &boundaries) const;
  };

  /** Input of the modes. */
  struct ModalModel
  {
    const Solid              &solid;
    std::vector<std::string>  material_names;
    const BoundaryParameters &boundaries;
    const NodalTerms         &terms;

    /** The interfaces in the static state, or null. */
    const Contact *contact = nullptr;

    /** Cells of water that take part in the modes, or null. */
    const Reservoir *reservoir = nullptr;
  };
} // namespace Voussoir

#endif
