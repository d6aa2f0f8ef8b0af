#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/files/tension_file.h>

#include <dlfcn.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // around the name of a file in an entry
    constexpr char with_file[]   = " with the file \"",
                   of_checksum[] = "\" of the checksum ";


    /** Whether the results of a run do not depend on an entry. */
    bool
    is_free_of_results(const std::string &entry)
    {
      static const std::set<std::string> free{"Title",
                                              "Mesh/Partition",
                                              "Output/Folder",
                                              "Static state/Keep in",
                                              "Output/Checkpoint interval",
                                              "Output/Checkpoint time"};
      return free.count(entry) > 0 || entry.rfind("Study/", 0) == 0;
    }


    /** Whether a run may continue with another value of an entry. */
    bool
    is_free_of_restart(const std::string &entry)
    {
      static const std::set<std::string> free{"Time/End time",
                                              "Output/Energy interval",
                                              "Output/Energy limit"};
      if (is_free_of_results(entry) || free.count(entry) > 0 ||
          entry.rfind("Acceptance/", 0) == 0)
        return true;
      // times at which observers write
      const std::string last = entry.substr(entry.rfind('/') + 1);
      return entry.rfind("Output/", 0) == 0 &&
             (last == "Interval" || last == "Times");
    }


    template <typename Iterator>
    std::string
    checksum_of(Iterator byte, const Iterator end)
    {
      std::uint64_t sum = 0xcbf29ce484222325;
      for (; byte != end; ++byte)
        sum = (sum ^ static_cast<unsigned char>(*byte)) * 0x100000001b3;
      std::ostringstream text;
      text << std::hex << std::setw(16) << std::setfill('0') << sum;
      return text.str();
    }


    /** Checksum of the contents of a file; empty if there is no such file. */
    std::string
    checksum_of_file(const std::string &name)
    {
      std::error_code none;
      if (!std::filesystem::is_regular_file(name, none))
        return "";
      std::ifstream in(name, std::ios::binary);
      return checksum_of(std::istreambuf_iterator<char>(in), {});
    }


    /** Checksum of the library that contains this function. */
    std::string
    checksum_of_program()
    {
      Dl_info here;
      dladdr(reinterpret_cast<const void *>(&identity_of), &here);
      return checksum_of_file(here.dli_fname);
    }


    /** Entries on which the static state does not depend. */
    bool
    is_free_of_static_state(const std::string &line)
    {
      if (line.rfind("Output/histories/Points", 0) == 0)
        return false; // the stages have results at these points, too
      for (const char *const section :
           {"Time/", "Output/", "Ground motion/", "Modes/", "Acceptance/"})
        if (line.rfind(section, 0) == 0)
          return true;
      return false;
    }


    /** Entries and the files that they name, but not entries that may change.
     */
    nlohmann::json
    identity_without(const Case &parameters,
                     bool (*const is_free)(const std::string &entry))
    {
      std::ostringstream text;
      parameters.prm.print_parameters(text, ParameterHandler::ShortText);
      nlohmann::json           result = nlohmann::json::array();
      std::istringstream       in(text.str());
      std::vector<std::string> sections;
      for (std::string line; std::getline(in, line);)
        {
          line              = Utilities::trim(line);
          const auto equals = line.find('=');
          if (line.rfind("subsection ", 0) == 0)
            sections.push_back(line.substr(11) + "/");
          else if (line == "end")
            sections.pop_back();
          else if (line.rfind("set ", 0) == 0)
            {
              const std::string entry =
                join(sections, "") +
                Utilities::trim(line.substr(4, equals - 4));
              if (is_free(entry))
                continue;
              const std::string value = line.substr(equals + 1);
              result.push_back(entry + " =" + value);
              for (const std::string &part : split_list(value))
                if (const std::string sum =
                      checksum_of_file(parameters.file.resolve(part));
                    !sum.empty())
                  result.push_back(entry + with_file + part + of_checksum +
                                   sum);
            }
        }
      return result;
    }


    /** A line of an identity, "Entry = value", with checksums instead of the
     *  names of files to compare, and with both to show. */
    struct Line
    {
      std::string compared, shown;
    };


    /** Lines of an identity by their entries. */
    std::map<std::string, Line>
    by_contents(const nlohmann::json &identity)
    {
      std::map<std::string, Line> result;
      std::string                 entry; // of the line before
      for (const nlohmann::json &item : identity)
        {
          const std::string line  = item.is_string() ?
                                      Utilities::trim(item.get<std::string>()) :
                                      item.dump();
          const std::string start = entry + with_file;
          const auto        sum   = line.rfind(of_checksum);
          if (!entry.empty() && line.rfind(start, 0) == 0 &&
              sum != std::string::npos && sum >= start.size())
            {
              const std::string file =
                line.substr(start.size(), sum - start.size());
              auto &[compared, shown] = result[entry];
              // the name of the entry may contain that of the file
              const auto place = compared.find(file, entry.size());
              if (place != std::string::npos)
                compared.replace(place, file.size(), line.substr(sum));
              shown += line.substr(sum + 1); // " of the checksum ..."
              continue;
            }
          entry         = line.substr(0, line.find(" ="));
          result[entry] = {line, line};
        }
      return result;
    }
  } // namespace


  std::string
  checksum(const std::string &bytes)
  {
    return checksum_of(bytes.begin(), bytes.end());
  }


  nlohmann::json
  identity_of(const Case &parameters)
  {
    nlohmann::json result = identity_without(parameters, is_free_of_restart);
    // the mesh depends on what the other run has left
    if (const std::string &run = parameters.grid.refine_where.demand_of;
        !run.empty())
      result.push_back(
        "Mesh/Refine where/Demand of" + (with_file + run) + of_checksum +
        checksum_of_file(tension_file(demand_folder(parameters))));
    return result;
  }


  nlohmann::json
  result_identity_of(const Case &parameters)
  {
    return identity_without(parameters, is_free_of_results);
  }


  std::optional<std::pair<std::string, std::string>>
  first_difference(const nlohmann::json &one, const nlohmann::json &other)
  {
    const auto mine = by_contents(one), theirs = by_contents(other);
    const auto line = [](const auto &lines, const std::string &entry) {
      const auto found = lines.find(entry);
      return found == lines.end() ? Line{"", "nothing"} : found->second;
    };
    for (const auto *const lines : {&theirs, &mine})
      for (const auto &item : *lines)
        {
          const Line a = line(mine, item.first), b = line(theirs, item.first);
          if (a.compared != b.compared)
            return std::pair(a.shown, b.shown);
        }
    return {};
  }


  nlohmann::json
  static_identity_of(const Case &parameters)
  {
    nlohmann::json result = nlohmann::json::array(
      {"program with the checksum " + checksum_of_program()});
    for (const nlohmann::json &line : identity_of(parameters))
      if (!is_free_of_static_state(line.get<std::string>()))
        result.push_back(line);
    return result;
  }


  void
  check_identity(const Case           &parameters,
                 const nlohmann::json &identity,
                 const std::string    &checkpoint)
  {
    if (const auto difference =
          first_difference(identity, identity_of(parameters)))
      throw UserError("The checkpoint \"" + checkpoint +
                      "\" was written with \"" + difference->first +
                      "\", the case now has \"" + difference->second +
                      "\"; restart with the same one, or start afresh.");
  }
} // namespace Voussoir
