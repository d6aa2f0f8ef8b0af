#ifndef voussoir_base_parameter_entries_h
#define voussoir_base_parameter_entries_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <memory>
#include <string>

namespace Voussoir
{
  /** "Section" of the path "Section/Entry"; empty at the top level. */
  std::string
  section_of(const std::string &path);

  /** "Entry" of the path "Section/Entry". */
  std::string
  entry_of(const std::string &path);

  /** "in section "Section"", or "at the top level". */
  std::string
  section_text(const std::string &section);

  /** Present name of an entry that has been renamed; empty for all others. */
  std::string
  new_name_of(const std::string &path);


  /** An entry that a ParameterHandler declares. */
  struct DeclaredEntry
  {
    std::string                                    section;
    std::unique_ptr<dealii::Patterns::PatternBase> pattern;
  };

  /** All declared entries by path, from the handler's JSON form, as
   *  ParameterHandler has no list of them. */
  std::map<std::string, DeclaredEntry>
  declared_entries(const dealii::ParameterHandler &prm);

  /** Sets an entry. Refuses a value that its pattern does not allow, with a
   *  sentence on the allowed values; @p place is where the value stands. */
  void
  set_entry(dealii::ParameterHandler            &prm,
            const std::string                   &path,
            const std::string                   &text,
            const std::string                   &place,
            const dealii::Patterns::PatternBase &pattern);
} // namespace Voussoir

#endif
