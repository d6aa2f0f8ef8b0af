#include <filesystem>
#include <fstream>

#include "check.h"

namespace Voussoir
{
  namespace
  {
    /** Parameter files in all spellings and layouts are read, or refused by one
     *  sentence. */
    class ParameterText : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &, const MPI_Comm) override
      {
        const std::string text = "subsection Mesh\n"
                                 "  set Type = box # M\xC3\xBChle\n"
                                 "end\n"
                                 "subsection Materials\n"
                                 "  set Names = rock\n"
                                 "  subsection rock\n"
                                 "    set Cell sets = box\n"
                                 "  end\n"
                                 "end\n";
        const auto        with = [&](const std::string &old_part,
                              const std::string &new_part) {
          std::string changed = text;
          changed.replace(changed.find(old_part), old_part.size(), new_part);
          return changed;
        };
        const auto repeated = [](const std::string &part,
                                 const unsigned int n) {
          std::string result;
          for (unsigned int i = 0; i < n; ++i)
            result += part;
          return result;
        };
        std::string windows, old_mac = text;
        for (const char c : text)
          windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
        std::replace(old_mac.begin(), old_mac.end(), '\n', '\r');

        write_and_read("case.prm", text);
        write_and_read("byte order mark.prm", "\xEF\xBB\xBF" + text);
        write_and_read("lines of Windows.prm", windows);
        write_and_read("lines of an old Macintosh.prm", old_mac);
        write_and_read("last line open.prm", text.substr(0, text.size() - 1));
        write_and_read("no-break spaces.prm",
                       with("  set Type = box",
                            "\xC2\xA0 set Type =\xC2\xA0"
                            "box"));
        write_and_read("comment in Latin-1.prm", with("\xC3\xBC", "\xFC"));
        write_and_read("M\xC3\xBChle.prm", text);

        write_and_read("name in Latin-1.prm", with("rock\n", "F\xEBls\n"));
        write_and_read("M\xFChle.prm", text);
        write_and_read("zero byte.prm", with("box", std::string("b\0x", 3)));
        write_and_read("second equals sign.prm", with("= box", "= = box"));
        write_and_read("no name.prm", with("set Type", "set"));
        write_and_read("no section.prm", with("subsection Mesh", "subsection"));
        write_and_read("names empty.prm", with("= rock", "="));
        write_and_read("deep.prm", repeated("subsection a\n", 100000));
        write_and_read("large.prm", repeated(" ", 10000001));
        write_and_read("not a number.prm",
                       with("Cell sets = box", "Density = nan"));
        write_and_read("infinite.prm",
                       with("Cell sets = box", "Density = inf"));
        write_and_read("beyond all measures.prm",
                       with("Cell sets = box", "Density = 1e308"));
        std::filesystem::create_directory("folder.prm");
        read("folder.prm", {});
        read("missing.prm", {});
        read("case.prm", {"Mesh/Type= = box"});
        read("case.prm", {"Title=M\xFChle"});
        read("case.prm", {"Title=one", "Title = two"});
      }

    private:
      void
      write_and_read(const std::string &filename, const std::string &text) const
      {
        std::ofstream(filename, std::ios::binary) << text;
        read(filename, {});
      }

      void
      read(const std::string              &filename,
           const std::vector<std::string> &changes) const
      {
        std::string answer = filename + ": read";
        try
          {
            Case{ParameterFile(filename, changes)};
          }
        catch (const UserError &error)
          {
            answer = error.what();
          }
        // which a terminal may show in this form
        for (char &c : answer)
          if (static_cast<unsigned char>(c) > '~')
            c = '?';
        std::cout << answer << std::endl;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<ParameterText>
      registered("parameter text", "Parameter files in all sorts of writing.");
  } // namespace
} // namespace Voussoir
