#ifndef voussoir_fem_lumped_mass_h
#define voussoir_fem_lumped_mass_h

#include <voussoir/fem/discretization.h>

#include <deal.II/fe/fe_values.h>

namespace Voussoir
{
  /**
   * The diagonal mass matrix by quadrature at the Gauss-Lobatto nodes; the mass
   * at a hanging node is distributed to the nodes that it hangs on.
   */
  class LumpedMass
  {
  public:
    /**
     * @param density        of each material [kg/m3]
     * @param driven_density the part of it that an inertial earthquake force
     *                       (rigid base) acts on [kg/m3]
     */
    LumpedMass(const Discretization      &discretization,
               const std::vector<double> &density,
               const std::vector<double> &driven_density);

    /** Mass of each degree of freedom [kg], zero where fixed. */
    Vector mass;

    /** Its inverse [1/kg], zero where fixed. */
    Vector inverse;

    /** Mass that an inertial earthquake force acts on [kg]. */
    const Vector &
    driven() const
    {
      return part.size() > 0 ? part : mass;
    }

  private:
    Vector part; // that is driven, unless all of it is

  public:
    /** Mass of each material [kg]. */
    std::vector<double> total;
  };

  /** Gauss-Lobatto weight times Jacobian at each node of a cell [m3]. */
  class NodalVolumes
  {
  public:
    explicit NodalVolumes(const Discretization &discretization);

    const std::vector<double> &
    of(const dealii::Triangulation<3>::active_cell_iterator &cell);

  private:
    dealii::FEValues<3>       values;
    const bool                from_corners; // of degree 1
    std::vector<unsigned int> node_of_point;
    std::vector<double>       volumes;
  };
} // namespace Voussoir

#endif
