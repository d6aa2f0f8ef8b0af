#include <voussoir/driver/shipped_cases.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace Voussoir
{
  namespace
  {
    namespace fs = std::filesystem;

    /** Folder of the shipped cases beside the program; empty if there is none.
     */
    fs::path
    shipped_folder()
    {
      std::error_code error;
      const fs::path  program = fs::read_symlink("/proc/self/exe", error);
      for (const char *share : {"share/voussoir", ""})
        if (const fs::path folder =
              program.parent_path().parent_path() / share / "prm";
            fs::is_directory(folder, error))
          return folder;
      return {};
    }


    /** The comment at the head of a file, up to its first empty line. */
    std::string
    title(const fs::path &file)
    {
      std::ifstream in(file);
      std::string   text, line;
      while (std::getline(in, line) && line.rfind("# ", 0) == 0)
        text += (text.empty() ? "" : " ") + line.substr(2);
      return text;
    }
  } // namespace


  std::string
  find_case(const std::string &name)
  {
    std::error_code error;
    if (fs::exists(name, error))
      return name;
    fs::path shipped = fs::path(name).lexically_normal();
    if (shipped.is_absolute() || *shipped.begin() == "..")
      return name;
    if (*shipped.begin() == "prm")
      shipped = shipped.lexically_relative("prm");
    const fs::path folder = shipped_folder();
    if (folder.empty() || !fs::is_regular_file(folder / shipped, error))
      return name;
    return (folder / shipped).string();
  }


  void
  list_shipped_cases(std::ostream &out)
  {
    const fs::path folder = shipped_folder();
    if (folder.empty())
      return;
    std::set<fs::path> files;
    for (const auto &file : fs::recursive_directory_iterator(folder))
      if (file.path().extension() == ".prm")
        files.insert(file.path());
    for (const fs::path &file : files)
      out << file.lexically_relative(folder).string() << ": " << title(file)
          << '\n';
  }
} // namespace Voussoir
