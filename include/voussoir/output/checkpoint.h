#ifndef voussoir_output_checkpoint_h
#define voussoir_output_checkpoint_h

#include <voussoir/output/observer.h>

#include <nlohmann/json.hpp>

namespace Voussoir
{
  /**
   * Writes and reads nodal vectors by a number of each node that does not
   * depend on the ranks, and other values by keys of their own, so that a run
   * can go on with another number of them. Two slots are written in turn; a
   * pointer file names the last complete one.
   */
  class Checkpoint
  {
  public:
    Checkpoint(const Discretization &discretization, const std::string &folder);

    /** Writes the vectors and values (by name) and @p header. */
    void
    write(const std::map<std::string, Vector *>    &vectors,
          const std::map<std::string, KeyedValues> &values,
          const nlohmann::json                     &header);

    /** Whether the folder holds a complete checkpoint. */
    static bool
    exists(const std::string &folder);

    /** The header of the last complete checkpoint. */
    static nlohmann::json
    read_header(const std::string &folder);

    /** Reads the vectors and values; refuses a checkpoint of another mesh or
     *  with others. */
    void
    read(const std::map<std::string, Vector *>    &vectors,
         const std::map<std::string, KeyedValues> &values) const;

  private:
    const Discretization      &discretization;
    const std::string          folder;
    std::vector<std::uint64_t> keys; // of the owned nodes
    unsigned int               next_slot = 1;
  };
} // namespace Voussoir

#endif
