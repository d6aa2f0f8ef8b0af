#ifndef voussoir_output_sliding_block_h
#define voussoir_output_sliding_block_h

#include <voussoir/constraints/contact.h>
#include <voussoir/materials/solid.h>

#include <array>
#include <limits>

namespace Voussoir
{
  /** A block that rests on surfaces of contact, such as an abutment block. */
  struct SlidingBlock
  {
    /** A surface taken as a plane. */
    struct Plane
    {
      unsigned int         surface;
      double               side;   // 1 if the block is on the second one, or -1
      dealii::Tensor<1, 3> normal; // area mean, into the block
    };

    std::string        name; // of its cell set
    std::vector<Plane> planes;
    double             volume = 0.; // [m3]
    double weight = 0.; // by density, whatever loads the case has [N]
    double mass   = 0.; // that has inertia [kg]
  };

  /**
   * Reads "block: surface, surface; ..." with the cell sets of the blocks.
   * Called on all ranks. Throws UserError if a name is unknown, or a block is
   * not on one side of its surfaces; @p place names the entry.
   */
  std::vector<SlidingBlock>
  find_sliding_blocks(const std::string &text,
                      const std::string &place,
                      const Solid       &solid,
                      const Contact     &contact);

  /** A plane with its strength. */
  struct SlidingPlane
  {
    dealii::Tensor<1, 3> normal; // into the block
    double               friction = 0.;
    double               cohesion = 0.; // with its bond, times area [N]
  };

  /**
   * Safety of a rigid block against sliding by limit equilibrium: (sum of f_i
   * N_i + c_i A_i) / T . The resultant follows from statics, however uneven the
   * distribution of the contact forces is. It is resolved into a force T
   * opposite to the sliding, and normal forces N_i of the planes on which the
   * block then slides: along one plane, or along the line where two of them
   * meet (Londe, 1973). The mode of sliding follows from block theory (Goodman
   * and Shi, 1985): no normal force pulls, and the motion does not lead into
   * another plane.
   *
   * @param planes those with contact; parallel planes are considered one by one
   * @param force  on the block in equilibrium with the driving forces [N]
   * @return 0 if the block lifts off, infinity if there is no driving force
   */
  double
  sliding_safety(const std::vector<SlidingPlane> &planes,
                 const dealii::Tensor<1, 3>      &force);

  /** The history of a safety factor in four numbers. */
  class SafetyHistory
  {
  public:
    /** @param interval since the sample before [s]
     *  @return whether it is the smallest so far */
    bool
    add(const double time, const double interval, const double safety);

    /** The numbers; infinite ones are null. */
    nlohmann::json
    summary() const;

    /** For a checkpoint. */
    std::array<double, 4>
    save() const;

    void
    load(const std::array<double, 4> &saved);

  private:
    double at_start         = std::numeric_limits<double>::quiet_NaN();
    double smallest         = std::numeric_limits<double>::infinity();
    double time_of_smallest = 0., time_at_one = 0.; // [s]
  };

  /** Conversion of a number to JSON, which has no infinity, and back. */
  double
  json_number(const double value);

  double
  from_json_number(const double value);
} // namespace Voussoir

#endif
