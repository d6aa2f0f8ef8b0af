#include <voussoir/base/parse_numbers.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace Voussoir
{
  namespace
  {
    constexpr std::string_view white_space = " \t\r\n\v\f";
  }


  std::optional<double>
  parse_number(std::string_view text)
  {
    text.remove_prefix(
      std::min(text.find_first_not_of(white_space), text.size()));
    text = text.substr(0, text.find_last_not_of(white_space) + 1);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
      text.remove_prefix(1);
    double     value = 0.;
    const auto result =
      std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size() ||
        !(std::abs(value) <= largest_number))
      return {};
    return value;
  }


  std::optional<std::vector<double>>
  parse_numbers(const std::string &text)
  {
    std::vector<double> values;
    for (std::size_t begin = text.find_first_not_of(white_space);
         begin != std::string::npos;)
      {
        const std::size_t end = text.find_first_of(white_space, begin);
        const auto        value =
          parse_number(std::string_view(text).substr(begin, end - begin));
        if (!value)
          return {};
        values.push_back(*value);
        begin = text.find_first_not_of(white_space, end);
      }
    return values;
  }
} // namespace Voussoir
