#ifndef voussoir_mesh_sources_abaqus_sets_h
#define voussoir_mesh_sources_abaqus_sets_h

#include <voussoir/mesh_sources/reader_file.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace Voussoir
{
  /** A keyword line of an Abaqus file: *NAME, PARAMETER=value, ... */
  struct AbaqusKeyword
  {
    explicit AbaqusKeyword(const std::string &line);

    bool
    has(const std::string &parameter) const;

    /** The value of the parameter, empty if it is not there. */
    std::string
    operator[](const std::string &parameter) const;

    /** Name in upper case, without the asterisk. */
    std::string name;

    /** Values as written, without quotation marks, by names in upper case. */
    std::map<std::string, std::string> parameters;
  };

  /** The items of a line, without blanks; a comma at the end opens no new one.
   */
  std::vector<std::string_view>
  split_at_commas(std::string_view line);

  /**
   * Go on to the next data line, past comments; false if a keyword or the end
   * of the file comes first.
   */
  bool
  find_data_line(MeshFile &file);

  /**
   * The sets of one kind (elements, nodes or surfaces) in an Abaqus file. Upper
   * and lower case make no difference in names.
   */
  class AbaqusSets
  {
  public:
    using Numbers = std::vector<std::int64_t>;

    struct Set
    {
      std::string name; // as written first
      bool        is_internal;
      bool        is_of_assembly;
      Numbers     numbers;
    };

    /** @p parameter names a set of this kind: ELSET, NSET, NAME. */
    AbaqusSets(MeshFile &file, const std::string &parameter);

    /**
     * The members that the data lines of the present keyword list. Numbers
     * without an instance's name are members only if @p is_ours.
     */
    Numbers
    read_members(const AbaqusKeyword &keyword, const bool is_ours);

    /** The number that @p item is, or the numbers of the set that @p item
     *  names. */
    Numbers
    members_of(std::string_view item, bool is_ours) const;

    /** Add the numbers to the set that @p keyword names and return the set. */
    const Set &
    add(const AbaqusKeyword &keyword,
        const Numbers       &numbers,
        const bool           is_in_assembly);

    /** The sets by their names in upper case. */
    const std::map<std::string, Set> &
    all() const;

  private:
    Numbers
    read_range(const std::vector<std::string_view> &items) const;

    MeshFile                  &file;
    const std::string          parameter;
    std::map<std::string, Set> sets;
  };
} // namespace Voussoir

#endif
