#ifndef voussoir_output_checkpoint_h
#define voussoir_output_checkpoint_h

#include <voussoir/fem/discretization.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * Writes and reads nodal vectors by a number of each node that does not
   * depend on the ranks, so that a run can go on with another number of them.
   * Two slots are written in turn; a pointer file names the last complete one.
   */
  class Checkpoint
  {
  public:
    Checkpoint(const Discretization &discretization, const std::string &folder);

    /** Writes the vectors (by name) and @p header. */
    void
    write(const std::map<std::string, Vector *> &vectors,
          const nlohmann::json                  &header);

    /** Whether the folder holds a complete checkpoint. */
    static bool
    exists(const std::string &folder);

    /** The header of the last complete checkpoint. */
    static nlohmann::json
    read_header(const std::string &folder);

    /** Reads the vectors; refuses a checkpoint of another mesh or with other
     *  vectors. */
    void
    read(const std::map<std::string, Vector *> &vectors) const;

  private:
    const Discretization      &discretization;
    const std::string          folder;
    std::vector<std::uint64_t> keys; // of the owned nodes
    unsigned int               next_slot = 1;
  };
} // namespace Voussoir

#endif
