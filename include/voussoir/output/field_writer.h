#ifndef voussoir_output_field_writer_h
#define voussoir_output_field_writer_h

#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** A nodal vector to write: as one vector field, or its three components as
   *  scalar fields with names of their own. */
  struct NodalField
  {
    const Vector            *vector;
    std::vector<std::string> names; // one or three
  };

  /** One number for each active cell to write; only those of owned cells are
   *  sampled. */
  struct CellField
  {
    const dealii::Vector<float> *values;
    std::string                  name;
  };

  /**
   * Writes fields of the whole model as one VTU file, always with material and
   * cell set of each cell by number, with their names (see `ResultNames`), and
   * results of the internal variables, as a mean over the points of each cell.
   *
   * @param fields    of the nodes
   * @param stress_of state whose principal stresses are written [MPa], see
   *   LawStress; null for none
   * @param name      of the file in the output folder, without extension
   * @param time      [s]
   * @return its name in the output folder; empty if it cannot be written
   */
  std::string
  write_fields(const ObservedRun             &run,
               const std::vector<NodalField> &fields,
               const State                   *stress_of,
               const std::string             &name,
               const double                   time,
               const std::vector<CellField>  &cell_fields = {});

  /** The same at t = 0 of a model without a run, without results of internal
   *  variables.
   */
  std::string
  write_fields(const ObservedModel           &model,
               const std::string             &folder,
               const std::vector<NodalField> &fields,
               const std::string             &name);
} // namespace Voussoir

#endif
