#include <voussoir/base/box_of_ranks.h>
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
  AbsorbingParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Absorbing",
      face_sets,
      "Face sets through which waves leave and the earthquake enters.");
    add_option(
      prm,
      "Absorbing type",
      type,
      "Dashpots alone, or dashpots and springs; springs keep the model in "
      "place and suit waves that spread from the dam.");
    add_option(
      prm,
      "Coefficients",
      coefficients,
      "Normal and tangential spring per area, with the distance r: paper E/2r, "
      "G/2r; Liu 3D 4/3 G/r, 2/3 G/r; Liu 2D G/r, G/2r; Deeks-Randolph G/r, "
      "G/2r; Du-Zhao (lambda+2G)/1.8r, G/1.8r with dashpots 1.1 rho c. The "
      "other sets have dashpots rho c.");
    prm.add_parameter(
      "Source point",
      source,
      "Source of scattered waves, x, y, z [m]: the stiffness of springs "
      "follows from the distance to this point.");
    prm.add_parameter(
      "Radius",
      radius,
      "One distance r for all nodes [m]; 0: the distance from the source "
      "point.",
      Patterns::Double(0.));
  }


  namespace
  {
    using Matrix       = NodalTerms::Matrix;
    using Cell         = Triangulation<3>::active_cell_iterator;
    using Contribution = BoundaryGeometry::Contribution;


    /** Springs and dashpots per area. */
    struct BoundaryCoefficients
    {
      double normal_spring;     // times 1/r: [Pa]
      double tangential_spring; // times 1/r: [Pa]
      double normal_dashpot;    // [Pa s/m]
      double tangential_dashpot;
    };


    /** The coefficients that the parameters choose, for this rock. */
    BoundaryCoefficients
    coefficients_for(const AbsorbingParameters &parameters,
                     const ElasticConstants    &rock)
    {
      const double G = rock.shear_modulus();
      const double E = rock.young_modulus;
      const double M = rock.lame_lambda() + 2. * G;
      // normal spring r, tangential spring r, factor on rho c
      const std::map<SpringCoefficients, std::array<double, 3>> sets{
        {SpringCoefficients::paper, {{E / 2., G / 2., 1.}}},
        {SpringCoefficients::liu_3d, {{4. / 3. * G, 2. / 3. * G, 1.}}},
        {SpringCoefficients::liu_2d, {{G, G / 2., 1.}}},
        {SpringCoefficients::deeks_randolph, {{G, G / 2., 1.}}},
        {SpringCoefficients::du_zhao, {{M / 1.8, G / 1.8, 1.1}}}};
      const auto &[normal, tangential, dashpot] =
        sets.at(parameters.coefficients);
      const bool   viscous = parameters.type == AbsorbingType::viscous;
      const double springs = viscous ? 0. : 1.;
      const double factor  = viscous ? 1. : dashpot;
      return {springs * normal,
              springs * tangential,
              factor * rock.density * rock.p_wave_speed(),
              factor * rock.density * rock.s_wave_speed()};
    }


    /** Springs [N/m] and dashpots [N s/m] of a part of a face. */
    struct Stiffness
    {
      Matrix spring, dashpot;
    };


    /**
     * t = -(K u + C v) for an area with a normal.
     *
     * @param distance of the waves' source [m], or zero without springs
     */
    Stiffness
    stiffness_of(const BoundaryCoefficients &coefficients,
                 const Tensor<1, 3>         &n,
                 const double                area,
                 const double                distance)
    {
      const Matrix normal      = symmetrize(outer_product(n, n));
      const Matrix tangential  = unit_symmetric_tensor<3>() - normal;
      const double spring_area = distance > 0. ? area / distance : 0.;
      return {spring_area * (coefficients.normal_spring * normal +
                             coefficients.tangential_spring * tangential),
              area * (coefficients.normal_dashpot * normal +
                      coefficients.tangential_dashpot * tangential)};
    }


    /** The faces of the boundary on this rank. */
    struct BoundaryFaces
    {
      const Solid                   &solid;
      const std::vector<std::string> sets;

      void
      visit(const std::function<void(const Cell &, const unsigned int)>
              &function) const
      {
        for (const std::string &set : sets)
          solid.grid().for_each_face(set, function);
      }

      const FiniteElement<3> &
      scalar() const
      {
        return solid.discretization.fe.base_element(0);
      }
    };


    std::vector<unsigned int>
    find_touching_materials(const BoundaryFaces &faces)
    {
      std::set<unsigned int> mine;
      faces.visit([&](const Cell &cell, const unsigned int) {
        mine.insert(faces.solid.grid().material(cell));
      });
      const auto all =
        join_over_ranks(std::vector<unsigned int>(mine.begin(), mine.end()),
                        faces.solid.grid().communicator());
      const std::set<unsigned int> ordered(all.begin(), all.end());
      return {ordered.begin(), ordered.end()};
    }


    std::pair<Point<3>, Point<3>>
    find_extent(const BoundaryFaces &faces)
    {
      FaceNodes  face_nodes(faces.solid.discretization.mapping, faces.scalar());
      BoxOfRanks box;
      faces.visit([&](const Cell &cell, const unsigned int face) {
        for (const FaceNode &node : face_nodes.of(cell, face))
          box.add(node.position);
      });
      box.join(faces.solid.grid().communicator());
      return {box.lower, box.upper};
    }


    /** Distance r of a node from the source of scattered waves [m]. */
    double
    source_distance(const AbsorbingParameters  &parameters,
                    const BoundaryCoefficients &coefficients,
                    const Point<3>             &node)
    {
      const double r = parameters.radius > 0. ?
                         parameters.radius :
                         node.distance(parameters.source);
      if (coefficients.normal_spring > 0. && r < 1e-6)
        throw UserError("\"Source point\" in section \"Boundaries\" lies on "
                        "the absorbing boundary, where its springs would be "
                        "infinite; move it to the dam, or give a \"Radius\".");
      return r;
    }


    /** Springs and dashpots at the owned nodes, by quadrature at the nodes;
     *  more than one record of a node where faces meet. */
    std::vector<std::pair<unsigned int, Stiffness>>
    find_stiffnesses(const BoundaryFaces       &faces,
                     const AbsorbingParameters &parameters)
    {
      const Discretization &discretization = faces.solid.discretization;
      FaceNodes             face_nodes(discretization.mapping, faces.scalar());
      std::vector<std::pair<types::global_dof_index, Stiffness>> records;
      faces.visit([&](const Cell &cell, const unsigned int face) {
        const auto coefficients =
          coefficients_for(parameters,
                           faces.solid.material_of(cell).elastic_constants());
        const auto nodes =
          discretization.cell_nodes(discretization.dof_cell(cell));
        for (const auto &[j, x, normal, area] : face_nodes.of(cell, face))
          {
            const double r = source_distance(parameters, coefficients, x);
            for (const auto &share : discretization.carriers(nodes[j]))
              records.push_back(
                {share.node,
                 stiffness_of(coefficients, normal, area * share.weight, r)});
          }
      });
      return discretization.send_to_owners(records);
    }


    /** Contributions of the points of the boundary to the traction integrals of
     *  the owned nodes. */
    std::vector<std::pair<unsigned int, Contribution>>
    find_tractions(const BoundaryFaces &faces, FEFaceValues<3> &at_points)
    {
      const Discretization &discretization = faces.solid.discretization;
      std::vector<std::pair<types::global_dof_index, Contribution>> records;
      std::size_t                                                   n_faces = 0;
      faces.visit([&](const Cell &, const unsigned int) { ++n_faces; });
      records.reserve(n_faces * at_points.n_quadrature_points *
                      faces.scalar().n_dofs_per_face());
      faces.visit([&](const Cell &cell, const unsigned int face) {
        at_points.reinit(cell, face);
        const double middle = cell->face(face)->center()[2];
        const auto   nodes =
          discretization.cell_nodes(discretization.dof_cell(cell));
        for (unsigned int j = 0; j < nodes.size(); ++j)
          if (faces.scalar().has_support_on_face(j, face))
            for (const auto &share : discretization.carriers(nodes[j]))
              for (const unsigned int q : at_points.quadrature_point_indices())
                records.push_back(
                  {share.node,
                   {0,
                    at_points.quadrature_point(q),
                    share.weight * at_points.shape_value(j, q) *
                      at_points.normal_vector(q) * at_points.JxW(q),
                    middle}});
      });
      return discretization.send_to_owners(records);
    }


    /** The vertical faces of all ranks: the absorbing ones if they reach around
     *  the model, else all outer ones. */
    std::vector<SideFace>
    find_side_faces(const BoundaryFaces &faces, FEFaceValues<3> &at_points)
    {
      const Grid           &grid = faces.solid.grid();
      std::vector<SideFace> sides;
      const auto collect = [&](const Cell &cell, const unsigned int face) {
        at_points.reinit(cell, face);
        if (std::abs(at_points.normal_vector(0)[2]) > 0.1)
          return;
        SideFace side{1e300,
                      -1e300,
                      0.,
                      faces.solid.grid().material(cell),
                      cell->face(face)->center()};
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
      faces.visit(collect);
      if (Utilities::MPI::sum(sides.size(), grid.communicator()) == 0)
        for (const auto &cell : grid.triangulation().active_cell_iterators())
          if (cell->is_locally_owned())
            for (const unsigned int face : cell->face_indices())
              if (cell->at_boundary(face))
                collect(cell, face);
      sides = join_over_ranks(sides, grid.communicator());
      if (faces.solid.discretization.reproducible)
        std::sort(sides.begin(), sides.end(), [](const auto &a, const auto &b) {
          const auto all = [](const SideFace &side) {
            return std::make_tuple(side.lower,
                                   side.upper,
                                   side.material,
                                   side.area,
                                   side.middle[0],
                                   side.middle[1]);
          };
          return all(a) < all(b);
        });
      return sides;
    }
  } // namespace


  AbsorbingBoundary::AbsorbingBoundary(const Solid               &solid,
                                       const AbsorbingParameters &parameters,
                                       const QuadratureRule       quadrature)
  {
    const Discretization &discretization = solid.discretization;
    const BoundaryFaces   faces{solid, split_list(parameters.face_sets)};
    boundary.reproducible = discretization.reproducible;
    touching_materials    = find_touching_materials(faces);
    box                   = find_extent(faces);

    std::map<unsigned int, unsigned int> boundary_number; // of an owned node
    for (const auto &[node, stiffness] : find_stiffnesses(faces, parameters))
      {
        const auto [place, is_new] =
          boundary_number.emplace(node, boundary.nodes.size());
        if (is_new)
          {
            boundary.nodes.push_back(discretization.node_positions[node]);
            springs.push_back({node, {}, {}, {}});
          }
        springs[place->second].spring += stiffness.spring;
        springs[place->second].dashpot += stiffness.dashpot;
      }

    // the tractions at the points at which the cells integrate, so that the
    // model moves exactly as a column on the same levels
    const unsigned int  n_points = discretization.degree + 1;
    const Quadrature<2> points =
      quadrature == QuadratureRule::gauss_lobatto ?
        static_cast<Quadrature<2>>(QGaussLobatto<2>(n_points)) :
        static_cast<Quadrature<2>>(QGauss<2>(n_points));
    FEFaceValues<3> at_points(discretization.mapping,
                              faces.scalar(),
                              points,
                              update_values | update_quadrature_points |
                                update_normal_vectors | update_JxW_values);
    {
      const auto tractions = find_tractions(faces, at_points);
      boundary.contributions.reserve(tractions.size());
      for (const auto &[node, contribution] : tractions)
        {
          boundary.contributions.push_back(contribution);
          boundary.contributions.back().node = boundary_number.at(node);
        }
    }
    sides = find_side_faces(faces, at_points);
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


  const std::vector<NodalTerm> &
  AbsorbingBoundary::terms() const
  {
    return springs;
  }


  void
  AbsorbingBoundary::add_forces(const FreeField &field,
                                NodalForces     &forces) const
  {
    for (unsigned int i = 0; i < springs.size(); ++i)
      forces.add(springs[i].node,
                 springs[i].spring * field.displacement[i] +
                   springs[i].dashpot * field.velocity[i] + field.force[i]);
  }
} // namespace Voussoir
