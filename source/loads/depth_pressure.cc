#include <voussoir/base/error.h>
#include <voussoir/base/gravity.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/loads/face_forces.h>
#include <voussoir/loads/load.h>
#include <voussoir/loads/water_level.h>

#include <deal.II/base/numbers.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** A pressure that grows with the depth below a level. */
    class DepthPressure : public Load
    {
    public:
      /** @param surface noun for the description of the level */
      explicit DepthPressure(const std::string &surface)
        : surface(surface)
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter(
          "Face sets",
          face_sets,
          "Face sets under the pressure, which is normal to them: one side of "
          "the dam, and optionally the canyon.");
        prm.add_parameter("Level",
                          level,
                          "Elevation of the " + surface +
                            " [m]; must be given." + usually(Usual::elevation));
      }

      bool
      steady() const override
      {
        return true;
      }

      void
      prepare(const Solid         &solid,
              const ParameterFile &file,
              const std::string   &place,
              Log                 &log) override
      {
        if (file.given(place + "/Level").empty())
          throw UserError("Section \"" + place +
                          "\" has no \"Level\"; give the elevation of the " +
                          surface + " [m].");
        const auto        sets    = split_list(face_sets);
        const std::string section = " in section \"" + place + "\"";
        check_level(solid.discretization,
                    sets,
                    "\"Face sets\"" + section,
                    level,
                    "\"Level\"" + section,
                    log);
        forces      = depth_pressure_forces(solid.discretization,
                                       sets,
                                       "\"Face sets\"" + section,
                                       level,
                                       gradient());
        of_geometry = depth_pressure_resultant(solid.discretization,
                                               sets,
                                               "\"Face sets\"" + section,
                                               level,
                                               gradient());
      }

      std::optional<Tensor<1, 3>>
      resultant_of_geometry() const override
      {
        return of_geometry;
      }

      void
      add_steady_force(Vector &force) const override
      {
        add_to(force, forces);
      }

    private:
      /** Growth of the pressure with depth [Pa/m]. */
      virtual double
      gradient() const = 0;

      const std::string       surface;
      std::string             face_sets = "upstream face";
      double                  level     = 0.;
      std::vector<NodalForce> forces;
      Tensor<1, 3>            of_geometry; // resultant by areas and depths [N]
    };


    /** p = rho g h. */
    class Water : public DepthPressure
    {
    public:
      Water()
        : DepthPressure("water surface")
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        DepthPressure::declare_parameters(prm);
        prm.add_parameter("Density",
                          density,
                          "Density of the water [kg/m3]." +
                            usually(Usual::water_density),
                          Patterns::Double(0.));
        prm.add_parameter("Gravity",
                          gravity,
                          "Acceleration of gravity [m/s2]." +
                            usually(Usual::water_gravity),
                          Patterns::Double(0.));
      }

    private:
      double
      gradient() const override
      {
        return density * gravity;
      }

      double density = 1000., gravity = standard_gravity;
    };

    const Registry<Load>::Add<Water>
      registered_water("water",
                       "Hydrostatic pressure of the reservoir or tailwater.");


    /** Rankine's active pressure of a soil without cohesion,
     *  p = gamma' h tan^2(45 deg - phi/2). */
    class Silt : public DepthPressure
    {
    public:
      Silt()
        : DepthPressure("top of the silt")
      {}

      void
      declare_parameters(ParameterHandler &prm) override
      {
        DepthPressure::declare_parameters(prm);
        prm.add_parameter(
          "Buoyant unit weight",
          unit_weight,
          "Weight of the silt per volume less its buoyancy [N/m3]; 8e3 to "
          "11e3. Pore water belongs to the load of the water." +
            usually(Usual::silt_weight),
          Patterns::Double(0.));
        prm.add_parameter(
          "Friction angle",
          friction_angle,
          "Angle of friction of the silt [degrees]; 10 to 20, 0 for a liquid." +
            usually(Usual::silt_friction_angle),
          Patterns::Double(0., 60.));
      }

    private:
      double
      gradient() const override
      {
        const double root =
          std::tan((45. - 0.5 * friction_angle) * numbers::PI / 180.);
        return unit_weight * root * root;
      }

      double unit_weight = 9e3, friction_angle = 15.;
    };

    const Registry<Load>::Add<Silt>
      registered_silt("silt",
                      "Active pressure of the sediment before the dam.");
  } // namespace
} // namespace Voussoir
