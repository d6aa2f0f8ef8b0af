#ifndef voussoir_loads_reservoir_parameters_h
#define voussoir_loads_reservoir_parameters_h

#include <voussoir/base/option.h>
#include <voussoir/loads/added_mass.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace Voussoir
{
  enum class ReservoirModel
  {
    none,
    added_mass,
    compressible
  };

  inline OptionNames<ReservoirModel>
  option_names(const ReservoirModel)
  {
    return {{ReservoirModel::none, "none"},
            {ReservoirModel::added_mass, "added mass"},
            {ReservoirModel::compressible, "compressible"}};
  }


  enum class FarReservoir
  {
    channel,
    plane_waves
  };

  inline OptionNames<FarReservoir>
  option_names(const FarReservoir)
  {
    return {{FarReservoir::channel, "channel"},
            {FarReservoir::plane_waves, "plane waves"}};
  }


  /** The entries of the section "Reservoir": how the water moves with the dam
   *  (its weight is a load of its own). */
  struct ReservoirParameters
  {
    ReservoirModel model   = ReservoirModel::none;
    double         density = 1000.; // [kg/m3]

    AddedMassParameters added_mass;

    // compressible water
    std::string  cell_sets         = "reservoir";
    double       sound_speed       = 1440.; // [m/s]
    std::string  surface           = "water surface";
    std::string  end               = "reservoir end";
    FarReservoir far_reservoir     = FarReservoir::channel;
    std::string  dam               = "upstream face";
    double       bottom_reflection = 1.;

    void
    declare(dealii::ParameterHandler &prm);
  };
} // namespace Voussoir

#endif
