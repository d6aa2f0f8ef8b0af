#ifndef voussoir_analysis_modes_h
#define voussoir_analysis_modes_h

#include <voussoir/analysis/modal_model.h>
#include <voussoir/base/log.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** A natural mode. Phi has the pressure of compressible water as well, see
   *  ModalWater. */
  struct Mode
  {
    double frequency; // [Hz]
    Vector shape;     // largest displacement 1
    double mass;      // phi^T (M + M_a) phi [kg]
    double residual;  // |K phi - omega^2 (M + M_a) phi| / |K phi|

    /** phi^T (M + M_a) r / mass, with r = 1 in one direction, at fixed nodes as
     *  well: fixed walls of a canyon push the water. */
    dealii::Tensor<1, 3> participation;

    /** participation^2 mass, by direction [kg]. */
    dealii::Tensor<1, 3> effective_mass;
  };

  struct Modes
  {
    std::vector<Mode> list; // from the lowest frequency upwards

    /** Mass that can move in each direction, with the water that acts on it:
     *  the sum of the effective masses of all modes [kg]. */
    dealii::Tensor<1, 3> moving_mass;

    /** The mode nearest to each measured shape, by the name of the shape. */
    nlohmann::json measured_shapes;

    std::vector<std::string> warnings;

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
   * given, absorbing faces fixed, interfaces tied. Called on all ranks.
   */
  Modes
  find_modes(const ModalModel     &model,
             const ModeParameters &parameters,
             Log                  &log);
} // namespace Voussoir

#endif
