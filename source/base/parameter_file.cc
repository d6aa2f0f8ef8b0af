#include <voussoir/base/error.h>
#include <voussoir/base/parameter_entries.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/base/text.h>

#include <deal.II/base/utilities.h>

#include <boost/locale/utf.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace Voussoir
{
  namespace
  {
    using dealii::Utilities::trim;

    std::string
    join_path(const std::vector<std::string> &sections)
    {
      return join(sections, "/");
    }

    // Larger or deeper nested files are no parameter files, or lack "end".
    constexpr std::size_t largest_file = 10000000, deepest_section = 10;

    bool
    is_utf8(const std::string &text)
    {
      using namespace boost::locale::utf;
      for (auto position = text.begin(); position != text.end();)
        if (!is_valid_codepoint(utf_traits<char>::decode(position, text.end())))
          return false;
      return true;
    }


    // The text of a file, with the line ends of any system.
    std::string
    read_text(const std::string &filename)
    {
      std::error_code error;
      std::ifstream   in(filename, std::ios::binary);
      if (!in || std::filesystem::is_directory(filename, error))
        throw UserError("The parameter file \"" + filename +
                        "\" cannot be read; check its name and folder.");
      if (!is_utf8(filename))
        throw UserError("The name of the parameter file \"" + filename +
                        "\" or of its folder is not written in UTF-8; rename "
                        "it.");
      std::string text(largest_file + 1, '\0');
      in.read(text.data(), text.size());
      text.resize(in.gcount());
      if (text.size() > largest_file)
        throw UserError(filename + ": this is larger than 10 MB; give a "
                                   "parameter file.");
      const std::string byte_order_mark = "\xEF\xBB\xBF";
      if (text.rfind(byte_order_mark, 0) == 0)
        text.erase(0, byte_order_mark.size());
      std::string lines;
      for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] != '\r')
          lines += text[i];
        else if (i + 1 == text.size() || text[i + 1] != '\n')
          lines += '\n';
      return lines;
    }


    // The next line and those that continue it, without comment and blanks
    // around it, and the place of the line; false at the end of the file.
    bool
    next_line(std::istream      &in,
              const std::string &filename,
              unsigned int      &number,
              std::string       &line,
              std::string       &place)
    {
      static const std::regex no_break_space("\xC2\xA0");
      if (!std::getline(in, line))
        return false;
      ++number;
      place = filename + ", line " + std::to_string(number);
      if (line.find('\0') != std::string::npos)
        throw UserError(place + ": this is no text; give a parameter file, "
                                "saved in UTF-8.");
      // a backslash at the end continues the line
      while (!trim(line).empty() && trim(line).back() == '\\')
        {
          line = trim(line);
          line.pop_back();
          std::string next;
          if (!std::getline(in, next))
            break;
          ++number;
          line += " " + trim(next);
        }
      line.erase(std::min(line.find('#'), line.size()));
      if (!is_utf8(line))
        throw UserError(place + ": \"" + trim(line) +
                        "\" is not written in UTF-8; save the file in that "
                        "encoding.");
      line = trim(std::regex_replace(line, no_break_space, " "));
      return true;
    }


    void
    refuse_second_equals(const std::string &path,
                         const std::string &text,
                         const std::string &place)
    {
      if (text.rfind('=', 0) == 0)
        throw UserError(place + ": \"" + entry_of(path) +
                        "\" is followed by two \"=\"; remove one.");
    }


    /** @param first where it is set before, with a preposition */
    [[noreturn]] void
    refuse_second(const std::string &path,
                  const std::string &place,
                  const std::string &first)
    {
      throw UserError(place + ": \"" + entry_of(path) +
                      "\" is set a second time (first " + first +
                      "); keep one of the two.");
    }
  } // namespace


  std::vector<std::string>
  split_list(const std::string &list, const char separator)
  {
    std::vector<std::string> parts;
    std::istringstream       in(list);
    for (std::string part; std::getline(in, part, separator);)
      if (part = trim(part); !part.empty())
        parts.push_back(part);
    return parts;
  }


  ParameterFile::ParameterFile(const std::string              &filename,
                               const std::vector<std::string> &changes)
    : filename(filename)
  {
    read(filename, {});
    change(changes);
    std::map<std::string, std::string> set; // by path
    for (const std::string &item : changes)
      {
        const std::string path =
          join_path(split_list(item.substr(0, item.find('=')), '/'));
        if (const auto first = set.emplace(path, item); !first.second)
          refuse_second(path,
                        "--set \"" + item + "\"",
                        "by --set \"" + first.first->second + "\"");
      }
  }


  ParameterFile
  ParameterFile::with(const std::vector<std::string> &changes) const
  {
    ParameterFile copy = *this;
    ++copy.highest_level;
    copy.change(changes);
    return copy;
  }


  ParameterFile
  ParameterFile::with_copies(const std::string              &section,
                             const std::vector<std::string> &copies) const
  {
    ParameterFile result      = *this;
    const auto    replaced_in = [&](auto &items) {
      const auto originals = items;
      for (const auto &[path, item] : originals)
        if (path == section || path.rfind(section + "/", 0) == 0)
          {
            items.erase(path);
            for (const std::string &copy : copies)
              items.emplace(copy + path.substr(section.size()), item);
          }
    };
    replaced_in(result.values);
    replaced_in(result.sections);
    return result;
  }


  void
  ParameterFile::change(const std::vector<std::string> &changes)
  {
    for (const std::string &item : changes)
      {
        const auto equals = item.find('=');
        if (equals == std::string::npos)
          throw UserError("--set \"" + item +
                          "\" has no \"=\"; write it as "
                          "--set \"Section/Entry=value\".");
        const Value value{trim(item.substr(equals + 1)),
                          "--set \"" + item + "\"",
                          highest_level};
        const auto  path = join_path(split_list(item.substr(0, equals), '/'));
        if (!is_utf8(item))
          throw UserError(value.place + " is not written in UTF-8.");
        refuse_second_equals(path, value.text, value.place);
        if (values[path].text != value.text)
          replaced[path].push_back(values[path].text);
        values[path] = value;
      }
  }


  void
  ParameterFile::read(const std::string       &filename,
                      std::vector<std::string> includers)
  {
    const int level = -int(includers.size());
    includers.push_back(filename);
    ParameterFile            included;
    std::istringstream       in(read_text(filename));
    std::vector<std::string> section;
    std::string              line;
    std::string              place;
    for (unsigned int number = 0; next_line(in, filename, number, line, place);)
      {
        if (line.empty())
          continue;
        std::istringstream words(line);
        std::string        keyword, rest;
        words >> keyword;
        std::getline(words, rest);
        rest = trim(rest);
        if (keyword == "subsection" && !rest.empty())
          {
            section.push_back(rest);
            if (section.size() > deepest_section)
              throw UserError(place + ": \"" + rest + "\" lies in " +
                              std::to_string(deepest_section) +
                              " other sections; close those before with "
                              "\"end\".");
            sections.emplace(join_path(section), Value{"", place, level});
          }
        else if (keyword == "end" && rest.empty())
          {
            if (section.empty())
              throw UserError(place + ": \"end\" closes no section; remove "
                                      "it or add the missing \"subsection\".");
            section.pop_back();
          }
        else if (keyword == "include" && !rest.empty())
          {
            const std::string name = resolve(rest);
            if (!section.empty())
              throw UserError(place + ": \"include\" stands in the section \"" +
                              join_path(section) +
                              "\"; put it outside of all sections.");
            if (std::find(includers.begin(), includers.end(), name) !=
                includers.end())
              throw UserError(place + ": \"" + name +
                              "\" includes itself; remove this line.");
            included.filename = name;
            included.read(name, includers);
          }
        else if (keyword == "set" && rest.find('=') != std::string::npos &&
                 rest.front() != '=')
          {
            const auto  equals = rest.find('=');
            std::string path   = join_path(section);
            path += (path.empty() ? "" : "/") + trim(rest.substr(0, equals));
            // the lists of two included files are joined
            if (values.count(path) > 0 && entry_of(path) == "Names" &&
                values[path].place.rfind(filename + ", line ", 0) != 0)
              {
                values[path].text += ", " + trim(rest.substr(equals + 1));
                continue;
              }
            if (values.count(path) > 0)
              refuse_second(path, place, "in " + values[path].place);
            values[path] = {trim(rest.substr(equals + 1)), place, level};
            refuse_second_equals(path, values[path].text, place);
          }
        else
          throw UserError(place + ": \"" + line +
                          "\" is not understood; a line is \"subsection "
                          "Name\", \"set Entry = value\", \"end\", "
                          "\"include FILE\" or a comment that starts with "
                          "\"#\".");
      }
    if (!section.empty())
      throw UserError(filename + ": the section \"" + join_path(section) +
                      "\" is never closed; add the missing \"end\".");
    for (const auto &[path, value] : included.values)
      if (const auto [own, is_new] = values.emplace(path, value);
          !is_new && own->second.text != value.text)
        replaced[path].push_back(value.text);
    replaced.insert(included.replaced.begin(), included.replaced.end());
    sections.insert(included.sections.begin(), included.sections.end());
  }


  std::string
  ParameterFile::given(const std::string &path,
                       const std::string &otherwise) const
  {
    const auto value = values.find(path);
    return value == values.end() ? otherwise : value->second.text;
  }


  bool
  ParameterFile::is_replaced(const std::string &entry, const int level) const
  {
    return replaced.count(entry) > 0 && values.at(entry).level > level;
  }


  std::string
  ParameterFile::cause_of_no_use(const std::string &path, const int level) const
  {
    const auto names_in = [](const std::string &list, const std::string &name) {
      const auto names = split_list(list);
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (std::string part = path; !part.empty(); part = section_of(part))
      {
        const std::string section = section_of(part);
        for (const std::string entry : {"Class", "Law"})
          if (is_replaced(section + "/" + entry, level))
            return section + "/" + entry;
        for (const std::string entry : {"Names", "Type"})
          if (const std::string chooser = section + "/" + entry;
              is_replaced(chooser, level) &&
              !names_in(given(chooser), entry_of(part)))
            for (const std::string &before : replaced.at(chooser))
              if (names_in(before, entry_of(part)))
                return chooser;
      }
    return "";
  }


  std::vector<std::string>
  ParameterFile::parse(dealii::ParameterHandler &prm) const
  {
    const auto            declared = declared_entries(prm);
    std::set<std::string> declared_sections{""};
    for (const auto &entry : declared)
      for (std::string section = entry.second.section; !section.empty();
           section             = section_of(section))
        declared_sections.insert(section);

    parse_declared(prm);
    const auto refuse_section = [&](const std::string &section,
                                    const std::string &place) {
      const std::string        parent = section_of(section);
      std::vector<std::string> siblings;
      for (const std::string &other : declared_sections)
        if (!other.empty() && section_of(other) == parent)
          siblings.push_back(entry_of(other));
      // the entry, if any, by which the user names the sections
      std::string cause;
      for (const std::string entry : {"Names", "Type", "Observers"})
        if (const std::string path = parent + "/" + entry;
            declared.count(path) > 0)
          cause =
            "; which ones there are depends on \"" + entry + "\"" +
            (entry == "Names" && given(path).empty() ? ", which is empty" : "");
      throw UserError(place + ": there is no section \"" + entry_of(section) +
                      "\" " + section_text(parent) +
                      known_names(entry_of(section), siblings) + cause + ".");
    };
    std::vector<std::string> notes;
    const auto               is_left_out =
      [&](const std::string &what, const std::string &path, const int level) {
        const std::string cause = cause_of_no_use(path, level);
        if (!cause.empty())
          notes.push_back(what + " is not used, as \"" + entry_of(cause) +
                          "\" " + section_text(section_of(cause)) +
                          " is now \"" + given(cause) + "\"");
        return !cause.empty();
      };
    for (const auto &[section, begun] : sections)
      if (declared_sections.count(section) == 0 &&
          !is_left_out("section \"" + section + "\"", section, begun.level))
        refuse_section(section, begun.place);

    for (const auto &[path, value] : values)
      if (declared.count(path) == 0)
        {
          // a note on the section covers its entries
          if (declared_sections.count(section_of(path)) == 0 &&
              !cause_of_no_use(section_of(path), value.level).empty())
            continue;
          if (is_left_out("entry \"" + entry_of(path) + "\" " +
                            section_text(section_of(path)),
                          path,
                          value.level))
            continue;
          const std::string section = section_of(path);
          if (declared_sections.count(section) == 0)
            refuse_section(section, value.place);
          if (const std::string name = new_name_of(path); !name.empty())
            throw UserError(value.place + ": \"" + entry_of(path) + "\" " +
                            section_text(section) + " is now called \"" + name +
                            "\"; rename it.");
          std::vector<std::string> siblings;
          for (const auto &other : declared)
            if (other.second.section == section)
              siblings.push_back(entry_of(other.first));
          throw UserError(value.place + ": there is no entry \"" +
                          entry_of(path) + "\" " + section_text(section) +
                          known_names(entry_of(path), siblings) + ".");
        }
    return notes;
  }


  void
  ParameterFile::parse_declared(dealii::ParameterHandler &prm) const
  {
    const auto declared = declared_entries(prm);
    for (const auto &[path, value] : values)
      if (const auto entry = declared.find(path); entry != declared.end())
        set_entry(prm, path, value.text, value.place, *entry->second.pattern);
  }


  std::vector<std::string>
  ParameterFile::given_numbers(const dealii::ParameterHandler &prm) const
  {
    const auto               declared = declared_entries(prm);
    std::vector<std::string> result;
    for (const auto &[path, value] : values)
      {
        const auto entry = declared.find(path);
        if (entry == declared.end() ||
            entry->second.pattern->description().find("[Double") ==
              std::string::npos)
          continue;
        const auto parts = split_list(value.text);
        if (std::all_of(parts.begin(), parts.end(), [](const auto &part) {
              return parse_number(part).has_value();
            }))
          result.push_back(path);
      }
    return result;
  }


  std::string
  ParameterFile::name() const
  {
    return std::filesystem::path(filename).stem().string();
  }


  std::string
  ParameterFile::folder() const
  {
    const auto parent = std::filesystem::path(filename).parent_path().string();
    return parent.empty() ? "." : parent;
  }


  std::string
  ParameterFile::resolve(const std::string &name) const
  {
    return (std::filesystem::path(folder()) / name).lexically_normal().string();
  }
} // namespace Voussoir
