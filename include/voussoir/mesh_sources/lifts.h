#ifndef voussoir_mesh_sources_lifts_h
#define voussoir_mesh_sources_lifts_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace Voussoir
{
  /** The lifts of concrete in which a dam is placed. The joints between them
   *  are rows of faces of its cells. */
  class Lifts
  {
  public:
    void
    declare(dealii::ParameterHandler &prm);

    /** @param elevations of the dam's rows of cells, from base to crest [m] */
    void
    lay(const std::vector<double> &elevations);

    /** Set of the faces below a row, "lift 1" from below; empty if no lift
     *  joint runs there. */
    std::string
    joint_below(const unsigned int row) const;

    /** Number and elevations of the joints, a line for the log; empty without
     *  lifts. */
    std::string
    describe() const;

  private:
    double                         height = 0.; // of a lift [m]
    std::map<unsigned int, double> joints; // elevation, by the row above [m]
  };
} // namespace Voussoir

#endif
