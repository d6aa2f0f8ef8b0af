#ifndef voussoir_materials_softening_curve_h
#define voussoir_materials_softening_curve_h

#include <voussoir/fem/crack_growth.h>
#include <voussoir/materials/law.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /** Internal variables of a point whose damage follows a curve; zero while it
   *  is elastic. */
  struct CurveMemory
  {
    double largest;  // largest effective strain so far; beyond it damage grows
    double position; // effective strain up to which the curve has been followed
    double last;     // effective elastic strain of the last step
    double damage;

    static constexpr unsigned int n_numbers = 4;
  };


  /** Result of a step at a point whose damage follows a curve. */
  template <typename Number>
  struct DamageProgress
  {
    Number effective =
      1.; // factor on the effective stress: irreversible strain
    Number intact      = 1.; // 1 - damage
    Number dissipation = 0.; // over the elastic energy of the effective stress

    void
    set_lane(const unsigned int lane, const DamageProgress<double> &progress)
    {
      lane_of(effective, lane)   = progress.effective;
      lane_of(intact, lane)      = progress.intact;
      lane_of(dissipation, lane) = progress.dissipation;
    }
  };

  /**
   * Stress over strain in a uniaxial test beyond the elastic limit, in straight
   * pieces. The inelastic strain of a node is the sum of a strain of the
   * material itself and of a displacement that is smeared over a band as wide
   * as the element: the crack band of Bazant and Oh (1983), which makes the
   * energy of a crack the same on all meshes.
   */
  class SofteningCurve
  {
  public:
    struct Node
    {
      double stress;       // [Pa]
      double strain;       // inelastic, of the material [1]
      double displacement; // inelastic, of the band [m]
    };

    /** State of a point at its largest equivalent strain. */
    struct Point
    {
      double stress;       // [Pa]
      double inelastic;    // strain of a uniaxial test
      double irreversible; // part of it that stays on unloading
      double elastic;      // effective less irreversible strain

      /** Loss of stiffness. */
      double
      damage(const double young_modulus) const
      {
        return 1. - stress / (young_modulus * elastic);
      }
    };

    SofteningCurve() = default;

    /**
     * @param irreversible_share share of the inelastic strain that stays on
     *   unloading; the rest is damage
     * @param relief k of a law in which a uniaxial test with the effective
     *   stress s has the strain ((1 - k) s + k sigma)/E
     */
    SofteningCurve(const std::vector<Node> &nodes,
                   const double             young_modulus,
                   const double             irreversible_share,
                   const double             relief = 0.);

    /**
     * The curve of the static state, with the same traction over the opening
     * except for the increase of strength in an earthquake. Its points follow
     * the curve exactly instead of by the rule of `go_on`, since a load
     * increment is no time step: one increment leads to the same state as ten.
     *
     * @param static_modulus [Pa]
     * @param strength_increase factor that the stresses have in an earthquake
     */
    SofteningCurve
    of_static_state(const double static_modulus,
                    const double strength_increase = 1.) const;

    /**
     * Converts the internal variables of a point from another curve to this
     * one: at the same damage, so that stress and opening stay the same for any
     * strength of this curve.
     *
     * @param damage of the point, with the modulus of this curve
     * @param elastic_strain effective, at present [1]
     */
    void
    hand_over(const double damage,
              const double elastic_strain,
              const double band,
              CurveMemory &memory) const;

    /** State at an effective strain s/E [1] in a band of this width [m];
     *  elastic below the limit. */
    Point
    at(const double strain, const double band) const;

    /**
     * Advances the damage of a point by one step. A step of finite length cuts
     * the corners of the curve; it advances along the curve until the released
     * energy is that of the trapezoidal rule of the time step, (s_a e_b - s_b
     * e_a)/2 + (s_a + s_b) (p_b - p_a)/2 , with the elastic strain e and the
     * irreversible p: so a crack takes its energy with any time step, and gains
     * none. In the static state damage advances up to the present strain.
     *
     * @param equivalent_stress effective stress of a uniaxial test [Pa]
     * @param band width of the band [m]
     * @param followed share of the growth that counts in this step
     * @param held at a point that has been elastic, its stress before this step
     *   over the elastic limit, at least 1
     */
    DamageProgress<double>
    go_on(const double equivalent_stress,
          CurveMemory &memory,
          const double band,
          const double followed = 1.,
          const double held     = 1.) const;

    /** Strain of the elastic limit. */
    double
    elastic_limit(const double band) const
    {
      return strength_factor(band) * nodes[0].stress / young_modulus;
    }

    /**
     * Factor on the stresses, and its inverse on the displacements, which keeps
     * the energy. The factor is below one where the band is so wide that a
     * crack that opens along a straight line releases more elastic energy
     * around it than it takes (snap-back).
     */
    template <typename Number>
    Number
    strength_factor(const Number &band) const
    {
      return std::min(Number(1.), Number(std::sqrt(Number(widest / band))));
    }

    /**
     * Ratio of a uniaxial stress [Pa] to the elastic limit. Where the strength
     * factor is below one, this is an upper bound without its root, by sqrt(x)
     * <= (1 + x)/2.
     */
    template <typename Number>
    Number
    yield_ratio(const Number &stress, const Number &band) const
    {
      return inverse_limit * stress *
             std::max(Number(1.), Number(0.5 + half_inverse_widest * band));
    }

    /** Factor on the strength of a cell of this size [m] at the tip of a crack.
     */
    double
    tip_strength(const double cell_size) const
    {
      return strength_at_tip(cell_size, failure().crack_length);
    }

    TensileFailure
    failure() const
    {
      return {nodes[peak].stress, widest / snap_back};
    }

    /**
     * Share of a straight line of the same energy in the falling branch: above
     * zero where the band is so wide that the steepest piece of the curve
     * itself would snap back.
     */
    double
    straightness(const double band) const;

    /** Energy of the displacements, per area of the crack [J/m2]. */
    static double
    energy(const std::vector<Node> &nodes);

    /** Nodes with displacements such that their energy is @p energy. */
    static std::vector<Node>
    scaled_to(std::vector<Node> nodes, const double energy);

    /** sigma = f exp(-w f / G) for a strength f [Pa] and an energy G [J/m2], to
     *  1 % of f and then straight to zero. */
    static std::vector<Node>
    exponential(const double strength, const double energy);

    /** A clause for the log if the failure @p what, which begins at @p
     *  strength, snaps back in cells of this length [m]; else empty. */
    std::string
    remark(const double       element_length,
           const std::string &what     = "a crack",
           const std::string &strength = "tensile strength") const;

    /** Parses "strain or displacement: stress, ...", beginning at 0; @p place
     *  names the entry. */
    static std::vector<std::pair<double, double>>
    parse(const std::string &table, const std::string &place);

  private:
    /** The curve of a band, over the effective strain. */
    struct OfBand
    {
      const SofteningCurve &curve;
      double                band, factor, share;

      /** The node that ends the straight piece at this strain; beyond the last
       *  node, where the stress is constant, the number of nodes. */
      unsigned int
      piece_at(const double strain) const;

      /** Effective strain at a node. */
      double
      strain(const unsigned int node) const;

      /** The point at this strain on the straight piece before a node. */
      Point
      on_piece(const unsigned int node, const double strain) const;

      /** The point of a node at its own strain. */
      Point
      at_node(const unsigned int node, const double strain) const;

      Point
      elastic(const double stress, const double strain) const;
    };

    OfBand
    of_band(const double band) const
    {
      return {*this, band, strength_factor(band), straightness(band)};
    }

    // of which 2 E Gf / ft^2 is the width at which a straight line snaps back
    static constexpr double snap_back = 1.8;

    std::vector<Node> nodes;
    double            young_modulus = 1., irreversible_share = 0.;
    double            stretch  = 1.; // effective over uniaxial inelastic strain
    unsigned int      peak     = 0;  // node
    double            straight = 0.; // displacement over loss of stress [m/Pa]
    double            widest_of_curve = 0., widest = 0.;
    double            inverse_limit = 0., half_inverse_widest = 0.;
    bool              is_followed_exactly = false;
  };

  /** Entries of the laws that crack in tension. */
  struct TensileCrack
  {
    double tensile_strength = 2.5e6; // ft [Pa]
    double fracture_energy  = 250.;  // Gf [N/m]

    void
    declare_parameters(dealii::ParameterHandler &prm);
  };
} // namespace Voussoir

#endif
