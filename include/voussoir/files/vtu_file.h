#ifndef voussoir_files_vtu_file_h
#define voussoir_files_vtu_file_h

#include <voussoir/base/log.h>

#include <deal.II/base/data_out_base.h>

namespace Voussoir
{
  /** Lines of text in the field data of a VTU file. */
  struct VtuText
  {
    std::string              name;
    std::vector<std::string> lines;
  };

  /**
   * Writes the patches of all ranks as one VTU file, with the time as "TIME"
   * and texts as arrays of strings in its field data, which ParaView shows in
   * its spreadsheet and readers such as VTK's give by name. The names behind
   * the numbers of a field "NAME" are in "NAME_names".
   *
   * Called on all ranks of the log, which records a failure; there is no such
   * file then.
   *
   * @param output deal.II's patches and fields; gets its flags here
   * @param file   name with folder and extension
   * @param time   [s]
   * @return whether it is written
   */
  template <int dim>
  bool
  write_vtu(dealii::DataOutInterface<dim, 3> &output,
            const std::string                &file,
            const double                      time,
            const std::vector<VtuText>       &texts,
            Log                              &log);
} // namespace Voussoir

#endif
