#ifndef voussoir_output_checkpoint_h
#define voussoir_output_checkpoint_h

#include <voussoir/fem/discretization.h>
#include <voussoir/files/state_file.h>

namespace Voussoir
{
  /** The checkpoints of a run: files of its state at two moments, of which the
   *  older one is replaced when the next is whole. */
  class Checkpoint
  {
  public:
    Checkpoint(const std::string &folder, const MPI_Comm communicator);

    /** Throws UserError if that fails; the earlier files then stay. */
    void
    write(const unsigned long long step,
          const nlohmann::json    &header,
          const StateContent      &content) const;

    /** The newest whole file, or an empty name; newer damaged files go to @p
     *  damaged with their errors. Called on all ranks. */
    std::string
    newest(std::vector<std::string> &damaged) const;

  private:
    /** The newest first. */
    std::vector<std::string>
    files() const;

    const std::string folder;
    const MPI_Comm    communicator;
  };

  /** The numbers of nodal vectors with a key for each owned node that does not
   *  depend on the ranks. */
  class NodalKeys
  {
  public:
    explicit NodalKeys(const Discretization &discretization);

    KeyedValues
    values(Vector &vector) const;

  private:
    std::vector<std::uint64_t> keys; // of the owned nodes
  };
} // namespace Voussoir

#endif
