#ifndef voussoir_base_text_h
#define voussoir_base_text_h

#include <string>
#include <string_view>
#include <vector>

namespace Voussoir
{
  /** The @p words in one string with @p separator between them. */
  std::string
  join(const std::vector<std::string> &words, const std::string &separator);

  /** The text with A-Z for a-z, other letters unchanged. */
  std::string
  upper_case(const std::string_view text);

  /** The text with a-z for A-Z, other letters unchanged. */
  std::string
  lower_case(const std::string_view text);

  /** "1 cell" or "12 cells". */
  std::string
  counted(const std::size_t  number,
          const std::string &singular,
          const std::string &plural);

  /**
   * The candidate that differs from @p word by the fewest typing errors (a
   * letter too many, missing, wrong, or two exchanged; upper and lower case
   * count as equal), or an empty string if none is close enough.
   */
  std::string
  closest_match(const std::string              &word,
                const std::vector<std::string> &candidates);

  /**
   * The end of a message on an unknown @p word: the name that was probably
   * meant and the known names, as in ` (did you mean "dam"?); known are: dam,
   * rock`.
   */
  std::string
  known_names(const std::string              &word,
              const std::vector<std::string> &candidates);
} // namespace Voussoir

#endif
