#include <voussoir/mesh/interfaces.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_geometry.h>

#include <set>

#include "contact_mesh.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * An arch dam cut along all its joints and its rock: blocks, pairs against
     * the vertices of the face sets, and areas.
     */
    class ContactMeshDam : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto               parameters = make_case(file);
        std::ostringstream       report;
        const CoarseMesh         whole = parameters->make_mesh(report);
        std::vector<std::string> joints;
        for (const auto &set : whole.face_sets)
          if (set.first.rfind("joint ", 0) == 0)
            joints.push_back(set.first);

        compare(whole, joints, false, verdicts, communicator);
        joints.push_back("dam-rock interface");
        compare(whole, joints, true, verdicts, communicator);

        CoarseMesh mesh = whole;
        split_interfaces(mesh, joints, "Test");
        joints.pop_back();
        refine_dam(whole, joints, verdicts, communicator);
        joints.push_back("dam-rock interface");
        for (const unsigned int degree : {1, 2})
          check_ranks(
            verdicts, mesh, parameters->grid, degree, joints, communicator);
      }

    private:
      /** The nodes of refined joints hang at their ends on coarse rock, where
       *  they are not split. */
      static void
      refine_dam(const CoarseMesh               &whole,
                 const std::vector<std::string> &joints,
                 Verdicts                       &verdicts,
                 const MPI_Comm                  communicator)
      {
        CoarseMesh mesh = whole;
        split_interfaces(mesh, joints, "Test");
        GridParameters all_refined, dam_refined;
        all_refined.global_refinement = 1;
        dam_refined.local_refinement  = "dam: 1";
        const auto of_all =
          all_clusters(mesh, all_refined, 1, joints, communicator);
        verdicts.above("dam refined: clusters", of_all.size(), 300.);
        verdicts.below(
          "dam refined alone: joints, difference to all refined",
          difference(all_clusters(mesh, dam_refined, 1, joints, communicator),
                     of_all),
          1e-12);
      }

      void
      compare(const CoarseMesh               &whole,
              const std::vector<std::string> &interfaces,
              const bool                      with_rock,
              Verdicts                       &verdicts,
              const MPI_Comm                  communicator) const
      {
        CoarseMesh mesh = whole;
        split_interfaces(mesh, interfaces, "Test");
        check_mesh(mesh, "Test");
        const unsigned int n_joints = interfaces.size() - with_rock;
        const std::string  name =
          with_rock ? "dam on its rock: " : "dam tied to its rock: ";
        verdicts.near(name + "bodies",
                      n_bodies(mesh),
                      with_rock ? n_joints + 2 : 1,
                      0.);

        // A joint has pairs at all its vertices, save those where its blocks
        // are tied to the rock. On the rock a vertex at a joint has two pairs.
        const auto   contour   = vertices(whole, {"dam-rock interface"});
        unsigned int in_joints = 0, shared = 0;
        std::vector<unsigned int> expected;
        for (unsigned int i = 0; i < n_joints; ++i)
          {
            unsigned int on_rock = 0;
            const auto   joint   = vertices(whole, {interfaces[i]});
            for (const unsigned int v : joint)
              on_rock += contour.count(v);
            shared += on_rock;
            expected.push_back(joint.size() - (with_rock ? 0 : on_rock));
            in_joints += expected.back();
          }
        if (with_rock)
          expected.push_back(contour.size() + shared);

        const auto clusters =
          all_clusters(mesh, GridParameters(), 1, interfaces, communicator);
        bool   same  = true;
        double error = 0.;
        for (unsigned int i = 0; i < interfaces.size(); ++i)
          same = same && n_pairs(clusters, i) == expected[i];
        verdicts.near(name + "pairs of the first joint",
                      n_pairs(clusters, 0),
                      expected[0],
                      0.);
        verdicts.is_true(name + "pairs of all interfaces", same);
        verdicts.near(name + "clusters",
                      clusters.size(),
                      in_joints + (with_rock ? contour.size() - shared : 0),
                      0.);
        if (!with_rock)
          return;
        for (const unsigned int degree : {1, 2, 3})
          {
            const auto of_degree = degree == 1 ? clusters :
                                                 all_clusters(mesh,
                                                              GridParameters(),
                                                              degree,
                                                              interfaces,
                                                              communicator);
            error                = 0.;
            for (unsigned int i = 0; i < interfaces.size(); ++i)
              {
                double area = 0.;
                for (const auto &face : whole.face_sets.at(interfaces[i]))
                  area += face_area(whole, face);
                keep_largest(error,
                             std::abs(total_area(of_degree, i) / area - 1.));
              }
            // faces on the rock are warped
            verdicts.below(name + "degree " + std::to_string(degree) +
                             ": areas, error",
                           error,
                           degree == 1 ? 1e-3 : 1e-5);
          }
      }

      static std::set<unsigned int>
      vertices(const CoarseMesh &mesh, const std::vector<std::string> &sets)
      {
        std::set<unsigned int> result;
        for (const std::string &name : sets)
          for (const CoarseMesh::Face &face : mesh.face_sets.at(name))
            for (const unsigned int v : face_vertices(mesh, face))
              result.insert(v);
        return result;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<ContactMeshDam>
      registered("contact mesh dam", "Joints of an arch dam, and its rock.");
  } // namespace
} // namespace Voussoir
