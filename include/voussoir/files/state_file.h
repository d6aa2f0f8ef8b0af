#ifndef voussoir_files_state_file_h
#define voussoir_files_state_file_h

#include <voussoir/base/keyed_values.h>

#include <deal.II/base/mpi.h>

#include <nlohmann/json.hpp>

#include <map>
#include <string>

namespace Voussoir
{
  /** The numbers that a state file is written from and read into. */
  struct StateContent
  {
    /** Numbers of nodes, cells and points, spread over the ranks, by name. */
    std::map<std::string, KeyedValues> values;

    /** Documents that all ranks need, by name; those of the first rank are
     *  written. */
    std::map<std::string, nlohmann::json> documents;
  };

  /**
   * Writes one HDF5 file from all ranks: the header, the documents in CBOR, and
   * for each name of the values the sorted keys and the rows of numbers, with a
   * checksum of each. Rows of zeros are left out. The file does not depend on
   * the number of ranks, and any number of ranks may read it.
   *
   * The file appears under its name when it is whole and on the disk; until
   * then an older file of that name stays. Throws UserError on all ranks if
   * that fails.
   */
  void
  write_state(const std::string    &file,
              const nlohmann::json &header,
              const StateContent   &content,
              const MPI_Comm        communicator);

  /** The header; throws UserError on all ranks if there is none. */
  nlohmann::json
  read_state_header(const std::string &file, const MPI_Comm communicator);

  /** Error of a damaged file, which all ranks check together; empty if the file
   *  is whole. */
  std::string
  damage_of_state(const std::string &file, const MPI_Comm communicator);

  /**
   * Reads the numbers and the documents that @p content lists; each rank reads
   * its part. Throws UserError on all ranks if the file is damaged, holds other
   * names, or belongs to another mesh.
   */
  void
  read_state(const std::string &file,
             StateContent      &content,
             const MPI_Comm     communicator);
} // namespace Voussoir

#endif
