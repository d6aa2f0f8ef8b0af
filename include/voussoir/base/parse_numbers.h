#ifndef voussoir_base_parse_numbers_h
#define voussoir_base_parse_numbers_h

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Voussoir
{
  /** No quantity in SI units is larger; squares of such numbers are finite. */
  constexpr double largest_number = 1e30;

  /** The number in @p text, with or without blanks around it; none if the text
   *  is no finite number or exceeds largest_number. */
  std::optional<double>
  parse_number(std::string_view text);

  /** The same for several numbers, separated by white space. */
  std::optional<std::vector<double>>
  parse_numbers(const std::string &text);
} // namespace Voussoir

#endif
