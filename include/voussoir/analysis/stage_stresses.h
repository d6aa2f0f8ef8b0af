#ifndef voussoir_analysis_stage_stresses_h
#define voussoir_analysis_stage_stresses_h

#include <voussoir/output/face_mesh.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /** Extremes of the stresses on faces of the dam in a static stage: principal
   *  ones and, where a face is not level, those of arch and cantilever. */
  class StageStresses
  {
  public:
    /** Called on all ranks.
     *  @param sets as in the entry; empty: upstream and downstream face where
     *    the mesh has them */
    StageStresses(const Discretization &discretization,
                  const std::string    &sets);

    /** Faces that are level nowhere. */
    std::vector<const FaceMesh *>
    faces_with_arches() const;

    /** Adds largest and smallest stresses of each face set with their places.
     *  Called on all ranks.
     *  @param model with the initial state of this stage */
    void
    describe(const StressModel &model, nlohmann::json &report) const;

  private:
    struct Face
    {
      std::string                     name;
      std::unique_ptr<const FaceMesh> mesh;
      bool                            is_level; // somewhere
    };

    std::vector<Face> faces;
  };
} // namespace Voussoir

#endif
