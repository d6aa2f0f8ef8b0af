#ifndef voussoir_output_interface_faces_h
#define voussoir_output_interface_faces_h

#include <voussoir/constraints/contact.h>
#include <voussoir/fem/point_weights.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** The contact point that is nearest to a named place. */
  struct NearestContactPoint
  {
    std::string      name;
    dealii::Point<3> position; // [m]
    unsigned int     surface;
    bool             is_mine; // whether this rank has it,
    unsigned int     number;  // under this number
  };

  /** Largest opening and slip of a contact point [m]. */
  using InterfaceExtremes = std::array<double, 2>;

  /** For each place the nearest point of any interface; the same on all ranks
   *  but for `is_mine`. All ranks must call this together. */
  std::vector<NearestContactPoint>
  find_contact_points(const Contact                 &contact,
                      const std::vector<NamedPoint> &places,
                      const MPI_Comm                 communicator);

  /**
   * Writes interface_envelopes.vtu: on the faces of the first side of all
   * interfaces their number, the largest opening and slip, the slip now [mm],
   * and the state now as a number (see `ResultNames::interface_states`). Where
   * an interface ends inside the body all but the number are zero.
   *
   * @param extremes of the points of this rank [m]
   * @param time     [s]
   */
  void
  write_interface_envelopes(const ObservedRun                    &run,
                            const std::vector<InterfaceExtremes> &extremes,
                            const double                          time);
} // namespace Voussoir

#endif
