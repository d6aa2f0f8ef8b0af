#ifndef voussoir_loads_end_motion_h
#define voussoir_loads_end_motion_h

#include <voussoir/loads/reservoir_end.h>

#include <nlohmann/json.hpp>

#include <complex>

namespace Voussoir
{
  /**
   * The flux through the radiating end of the water, in steps like those of
   * WaterMotion. The motion of the walls at the end causes a pressure p_f that
   * is constant along the far reservoir (under vertical motion, that of a
   * column of water),
   *   1/(rho c^2) V dp_f/dt + C p_f = -V/(rho M) K I_f - flux ,
   *   dI_f/dt = p_f ,
   * with the flux of the walls and the symbols of ReservoirEnd. Only the
   * pressure scattered by the dam, p - p_f, travels along the channel: in a
   * channel mode of frequency omega and decay b the outflow is sqrt(s^2 + 2 b s
   * + omega^2) / (rho c s) M (p - p_f) with the Laplace variable s, below omega
   * a spring instead of a dashpot. The part beyond 1/(rho c) is a convolution
   * of the impulse with exp(-b t) J_1(w t) w / t, w^2 = omega^2 - b^2, here a
   * sum of exponentials (Alpert, Greengard and Hagstrom 2002,
   * doi:10.1006/jcph.2002.7093).
   */
  class EndMotion
  {
  public:
    EndMotion(const ReservoirEnd &end, const double time_step);

    const ReservoirEnd &end;

    /**
     * Advances to p_(n+1) of the free field.
     * @param pressure of the water at the beginning of the step [Pa]
     * @param flux of the walls at the half step [m3/s]; gets, at the nodes of
     * the end, the flux through the end, except M p / (rho c) at the middle of
     * the step
     */
    void
    advance(const Vector &pressure, Vector &flux);

    /** Flux that the last step added, by owned node of the end [m3/s].
     */
    std::vector<double> added;

    nlohmann::json
    save() const;

    void
    load(const nlohmann::json &saved);

  private:
    /** Sets the response of each mode [m/s]; @p size is the integral of M (p -
     *  p_f) times the shape of each mode. */
    void
    advance_modes(const double *size);

    void
    advance_free_field(const double *flux);

    const double       time_step;
    const unsigned int n_modes;

    // p_f [Pa], I_f [Pa s], mean p_f of the step
    std::vector<double> pressure, impulse, mean;
    // p <- keep p - push (V/(rho M) K I + flux)
    std::vector<double> keep, push;

    /** One of the exponentials of a mode: memory <- keep memory + gain (I+I').
     */
    struct Exponential
    {
      std::complex<double> keep, gain, weight;
    };
    std::vector<std::vector<Exponential>>          exponentials; // by mode
    std::vector<double>                            viscosity;    // of p - p_f
    std::vector<double>                            modal_impulse, response;
    std::vector<std::vector<std::complex<double>>> memory;

    std::vector<double> sums; // over the ranks
  };
} // namespace Voussoir

#endif
