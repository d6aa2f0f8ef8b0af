#include <voussoir/driver/mesh_against_case.h>
#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <deal.II/base/bounding_box.h>

#include <set>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    using Faces = std::set<std::pair<unsigned int, unsigned int>>;


    void
    add_faces(Faces &faces, const CoarseMesh &mesh, const std::string &list)
    {
      for (const std::string &name : split_list(list))
        if (const auto set = mesh.face_sets.find(name);
            set != mesh.face_sets.end())
          for (const CoarseMesh::Face &face : set->second)
            faces.emplace(face.cell, face.face);
    }


    Faces
    faces_of(const CoarseMesh &mesh, const std::string &list)
    {
      Faces faces;
      add_faces(faces, mesh, list);
      return faces;
    }


    /** A mesh and the conditions of its case on the faces of its surface. */
    class MeshAgainstCase
    {
    public:
      MeshAgainstCase(const Case                      &parameters,
                      const CoarseMesh                &mesh,
                      const InterfaceSurfaces         &surfaces,
                      const std::vector<unsigned int> &material_of_cell,
                      Log                             &log)
        : parameters(parameters)
        , mesh(mesh)
        , material_of_cell(material_of_cell)
        , materials(parameters.material_list())
        , log(log)
        , box(mesh.vertices)
        , fixed(faces_of(mesh, parameters.boundaries.supports.fixed))
        , supported(fixed)
        , absorbs(materials.size(), false)
      {
        const auto &[supports, absorbing] = parameters.boundaries;
        for (const auto &[cell, face] : faces_of(mesh, absorbing.face_sets))
          {
            supported.emplace(cell, face);
            absorbs[material_of_cell[cell]] = true;
            const Tensor<1, 3> normal       = outward_area({cell, face});
            absorbs_sideways =
              absorbs_sideways || std::abs(normal[2]) < 0.5 * normal.norm();
          }
        for (const std::string &list :
             {supports.roller, supports.antisymmetric})
          add_faces(supported, mesh, list);

        for (const std::string &surface : surfaces.names())
          for (const std::string &side : {surface, surface + other_side})
            add_faces(used, mesh, side);
        for (const auto &object : parameters.loads.objects)
          add_faces(used, mesh, entry("Loads/" + object.first, "Face sets"));
        for (const auto &object : parameters.projections.objects)
          add_faces(used,
                    mesh,
                    entry("Constraints/" + object.first, "Face sets"));
      }

      /** Warns of a mesh in millimetres, whose lengths are a thousand times too
       *  large. */
      void
      check_size() const
      {
        constexpr double largest = 1e4; // [m]
        double           length  = 0.;
        for (unsigned int d = 0; d < 3; ++d)
          length = std::max(length, box.side_length(d));
        if (length > largest)
          log.warn("the mesh is ",
                   length,
                   " m long, more than any model of a dam; give lengths in m, "
                   "or \"Scale\" in section \"Mesh/file\" where a file has "
                   "millimetres");
      }

      /** Warns of supports that are not below the model. */
      void
      check_upward_axis() const
      {
        if (parameters.generator)
          return;
        Tensor<1, 3> sum; // of outward normals times areas
        double       area = 0.;
        for (const auto &[cell, face] : supported)
          {
            const Tensor<1, 3> normal = outward_area({cell, face});
            sum += normal;
            area += normal.norm();
          }
        if (-sum[1] > 0.1 * area &&
            -sum[1] > 3. * std::max(std::abs(sum[0]), std::abs(sum[2])))
          log.warn("the faces that section \"Boundaries\" names look towards "
                   "-y, as if y were upwards, but upwards is z; turn the mesh "
                   "so that its z axis points upwards");
      }

      /** Warns of free sides, which reflect waves. */
      void
      check_outer_sides() const
      {
        const Side bottom = find_side(2, 0);
        check_side(bottom);
        for (unsigned int d = 0; d < 2; ++d)
          {
            const std::array<Side, 2> sides{{find_side(d, 0), find_side(d, 1)}};
            for (unsigned int end = 0; end < 2; ++end)
              if (!check_side(sides[end]) && bottom.is_fixed() &&
                  sides[1 - end].is_fixed() &&
                  sides[end].free > 0.5 * sides[end].area)
                warn_of(sides[end]);
          }
      }

      /** Warns of rock with weight: rock that continues beyond the model has
       *  settled long ago, and rock without inertia must have no weight either.
       */
      void
      check_weight() const
      {
        for (const auto &object : parameters.loads.objects)
          {
            const std::string section = "Loads/" + object.first;
            if (entry(section, "Class") != "gravity" ||
                !split_list(entry(section, "Cell sets")).empty())
              continue;
            unsigned int n_others = 0, rock = materials.size();
            for (unsigned int m = 0; m < materials.size(); ++m)
              if (is_rock(m))
                rock = m;
              else
                ++n_others;
            if (n_others > 0 && rock < materials.size())
              log.warn(
                "\"Cell sets\" in section \"",
                section,
                "\" is empty, so that \"",
                parameters.materials.objects[rock].first,
                "\", ",
                absorbs[rock] ? "which continues beyond the model" :
                                "which is given less inertia",
                ", is loaded, too, and would settle under its weight; name "
                "the cell sets that have weight");
          }
      }

      /** Warns of water that presses on other faces than its added mass. */
      void
      check_water() const
      {
        if (parameters.reservoir.model != ReservoirModel::added_mass)
          return;
        const std::string sets     = parameters.reservoir.added_mass.face_sets;
        const Faces       swinging = faces_of(mesh, sets);
        std::string       other;
        for (const auto &object : parameters.loads.objects)
          {
            const std::string section = "Loads/" + object.first;
            if (entry(section, "Class") != "water")
              continue;
            const Faces pressed =
              faces_of(mesh,
                       parameters.file.given(section + "/Face sets",
                                             AddedMassParameters().face_sets));
            for (const auto &face : pressed)
              if (swinging.count(face) > 0)
                return;
            other = section;
          }
        if (!other.empty())
          log.warn("the water of section \"",
                   other,
                   "\" presses on none of the faces that have its added mass, "
                   "\"",
                   sets,
                   "\" by section \"Reservoir/added mass\"; name the upstream "
                   "face in both");
      }

    private:
      /** Faces that lie on a plane around the model. */
      struct Side
      {
        unsigned int axis, end;
        double       area = 0., fixed = 0.; // [m2]

        // areas without boundary condition and load: of all faces, and of rock
        double   free = 0., free_rock = 0.;
        Point<3> place; // of a free face

        bool
        is_fixed() const
        {
          return fixed > 0.5 * area;
        }
      };

      std::string
      entry(const std::string &section, const std::string &name) const
      {
        return parameters.file.given(section + "/" + name);
      }

      bool
      is_rock(const unsigned int material) const
      {
        return absorbs[material] || materials[material]->inertia_factor < 1.;
      }

      Tensor<1, 3>
      outward_area(const CoarseMesh::Face &face) const
      {
        const auto   v = face_vertices(mesh, face);
        const auto  &x = mesh.vertices;
        Tensor<1, 3> area =
          0.5 * cross_product_3d(x[v[3]] - x[v[0]], x[v[2]] - x[v[1]]);
        return area * (x[v[0]] - cell_centre(mesh, face.cell)) > 0. ? area :
                                                                      -area;
      }

      Side
      find_side(const unsigned int axis, const unsigned int end) const
      {
        const double plane =
                       end == 0 ? box.lower_bound(axis) : box.upper_bound(axis),
                     near = 1e-6 * box.side_length(axis);
        Side side{axis, end, 0., 0., 0., 0., {}};
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          for (unsigned int face = 0; face < 6; ++face)
            {
              const auto vertices = face_vertices(mesh, {cell, face});
              if (!std::all_of(vertices.begin(),
                               vertices.end(),
                               [&](const unsigned int v) {
                                 return std::abs(mesh.vertices[v][axis] -
                                                 plane) <= near;
                               }))
                continue;
              const double area = face_area(mesh, {cell, face});
              side.area += area;
              if (fixed.count({cell, face}) > 0)
                side.fixed += area;
              if (supported.count({cell, face}) + used.count({cell, face}) > 0)
                continue;
              // a dam may stand alone on an absorbing base
              const unsigned int m    = material_of_cell[cell];
              const bool         rock = materials[m]->inertia_factor < 1. ||
                                (absorbs[m] && absorbs_sideways);
              if (side.free == 0. || (rock && side.free_rock == 0.))
                side.place = 0.5 * (mesh.vertices[vertices[0]] +
                                    mesh.vertices[vertices[3]]);
              side.free += area;
              if (rock)
                side.free_rock += area;
            }
        return side;
      }

      /** Warns of a free side; returns whether the side is free. */
      bool
      check_side(const Side &side) const
      {
        const bool free = side.free_rock > 0.01 * side.area;
        if (free)
          warn_of(side);
        return free;
      }

      void
      warn_of(const Side &side) const
      {
        log.warn(
          "the side of the model at ",
          "xyz"[side.axis],
          " = ",
          side.end == 0 ? box.lower_bound(side.axis) :
                          box.upper_bound(side.axis),
          " m, around (",
          side.place,
          ") m, neither absorbs waves nor is fixed; name its face set in "
          "section \"Boundaries\"");
      }

      const Case                         &parameters;
      const CoarseMesh                   &mesh;
      const std::vector<unsigned int>    &material_of_cell;
      const std::vector<const Material *> materials;
      Log                                &log;

      const BoundingBox<3> box;

      // faces named by "Fixed"; by any entry of "Boundaries"; by interfaces,
      // loads and constraints
      Faces             fixed, supported, used;
      std::vector<bool> absorbs; // materials that have absorbing faces
      bool              absorbs_sideways = false;
    };
  } // namespace


  void
  check_mesh_against_case(const Case                      &parameters,
                          const CoarseMesh                &mesh,
                          const InterfaceSurfaces         &surfaces,
                          const std::vector<unsigned int> &materials,
                          Log                             &log)
  {
    const MeshAgainstCase check(parameters, mesh, surfaces, materials, log);
    check.check_size();
    check.check_upward_axis();
    check.check_outer_sides();
    check.check_weight();
    check.check_water();
  }
} // namespace Voussoir
