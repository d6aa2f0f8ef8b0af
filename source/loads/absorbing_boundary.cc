#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/face_nodes.h>
#include <voussoir/loads/absorbing_boundary.h>

#include <deal.II/base/quadrature_lib.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  void
  BoundaryParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Fixed",
                      fixed,
                      "Face sets that do not move (relative to the ground, if "
                      "the earthquake enters through a rigid base).");
    prm.add_parameter("Roller",
                      roller,
                      "Face sets that do not move at right angles to "
                      "themselves; planes of constant x, y or z.");
    prm.add_parameter("Absorbing",
                      absorbing,
                      "Face sets that let waves out, and the earthquake in.");
    prm.add_parameter(
      "Absorbing type",
      absorbing_type,
      "Dashpots alone, or springs beside them, which keep the model in place "
      "and suit waves that spread from the dam.",
      Patterns::Selection("viscous|viscous-spring"));
    prm.add_parameter(
      "Coefficients",
      coefficients,
      "Normal and tangential spring per area, with the distance r: paper "
      "E/2r, G/2r; Liu 3D 4/3 G/r, 2/3 G/r; Liu 2D G/r, G/2r; Deeks-Randolph "
      "G/r, G/2r; Du-Zhao (lambda+2G)/1.8r, G/1.8r with dashpots 1.1 rho c. "
      "The others have dashpots rho c.",
      Patterns::Selection("paper|Liu 3D|Liu 2D|Deeks-Randolph|Du-Zhao"));
    prm.add_parameter("Source point",
                      source,
                      "Where scattered waves come from, x, y, z [m]: the "
                      "springs go by the distance from here.");
    prm.add_parameter("Radius",
                      radius,
                      "The distance itself, for all nodes [m]; 0 to measure it "
                      "from the source point.",
                      Patterns::Double(0.));
  }


  void
  BoundaryParameters::check(const Grid &grid) const
  {
    std::map<std::string, std::string> kind_of_set;
    for (const auto &[kind, list] : std::map<std::string, std::string>{
           {"Fixed", fixed}, {"Roller", roller}, {"Absorbing", absorbing}})
      for (const std::string &set : split_list(list))
        {
          grid.check_face_set(set,
                              "\"" + kind + "\" in section \"Boundaries\"");
          const auto [place, is_new] = kind_of_set.emplace(set, kind);
          if (!is_new)
            throw UserError("In section \"Boundaries\" the face set \"" + set +
                            "\" is named twice, as \"" + place->second +
                            "\" and as \"" + kind + "\"; keep one of them.");
        }
  }


  std::vector<Support>
  BoundaryParameters::supports() const
  {
    std::vector<Support> result;
    for (const std::string &set : split_list(fixed))
      result.push_back({set, false});
    for (const std::string &set : split_list(roller))
      result.push_back({set, true});
    return result;
  }


  void
  WaveParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Enters through",
      enters_through,
      "Absorbing boundary: as a wave, by forces on the boundary. Rigid base: "
      "as inertial forces on a model with fixed base; the motion computed is "
      "then relative to the base.",
      Patterns::Selection("absorbing boundary|rigid base"));
    prm.add_parameter(
      "Type",
      type,
      "Vertical: x and y components travel upwards as S waves, z as a P wave, "
      "through the layers at the model's sides. Oblique waves come in a "
      "homogeneous half-space; their motion is the first component given.",
      Patterns::Selection("vertical|oblique P|oblique SV|oblique SH"));
    prm.add_parameter("Angle",
                      angle,
                      "Oblique waves: angle between the direction of travel "
                      "and the vertical [degrees].",
                      Patterns::Double(0., 89.));
    prm.add_parameter("Azimuth",
                      azimuth,
                      "Oblique waves: horizontal direction of travel, from x "
                      "towards y [degrees].",
                      Patterns::Double(-360., 360.));
    prm.add_parameter(
      "Maximum frequency",
      maximum_frequency,
      "For motions given at the free surface: what lies above is removed when "
      "the wave at the base is computed from it [Hz].",
      Patterns::Double(1.));
  }


  BoundaryCoefficients
  BoundaryCoefficients::of(const std::string      &absorbing_type,
                           const std::string      &set,
                           const ElasticConstants &rock)
  {
    const double G = rock.shear_modulus();
    const double E = rock.young_modulus;
    const double M = rock.lame_lambda() + 2. * G;
    // physics A2: normal spring r, tangential spring r, factor on rho c
    const std::map<std::string, std::array<double, 3>> sets{
      {"paper", {{E / 2., G / 2., 1.}}},
      {"Liu 3D", {{4. / 3. * G, 2. / 3. * G, 1.}}},
      {"Liu 2D", {{G, G / 2., 1.}}},
      {"Deeks-Randolph", {{G, G / 2., 1.}}},
      {"Du-Zhao", {{M / 1.8, G / 1.8, 1.1}}}};
    const auto &[normal, tangential, dashpot] = sets.at(set);
    const double springs = absorbing_type == "viscous" ? 0. : 1.;
    const double factor  = absorbing_type == "viscous" ? 1. : dashpot;
    return {springs * normal,
            springs * tangential,
            factor * rock.density * rock.p_wave_speed(),
            factor * rock.density * rock.s_wave_speed()};
  }


  AbsorbingBoundary::AbsorbingBoundary(
    const Discretization                                  &discretization,
    const BoundaryParameters                              &parameters,
    const std::vector<const Material *>                   &materials,
    const std::function<unsigned int(const Grid::Cell &)> &material_of_cell,
    const std::string                                     &quadrature,
    NodalTerms                                            &terms)
  {
    const Grid &grid   = discretization.grid;
    const auto &scalar = discretization.fe.base_element(0);

    // springs and dashpots at the nodes, tractions at the points at which the
    // cells integrate, so that a column on the same levels is followed exactly
    const Quadrature<2> traction_points =
      quadrature == "Gauss-Lobatto" ?
        static_cast<Quadrature<2>>(
          QGaussLobatto<2>(discretization.degree + 1)) :
        static_cast<Quadrature<2>>(QGauss<2>(discretization.degree + 1));
    FaceNodes       face_nodes(discretization.mapping, scalar);
    FEFaceValues<3> at_points(discretization.mapping,
                              scalar,
                              traction_points,
                              update_values | update_quadrature_points |
                                update_normal_vectors | update_JxW_values);

    struct Stiffness
    {
      NodalTerms::Matrix spring, dashpot;
    };
    using Traction = BoundaryGeometry::Contribution;
    std::vector<std::pair<types::global_dof_index, Stiffness>> stiffnesses;
    std::vector<std::pair<types::global_dof_index, Traction>>  tractions;
    std::set<unsigned int>                                     touching;
    Point<3> lower(1e300, 1e300, 1e300), upper(-1e300, -1e300, -1e300);

    const auto visit = [&](const auto &cell, const unsigned int face) {
      const unsigned int material = material_of_cell(cell);
      const auto         coefficients =
        BoundaryCoefficients::of(parameters.absorbing_type,
                                 parameters.coefficients,
                                 materials[material]->elastic_constants());
      touching.insert(material);

      at_points.reinit(cell, face);
      const auto nodes =
        discretization.cell_nodes(discretization.dof_cell(cell));
      for (const auto &[j, x, n, face_area] : face_nodes.of(cell, face))
        {
          const double r = parameters.radius > 0. ?
                             parameters.radius :
                             x.distance(parameters.source);
          if (coefficients.normal_spring > 0. && r < 1e-6)
            throw UserError(
              "\"Source point\" in section \"Boundaries\" lies on "
              "the absorbing boundary, where its springs would be "
              "infinite; move it to the dam, or give a \"Radius\".");
          for (unsigned int d = 0; d < 3; ++d)
            {
              lower[d] = std::min(lower[d], x[d]);
              upper[d] = std::max(upper[d], x[d]);
            }
          const NodalTerms::Matrix normal = symmetrize(outer_product(n, n));
          const NodalTerms::Matrix tangential =
            unit_symmetric_tensor<3>() - normal;
          for (const auto &share : discretization.carriers(nodes[j]))
            {
              const double area        = face_area * share.weight;
              const double spring_area = r > 0. ? area / r : 0.;
              stiffnesses.push_back(
                {share.node,
                 {spring_area * (coefficients.normal_spring * normal +
                                 coefficients.tangential_spring * tangential),
                  area * (coefficients.normal_dashpot * normal +
                          coefficients.tangential_dashpot * tangential)}});
              for (const unsigned int q : at_points.quadrature_point_indices())
                tractions.push_back(
                  {share.node,
                   {0,
                    at_points.quadrature_point(q),
                    share.weight * at_points.shape_value(j, q) *
                      at_points.normal_vector(q) * at_points.JxW(q),
                    cell->face(face)->center()[2]}});
            }
        }
    };
    for (const std::string &set : split_list(parameters.absorbing))
      grid.for_each_face(set, visit);

    std::map<unsigned int, unsigned int> boundary_number;
    for (const auto &[node, record] :
         discretization.send_to_owners(stiffnesses))
      {
        const auto [place, is_new] =
          boundary_number.emplace(node, boundary.nodes.size());
        if (is_new)
          {
            boundary.nodes.push_back(discretization.node_positions[node]);
            slots.push_back(terms.add_node(node));
            springs.emplace_back();
            dashpots.emplace_back();
          }
        springs[place->second] += record.spring;
        dashpots[place->second] += record.dashpot;
      }
    for (unsigned int i = 0; i < slots.size(); ++i)
      {
        terms.springs[slots[i]] += springs[i];
        terms.dashpots[slots[i]] += dashpots[i];
      }
    for (auto [node, contribution] : discretization.send_to_owners(tractions))
      {
        contribution.node = boundary_number.at(node);
        boundary.contributions.push_back(contribution);
      }

    for (unsigned int d = 0; d < 3; ++d)
      {
        box.first[d]  = Utilities::MPI::min(lower[d], grid.communicator());
        box.second[d] = Utilities::MPI::max(upper[d], grid.communicator());
      }
    const std::vector<unsigned int> touching_here(touching.begin(),
                                                  touching.end());
    for (const auto material :
         join_over_ranks(touching_here, grid.communicator()))
      touching.insert(material);
    touching_materials.assign(touching.begin(), touching.end());

    // Levels of the sides, from the absorbing faces if they reach around the
    // model, else from all its vertical outer faces.
    const auto collect = [&](const auto &cell, const unsigned int face) {
      at_points.reinit(cell, face);
      if (std::abs(at_points.normal_vector(0)[2]) > 0.1)
        return;
      SideFace side{1e300, -1e300, 0., material_of_cell(cell)};
      for (const unsigned int q : at_points.quadrature_point_indices())
        side.area += at_points.JxW(q);
      for (unsigned int v = 0; v < 4; ++v)
        {
          const double z = cell->face(face)->vertex(v)[2];
          side.lower     = std::min(side.lower, z);
          side.upper     = std::max(side.upper, z);
        }
      sides.push_back(side);
    };
    for (const std::string &set : split_list(parameters.absorbing))
      grid.for_each_face(set, collect);
    if (Utilities::MPI::sum(sides.size(), grid.communicator()) == 0)
      for (const auto &cell : grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int face : cell->face_indices())
            if (cell->at_boundary(face))
              collect(cell, face);
    sides = join_over_ranks(sides, grid.communicator());
  }


  void
  AbsorbingBoundary::set_free_field(std::unique_ptr<FreeField> &&free_field)
  {
    field = std::move(free_field);
  }


  const BoundaryGeometry &
  AbsorbingBoundary::geometry() const
  {
    return boundary;
  }


  const std::vector<SideFace> &
  AbsorbingBoundary::side_faces() const
  {
    return sides;
  }


  const std::pair<Point<3>, Point<3>> &
  AbsorbingBoundary::extent() const
  {
    return box;
  }


  const std::vector<unsigned int> &
  AbsorbingBoundary::materials_at_boundary() const
  {
    return touching_materials;
  }


  void
  AbsorbingBoundary::add_forces(const double time, NodalTerms &terms)
  {
    if (!field)
      return;
    field->advance(time);
    for (unsigned int i = 0; i < slots.size(); ++i)
      terms.forces[slots[i]] += springs[i] * field->displacement[i] +
                                dashpots[i] * field->velocity[i] +
                                field->force[i];
  }


  void
  AbsorbingBoundary::replay(const double time)
  {
    if (field)
      field->replay(time);
  }
} // namespace Voussoir
