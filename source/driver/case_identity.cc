#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case_identity.h>

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
                                              "Output/Energy interval",
                                              "Output/Energy limit",
                                              "Output/Checkpoint interval",
                                              "Output/Checkpoint time"};
      if (free.count(entry) > 0)
        return true;
      // of observers: when they write
      const std::string last = entry.substr(entry.rfind('/') + 1);
      return entry.rfind("Output/", 0) == 0 &&
             (last == "Interval" || last == "Times");
    }


    /** FNV-1a of what a file holds; empty if it is none. */
    std::string
    checksum_of_file(const std::string &name)
    {
      std::error_code none;
      if (!std::filesystem::is_regular_file(name, none))
        return "";
      std::ifstream in(name, std::ios::binary);
      std::uint64_t sum = 0xcbf29ce484222325;
      for (char byte; in.get(byte);)
        sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
      std::ostringstream text;
      text << std::hex << std::setw(16) << std::setfill('0') << sum;
      return text.str();
    }
  } // namespace


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
                result.push_back("what is in the file \"" + part + "\" of " +
                                 entry + ", with the checksum " + sum);
          }
      }
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
