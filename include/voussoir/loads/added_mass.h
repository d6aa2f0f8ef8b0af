#ifndef voussoir_loads_added_mass_h
#define voussoir_loads_added_mass_h

#include <voussoir/base/log.h>
#include <voussoir/base/option.h>
#include <voussoir/fem/nodal_terms.h>

#include <deal.II/base/parameter_handler.h>

namespace Voussoir
{
  enum class AddedMassDirection
  {
    normal,
    uncoupled,
    river
  };

  inline OptionNames<AddedMassDirection>
  option_names(const AddedMassDirection)
  {
    return {{AddedMassDirection::normal, "normal"},
            {AddedMassDirection::uncoupled, "uncoupled"},
            {AddedMassDirection::river, "river"}};
  }


  /** The entries of the section "Reservoir/added mass". */
  struct AddedMassParameters
  {
    std::string        face_sets = "upstream face";
    double             level     = 0.;
    double             reduction = 1.;
    AddedMassDirection direction = AddedMassDirection::normal;

    void
    declare(dealii::ParameterHandler &prm);
  };

  struct AddedMass
  {
    double               mass = 0.; // that resists motion along the river [kg]
    dealii::Tensor<1, 3> river;     // its direction
    std::vector<NodalTerm> terms;   // of this rank
  };

  /**
   * The generalised added mass of Westergaard (Kuo 1982): at depth h below the
   * level, where the water is H deep in the same section across the valley, a
   * facet with normal n and area A carries
   *   M_a = 7/8 rho sqrt(H h) A n n^T .
   * Nodal quadrature makes all parts positive. The added mass stands for
   * incompressible water, a valid model at frequencies below c/4H. The
   * direction of the river is that of the resultant of the water pressure:
   * horizontal, along the sum of -n A.
   *
   * @param density of the water [kg/m3]
   */
  AddedMass
  westergaard_mass(const Discretization      &discretization,
                   const AddedMassParameters &parameters,
                   const double               density,
                   Log                       &log);
} // namespace Voussoir

#endif
