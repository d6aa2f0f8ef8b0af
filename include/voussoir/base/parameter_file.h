#ifndef voussoir_base_parameter_file_h
#define voussoir_base_parameter_file_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace Voussoir
{
  /**
   * A parameter file as the user wrote it, with the `--set` changes applied.
   *
   * deal.II's ParameterHandler wants every entry declared before it parses, but
   * which sections a case has depends on the names that the file lists
   * (materials, loads). So the file is read here first: `given()` returns the
   * values that the declarations need, and `parse()` then passes all values to
   * the ParameterHandler.
   */
  class ParameterFile
  {
  public:
    /** Without a file: all entries at their defaults. */
    ParameterFile() = default;

    /**
     * @param filename the parameter file
     * @param changes  each "Section/Subsection/Entry=value"
     */
    explicit ParameterFile(const std::string              &filename,
                           const std::vector<std::string> &changes = {});

    /** A copy with further entries set ("Section/Entry=value"), which take
     *  precedence over those of --set as these do over those of the file. */
    ParameterFile
    with(const std::vector<std::string> &changes) const;

    /** A copy in which a section ("Section/Name") is replaced by copies of it
     *  with these names ("Section/Name 1"). */
    ParameterFile
    with_copies(const std::string              &section,
                const std::vector<std::string> &copies) const;

    /** The value given for an entry ("Section/Entry"), or @p otherwise. */
    std::string
    given(const std::string &path, const std::string &otherwise = "") const;

    /**
     * Sets all given values in @p prm. An entry that @p prm has not declared,
     * or a value that it does not allow, is refused with file, line, section,
     * entry and the allowed values. Left out are entries of a "Class", "Law" or
     * "Type" that --set or an including file has changed, and sections that
     * "Names" no longer lists after such a change.
     *
     * @return a note for each section or entry left out
     */
    std::vector<std::string>
    parse(dealii::ParameterHandler &prm) const;

    /** The same for the entries that @p prm declares; other values are ignored.
     */
    void
    parse_declared(dealii::ParameterHandler &prm) const;

    /** Given entries of @p prm that are real numbers or lists of them. */
    std::vector<std::string>
    given_numbers(const dealii::ParameterHandler &prm) const;

    /** Name of the file without folder and extension. */
    std::string
    name() const;

    /** Folder of the file, from which relative names in the file start. */
    std::string
    folder() const;

    /** @p name relative to the folder of this file. */
    std::string
    resolve(const std::string &name) const;

  private:
    struct Value
    {
      std::string text;
      std::string place; // "case.prm, line 12" or "--set"

      // values of a higher level take precedence: 0 in the file, -1 in those
      // that it includes, -2 in theirs; 1 from --set, 2 and more by `with`
      int level = 0;
    };

    /** Entries of a file take precedence over those of the files that it
     *  includes; all resolve names of files from the folder of the first one.
     */
    void
    read(const std::string &filename, std::vector<std::string> includers);

    void
    change(const std::vector<std::string> &changes);

    /** Whether a higher level has changed the value of an entry. */
    bool
    is_replaced(const std::string &entry, const int level) const;

    /** The entry whose change makes a section or an entry of this level unused;
     *  "" if there is none. */
    std::string
    cause_of_no_use(const std::string &path, const int level) const;

    std::string                  filename;
    std::map<std::string, Value> values; // by "Section/Subsection/Entry"
    int                          highest_level = 1;

    // replaced texts of the entries; "" stands for the default value
    std::map<std::string, std::vector<std::string>> replaced;

    std::map<std::string, Value> sections; // by path, without text
  };

  /** Parts of a comma-separated list, without the blanks around them. */
  std::vector<std::string>
  split_list(const std::string &list, const char separator = ',');
} // namespace Voussoir

#endif
