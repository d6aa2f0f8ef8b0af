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

  /** One number for each active cell to write; others than the owned ones are
   *  not looked at. */
  struct CellField
  {
    const dealii::Vector<float> *values;
    std::string                  name;
  };

  /**
   * Writes nodal fields, and by choice the principal stresses [MPa] under the
   * displacement @p stress_of, as one grouped VTU file.
   *
   * @return the name of the file without its folder
   */
  std::string
  write_fields(const ObservedModel           &model,
               const std::vector<NodalField> &fields,
               const Vector                  *stress_of,
               const std::string             &name,
               const double                   time,
               const std::vector<CellField>  &cell_fields = {});
} // namespace Voussoir

#endif
