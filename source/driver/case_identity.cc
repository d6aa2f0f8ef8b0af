#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>

#include <dlfcn.h>

#include <filesystem>
#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    bool
    is_free(const std::string &entry)
    {
      static const std::set<std::string> free{"Title",
                                              "Mesh/Partition",
                                              "Time/End time",
                                              "Output/Folder",
                                              "Static state/Keep in",
                                              "Output/Energy interval",
                                              "Output/Energy limit",
                                              "Output/Checkpoint interval",
                                              "Output/Checkpoint time"};
      if (free.count(entry) > 0 || entry.rfind("Study/", 0) == 0)
        return true;
      // of observers: when they write
      const std::string last = entry.substr(entry.rfind('/') + 1);
      return entry.rfind("Output/", 0) == 0 &&
             (last == "Interval" || last == "Times");
    }


    /** Of what a file holds; empty if it is none. */
    std::string
    checksum_of_file(const std::string &name)
    {
      std::error_code none;
      if (!std::filesystem::is_regular_file(name, none))
        return "";
      std::ifstream in(name, std::ios::binary);
      return checksum({std::istreambuf_iterator<char>(in), {}});
    }


    /** That of the library this is a part of. */
    std::string
    checksum_of_program()
    {
      Dl_info here;
      dladdr(reinterpret_cast<const void *>(&identity_of), &here);
      return checksum_of_file(here.dli_fname);
    }


    /** What the static state does not depend on. */
    bool
    is_free_of_static_state(const std::string &line)
    {
      for (const char *const section :
           {"Time/", "Output/", "Ground motion/", "Modes/"})
        if (line.rfind(section, 0) == 0)
          return true;
      return false;
    }
  } // namespace


  std::string
  checksum(const std::string &bytes)
  {
    std::uint64_t sum = 0xcbf29ce484222325;
    for (const char byte : bytes)
      sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << sum;
    return text.str();
  }


  nlohmann::json
  identity_of(const Case &parameters)
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
              join(sections, "") + Utilities::trim(line.substr(4, equals - 4));
            if (is_free(entry))
              continue;
            const std::string value = line.substr(equals + 1);
            result.push_back(entry + " =" + value);
            for (const std::string &part : split_list(value))
              if (const std::string sum =
                    checksum_of_file(parameters.file.resolve(part));
                  !sum.empty())
                result.push_back(entry + " with the file \"" + part +
                                 "\" of the checksum " + sum);
          }
      }
    return result;
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
    const nlohmann::json mine = identity_of(parameters);
    const auto           line = [](const nlohmann::json &lines, std::size_t i) {
      return i < lines.size() ? Utilities::trim(lines[i].get<std::string>()) :
                                          std::string("nothing");
    };
    for (std::size_t i = 0; i < std::max(mine.size(), identity.size()); ++i)
      if (line(mine, i) != line(identity, i))
        throw UserError("The checkpoint \"" + checkpoint +
                        "\" was written with \"" + line(identity, i) +
                        "\", the case now has \"" + line(mine, i) +
                        "\"; restart with the same one, or start afresh.");
  }
} // namespace Voussoir
