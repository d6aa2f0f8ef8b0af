#ifndef voussoir_tests_crack_line_h
#define voussoir_tests_crack_line_h

#include <voussoir/driver/simulation.h>

#include <functional>
#include <string>
#include <vector>

namespace Voussoir
{
  /** Angle of the line through the cracks along planes of a slice to the x axis
   *  [degrees]: dz over dx of the points of the planes in cells whose largest
   *  opening is above a twentieth of the largest one, weighted by the root of
   *  their opening; of one rank.
   *
   *  @param counts whether a crack at this point counts */
  double
  angle_of_cracks(const Simulation &simulation,
                  const std::function<bool(const dealii::Point<3> &)> &counts);


  /** Largest mean over a time [s] of the force on the first constraint of the
   *  case, and the mean over that time at the end [N]; marches the run. */
  struct Pull
  {
    double largest, last;
  };

  Pull
  march_under_pull(Simulation &simulation, const double window);


  /** Writes a mesh in the current folder, on the first rank, and returns the
   *  entry that reads it.
   *
   *  @param write gets the name of the file */
  std::string
  entry_of_mesh(const std::string                              &name,
                const std::function<void(const std::string &)> &write,
                const MPI_Comm                                  communicator);


  /** The largest traction in z of the load "pull" under which a case has a
   *  static state, in the middle between the last one with and the first one
   *  without it [MPa]. */
  double
  largest_standing_pull(const ParameterFile &file,
                        const std::string   &mesh_entry,
                        const double         first,
                        const double         step,
                        const MPI_Comm       communicator);


  /** The largest velocity in 200 steps of a run [m/s]. */
  double
  fastest_in_steps(Run &run);
} // namespace Voussoir

#endif
