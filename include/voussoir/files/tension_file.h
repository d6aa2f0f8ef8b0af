#ifndef voussoir_files_tension_file_h
#define voussoir_files_tension_file_h

#include <voussoir/base/cell_frame.h>

#include <deal.II/base/mpi.h>

#include <string>
#include <vector>

namespace Voussoir
{
  /** The largest tension of a cell over a run. */
  struct CellTension
  {
    CellFrame    frame;
    double       stress;   // principal [Pa]; infinite beyond the elastic range
    unsigned int material; // number
  };

  /** Cells of a run with tension, for the mesh of a later run. */
  struct TensionFile
  {
    std::vector<std::string> materials;    // by number
    dealii::Point<3>         lower, upper; // of the box around the mesh [m]
    std::vector<CellTension> cells;        // to write: those of this rank
  };

  /** Name of the file in the folder of a run. */
  std::string
  tension_file(const std::string &folder);

  /** Writes one HDF5 file from all ranks; returns the reason of a failure, on
   *  all ranks. */
  std::string
  write_tension(const std::string &file,
                const TensionFile &tension,
                const MPI_Comm     communicator);

  /** Reads the file on this rank; throws FileProblem. */
  TensionFile
  read_tension(const std::string &file);
} // namespace Voussoir

#endif
