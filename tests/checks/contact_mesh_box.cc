#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>

#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A box of 4 x 4 x 4 cells, cut by up to three planes through its centre:
     * vertices, pairs, areas, normals, and sets that cannot be an interface.
     */
    class ContactMeshBox : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        std::ostringstream report;
        box = make_case(file)->make_mesh(report);
        for (unsigned int d = 0; d < 3; ++d)
          for (unsigned int cell = 0; cell < box.cells.size(); ++cell)
            box
              .cell_sets[names[d] + (box.vertices[box.cells[cell][0]][d] < 1.9 ?
                                       " below" :
                                       " above")]
              .push_back(cell);
        for (const std::string &name : names)
          box.face_sets[name] =
            faces_between(box, name + " below", name + " above", "Test");

        planes(verdicts, communicator);
        crack(verdicts, communicator);
        sides(verdicts, communicator);
        refusals(verdicts, communicator);
      }

    private:
      // 1, 2 or 3 planes: at p points along an edge there are p^2 pairs in each
      // plane, and p more with each further plane, which crosses it.
      void
      planes(Verdicts &verdicts, const MPI_Comm communicator) const
      {
        for (unsigned int n = 1; n <= 3; ++n)
          {
            verdicts.heading(std::to_string(n) + " planes");
            const std::vector<std::string> interfaces(names.begin(),
                                                      names.begin() + n);
            CoarseMesh                     mesh = box;
            split_interfaces(mesh, interfaces, "Test");
            check_mesh(mesh, "Test");
            verdicts.near("  vertices",
                          mesh.vertices.size(),
                          n == 1 ? 6 * 25 :
                          n == 2 ? 6 * 6 * 5 :
                                   6 * 6 * 6,
                          0.);
            verdicts.near("  bodies", n_bodies(mesh), 1U << n, 0.);

            for (unsigned int degree = 1; degree <= 4; ++degree)
              {
                GridParameters grid;
                grid.global_refinement = degree <= 2 ? 1 : 0;
                const auto clusters =
                  all_clusters(mesh, grid, degree, interfaces, communicator);
                const unsigned int p =
                  (4U << grid.global_refinement) * degree + 1;
                // a point of k planes has 2^k nodes and k 2^(k-1) pairs
                const unsigned int pairs =
                  n == 1 ? p * p :
                  n == 2 ? p * p + p :
                           (p - 1) * (p - 1) + 4 * (p - 1) + 4;
                const std::string of =
                  "  degree " + std::to_string(degree) + ": ";
                double error = 0., largest = 0.;
                bool   same = true;
                for (unsigned int i = 0; i < n; ++i)
                  {
                    same = same && n_pairs(clusters, i) == pairs;
                    keep_largest(error,
                                 std::abs(total_area(clusters, i) / 16. - 1.));
                  }
                for (const auto &cluster : clusters)
                  {
                    largest = std::max<double>(largest, cluster.nodes.size());
                    for (const ContactPair &pair : cluster.pairs)
                      {
                        Tensor<1, 3> normal;
                        normal[pair.interface] = 1.;
                        keep_largest(error, (pair.normal - normal).norm());
                      }
                  }
                verdicts.near(of + "pairs", n_pairs(clusters, 0), pairs, 0.);
                verdicts.is_true("    same in all planes, up to 2^n nodes",
                                 same && largest == (1U << n));
                verdicts.below("    areas and normals, error", error, 1e-12);
              }
          }
        CoarseMesh mesh = box;
        split_interfaces(mesh, names, "Test");
        for (const unsigned int degree : {1, 3})
          check_ranks(
            verdicts, mesh, refined_corner(), degree, names, communicator);
      }


      // The lower half of a plane: at its end both sides share one node.
      void
      crack(Verdicts &verdicts, const MPI_Comm communicator) const
      {
        CoarseMesh mesh        = box;
        mesh.face_sets["slit"] = lower_half(box);
        split_interfaces(mesh, {"slit"}, "Test");
        verdicts.near("crack: vertices", mesh.vertices.size(), 125 + 10, 0.);
        verdicts.near("  bodies", n_bodies(mesh), 1, 0.);
        GridParameters grid;
        grid.global_refinement = 1;
        const auto clusters =
          all_clusters(mesh, grid, 2, {"slit"}, communicator);
        verdicts.near("  pairs", n_pairs(clusters, 0), 17 * 8, 0.);
        // the end's share of 4 m, by Simpson's rule on cells of 0.5 m
        verdicts.near(
          "  area", total_area(clusters, 0), 8. - 4. * 0.5 / 6., 1e-12, "m2");
      }


      // Faces named from both sides: the majority decides, and sets keep their
      // members.
      void
      sides(Verdicts &verdicts, const MPI_Comm communicator) const
      {
        CoarseMesh mesh    = box;
        auto      &faces   = mesh.face_sets["x"];
        const auto ordered = faces;
        const auto above   = faces_between(box, "x above", "x below", "Test");
        const auto same    = [&](const CoarseMesh::Face &a) {
          return std::any_of(ordered.begin(),
                             ordered.end(),
                             [&](const CoarseMesh::Face &b) {
                               return a.cell == b.cell && a.face == b.face;
                             });
        };
        for (unsigned int i = 0; i < 7; ++i)
          faces[2 * i] = above[2 * i];
        mesh.face_sets["part"] = {ordered[3]};
        for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
          if (std::abs(mesh.vertices[v][0] - 2.) < 0.1)
            mesh.vertex_sets["middle"].push_back(v);
        split_interfaces(mesh, {"x"}, "Test");
        verdicts.is_true("sides: named from both, all on the first side",
                         faces.size() == 16 &&
                           std::all_of(faces.begin(), faces.end(), same));
        verdicts.near("  faces of the other side",
                      mesh.face_sets["x" + other_side].size(),
                      16,
                      0.);
        verdicts.is_true("  another set keeps its face",
                         mesh.face_sets["part"].size() == 1 &&
                           same(mesh.face_sets["part"][0]));
        verdicts.near("  vertices of a set with their copies",
                      mesh.vertex_sets["middle"].size(),
                      50,
                      0.);
        double error = 0.;
        for (const auto &cluster :
             all_clusters(mesh, GridParameters(), 1, {"x"}, communicator))
          keep_largest(error, std::abs(cluster.pairs[0].normal[0] - 1.));
        verdicts.below("  normals, error", error, 1e-12);
      }


      void
      refusals(Verdicts &verdicts, const MPI_Comm communicator) const
      {
        const auto refuses = [&](const std::string              &name,
                                 const std::vector<std::string> &sets,
                                 const std::string              &words) {
          verdicts.is_true(
            "refused: " + name,
            is_refused(
              [&] {
                CoarseMesh mesh = box;
                mesh.face_sets["empty"];
                mesh.face_sets["again"] = {box.face_sets.at("x")[5]};
                mesh.face_sets["strip"] = {box.face_sets.at("x")[5],
                                           box.face_sets.at("x")[6]};
                mesh.face_sets["tee"]   = lower_half(box);
                for (const auto &face : box.face_sets.at("z"))
                  mesh.face_sets["tee"].push_back(face);
                split_interfaces(mesh, sets, "Test");
              },
              words));
        };
        refuses("unknown set", {"xx"}, "which the mesh does not have");
        refuses("outer faces", {"left"}, "has no cell on its other side");
        refuses("empty set", {"empty"}, "is empty");
        refuses("face of two sets", {"x", "again"}, "one interface only");
        refuses("one set twice", {"y", "y"}, "one interface only");
        refuses("branching set", {"tee"}, "branches or crosses itself");
        refuses("strip that cannot open", {"strip"}, "cannot open");
        verdicts.is_true(
          "refused: no face between two sets",
          is_refused([&] { faces_between(box, "x below", "box", "Test"); },
                     "cells in common"));

        CoarseMesh mesh = box;
        split_interfaces(mesh, {"x"}, "Test");
        for (const std::string cells : {"0 0 0 2 4 4", "0 0 0 4 1 1"})
          {
            GridParameters grid;
            grid.local_refinement = "box " + cells + ": 1";
            verdicts.near(
              "local refinement of " + cells + ": area [m2]",
              total_area(all_clusters(mesh, grid, 1, {"x"}, communicator), 0),
              16.,
              1e-12);
          }
      }


      // Hanging nodes, but not on a plane.
      static GridParameters
      refined_corner()
      {
        GridParameters grid;
        grid.local_refinement = "box 0 0 0 1 1 1: 1";
        return grid;
      }


      static std::vector<CoarseMesh::Face>
      lower_half(const CoarseMesh &mesh)
      {
        std::vector<CoarseMesh::Face> faces;
        for (const CoarseMesh::Face &face : mesh.face_sets.at("x"))
          if (mesh.vertices[mesh.cells[face.cell][0]][2] < 1.9)
            faces.push_back(face);
        return faces;
      }

      CoarseMesh                     box;
      const std::vector<std::string> names{"x", "y", "z"};
    };

    // Reference: closed form
    const Registry<Check>::Add<ContactMeshBox>
      registered("contact mesh box", "Interfaces and contact pairs in a box.");
  } // namespace
} // namespace Voussoir
