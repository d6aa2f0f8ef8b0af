#include <voussoir/base/text.h>

#include <algorithm>
#include <cctype>

namespace Voussoir
{
  namespace
  {
    // Optimal string alignment: Levenshtein's distance with exchanges of
    // neighbours. Three rows of the table are enough.
    unsigned int
    edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<unsigned int> before_last, last, row(b.size() + 1);
      for (unsigned int j = 0; j <= b.size(); ++j)
        row[j] = j;

      for (unsigned int i = 1; i <= a.size(); ++i)
        {
          before_last = last;
          last        = row;
          row[0]      = i;
          for (unsigned int j = 1; j <= b.size(); ++j)
            {
              row[j] = std::min({last[j] + 1,
                                 row[j - 1] + 1,
                                 last[j - 1] + (a[i - 1] != b[j - 1])});
              if (i > 1 && j > 1 && a[i - 1] == b[j - 2] &&
                  a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
      return row.back();
    }
  } // namespace


  std::string
  join(const std::vector<std::string> &words, const std::string &separator)
  {
    std::string text;
    for (const std::string &word : words)
      text += (&word == &words.front() ? "" : separator) + word;
    return text;
  }


  std::string
  upper_case(const std::string_view text)
  {
    std::string upper(text);
    for (char &c : upper)
      c = std::toupper(static_cast<unsigned char>(c));
    return upper;
  }


  std::string
  lower_case(const std::string_view text)
  {
    std::string lower(text);
    for (char &c : lower)
      c = std::tolower(static_cast<unsigned char>(c));
    return lower;
  }


  std::string
  counted(const std::size_t  number,
          const std::string &singular,
          const std::string &plural)
  {
    return std::to_string(number) + " " + (number == 1 ? singular : plural);
  }


  std::string
  closest_match(const std::string              &word,
                const std::vector<std::string> &candidates)
  {
    const std::string wanted = lower_case(word);
    // A third of the letters may be wrong, but in short words at least one.
    unsigned int best = std::max<unsigned int>(1, word.size() / 3) + 1;
    std::string  match;
    for (const std::string &candidate : candidates)
      {
        const unsigned int distance =
          edit_distance(wanted, lower_case(candidate));
        if (distance < best)
          {
            best  = distance;
            match = candidate;
          }
      }
    return match;
  }


  std::string
  known_names(const std::string              &word,
              const std::vector<std::string> &candidates)
  {
    if (candidates.empty())
      return "; none is known";

    const std::string match = closest_match(word, candidates);
    return (match.empty() ? "" : " (did you mean \"" + match + "\"?)") +
           "; known are: " + join(candidates, ", ");
  }
} // namespace Voussoir
