#include <voussoir/base/text.h>
#include <voussoir/mesh_sources/abaqus_sets.h>

#include <algorithm>
#include <cctype>

namespace Voussoir
{
  AbaqusKeyword::AbaqusKeyword(const std::string &line)
  {
    const auto items = split_at_commas(line);
    name             = upper_case(items[0].substr(1));
    for (unsigned int i = 1; i < items.size(); ++i)
      {
        const std::size_t equal = items[i].find('=');
        std::string_view  value;
        if (equal != std::string_view::npos)
          value = trimmed(items[i].substr(equal + 1));
        if (value.size() >= 2 && value.front() == '"')
          value = value.substr(1, value.size() - 2);
        parameters[upper_case(trimmed(items[i].substr(0, equal)))] = value;
      }
  }


  bool
  AbaqusKeyword::has(const std::string &parameter) const
  {
    return parameters.count(parameter) > 0;
  }


  std::string
  AbaqusKeyword::operator[](const std::string &parameter) const
  {
    return has(parameter) ? parameters.at(parameter) : "";
  }


  std::vector<std::string_view>
  split_at_commas(std::string_view line)
  {
    std::vector<std::string_view> items;
    while (!line.empty())
      {
        const std::size_t comma = std::min(line.find(','), line.size());
        items.push_back(trimmed(line.substr(0, comma)));
        line.remove_prefix(std::min(comma + 1, line.size()));
      }
    return items;
  }


  bool
  find_data_line(MeshFile &file)
  {
    while (!file.at_end() && file.peek_line().substr(0, 2) == "**")
      file.skip_line();
    return !file.at_end() && file.peek_line().front() != '*';
  }


  AbaqusSets::AbaqusSets(MeshFile &file, const std::string &parameter)
    : file(file)
    , parameter(parameter)
  {}


  AbaqusSets::Numbers
  AbaqusSets::read_members(const AbaqusKeyword &keyword, const bool is_ours)
  {
    Numbers numbers;
    while (find_data_line(file))
      {
        const auto items = split_at_commas(file.line("a set"));
        if (keyword.has("GENERATE"))
          {
            const Numbers range = read_range(items);
            if (is_ours)
              numbers.insert(numbers.end(), range.begin(), range.end());
          }
        else
          for (const std::string_view item : items)
            {
              const Numbers members = members_of(item, is_ours);
              numbers.insert(numbers.end(), members.begin(), members.end());
            }
      }
    return numbers;
  }


  AbaqusSets::Numbers
  AbaqusSets::read_range(const std::vector<std::string_view> &items) const
  {
    Numbers range = {0, 0, 1};
    for (unsigned int i = 0; i < 3 && i < items.size(); ++i)
      range[i] = file.to_number<std::int64_t>(items[i], "an integer number");
    const auto first = range[0], last = range[1], step = range[2];
    // More than 100 million members would be a mistake, and fill the memory.
    if (items.size() < 2 || first < 0 || step < 1 || last < first ||
        (last - first) / step > 100000000)
      file.fail("GENERATE needs the first number, the last, not below the "
                "first, and if wanted an increment of 1 or more, 100 million "
                "numbers at most.");
    range.clear();
    for (std::int64_t i = 0; i <= (last - first) / step; ++i)
      range.push_back(first + i * step);
    return range;
  }


  // A member is a number or the name of an earlier set, with or without the
  // name of an instance and a point before it; names with blanks are in
  // quotation marks.
  AbaqusSets::Numbers
  AbaqusSets::members_of(std::string_view item, bool is_ours) const
  {
    const bool is_quoted = item.size() > 1 && item.back() == '"';
    if (is_quoted)
      item.remove_suffix(1);
    const std::size_t begin = item.rfind(is_quoted ? '"' : '.') + 1; // or 0
    is_ours = is_ours || item.substr(0, begin).find('.') != item.npos;
    item.remove_prefix(begin);
    if (item.empty())
      return {};
    if (!is_quoted && std::isdigit(static_cast<unsigned char>(item.front())))
      {
        const auto number =
          file.to_number<std::int64_t>(item, "a number or a name");
        return is_ours ? Numbers{number} : Numbers{};
      }

    const auto entry = sets.find(upper_case(item));
    if (entry == sets.end())
      {
        std::vector<std::string> names;
        for (const auto &set : sets)
          if (!set.second.is_internal)
            names.push_back(set.second.name);
        file.fail("no set " + in_quotes(item) + " is given before" +
                  known_names(std::string(item), names) + ".");
      }
    return entry->second.numbers;
  }


  // Abaqus distinguishes sets of the part and of the assembly that have the
  // same name; only for internal sets the name is not ambiguous here.
  const AbaqusSets::Set &
  AbaqusSets::add(const AbaqusKeyword &keyword,
                  const Numbers       &numbers,
                  const bool           is_in_assembly)
  {
    const std::string name = keyword[parameter];
    if (name.empty())
      file.fail("*" + keyword.name + " without a name; add " + parameter +
                "=NAME.");
    const auto [entry, is_new] =
      sets.emplace(upper_case(name),
                   Set{name, keyword.has("INTERNAL"), is_in_assembly, {}});
    Set &set = entry->second;
    if (set.is_of_assembly != is_in_assembly)
      {
        if (!set.is_internal)
          file.fail("the part and the assembly both have a set \"" + name +
                    "\"; rename one of the two.");
        set.is_of_assembly = is_in_assembly;
        set.numbers.clear();
      }
    set.numbers.insert(set.numbers.end(), numbers.begin(), numbers.end());
    return set;
  }


  const std::map<std::string, AbaqusSets::Set> &
  AbaqusSets::all() const
  {
    return sets;
  }
} // namespace Voussoir
