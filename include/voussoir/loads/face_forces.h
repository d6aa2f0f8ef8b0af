#ifndef voussoir_loads_face_forces_h
#define voussoir_loads_face_forces_h

#include <voussoir/fem/discretization.h>

#include <limits>

namespace Voussoir
{
  /** A force on an owned node. */
  struct NodalForce
  {
    unsigned int         node;
    dealii::Tensor<1, 3> force; // [N]
  };

  /** Force per area at a point with this outward normal [Pa]. */
  using Traction =
    std::function<dealii::Tensor<1, 3>(const dealii::Point<3> &,
                                       const dealii::Tensor<1, 3> &)>;

  /**
   * The nodal forces of a traction on faces, integrated by Gauss points.
   *
   * @param sets  face sets, at least one; @p place names the entry in messages
   * @param kink elevation at which the traction begins or ends [m]; the parts
   *   of a face above and below are integrated separately
   */
  std::vector<NodalForce>
  face_forces(const Discretization           &discretization,
              const std::vector<std::string> &sets,
              const std::string              &place,
              const Traction                 &traction,
              const double kink = std::numeric_limits<double>::infinity());

  /**
   * The nodal forces of a pressure against faces that is zero above @p level
   * [m] and grows by @p gradient [Pa/m] below.
   */
  std::vector<NodalForce>
  depth_pressure_forces(const Discretization           &discretization,
                        const std::vector<std::string> &sets,
                        const std::string              &place,
                        const double                    level,
                        const double                    gradient);

  /** The resultant of the same pressure by areas and depths of small parts of
   *  the faces, which are bilinear between their corners [N]. */
  dealii::Tensor<1, 3>
  depth_pressure_resultant(const Discretization           &discretization,
                           const std::vector<std::string> &sets,
                           const std::string              &place,
                           const double                    level,
                           const double                    gradient);

  /** Adds the forces to a vector of all nodes. */
  void
  add_to(Vector &vector, const std::vector<NodalForce> &forces);
} // namespace Voussoir

#endif
