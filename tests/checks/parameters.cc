#include <voussoir/driver/command_line.h>

#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The output of the program for some arguments. */
    std::string
    printed(std::vector<std::string> arguments)
    {
      std::ostringstream    text;
      std::streambuf *const terminal = std::cout.rdbuf(text.rdbuf());
      arguments.insert(arguments.begin(), "voussoir");
      std::vector<char *> pointers;
      for (std::string &argument : arguments)
        pointers.push_back(argument.data());
      const int code =
        run_command_line(pointers.size(), pointers.data(), MPI_COMM_SELF);
      std::cout.rdbuf(terminal);
      return code == 0 ? text.str() : "";
    }


    /** The printed parameters of a case can be read again and give the same
     *  case; every kind of class can be listed. */
    class Parameters : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Case", name, "The case to print.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const std::string original = file.resolve(name);
        for (const std::string format : {"prm", "short"})
          {
            const std::string text = printed({original, "--defaults", format});
            std::ofstream("again.prm") << text;
            verdicts.is_true("printed as " + format +
                               ", read and printed again",
                             text.size() > 1000 &&
                               printed({"again.prm", "--defaults", format}) ==
                                 text);
          }
        verdicts.is_true(
          "--set changes what is printed",
          printed(
            {original, "--set", "Time/End time=3.25", "--defaults", "short"})
              .find("= 3.25\n") != std::string::npos);
        for (const std::string format : {"description", "json", "xml", "latex"})
          verdicts.is_true("printed as " + format,
                           printed({original, "--defaults", format}).size() >
                             1000);
        const auto all = nlohmann::json::parse(printed({"--defaults", "json"}));
        check_all_classes<InterfaceLaw>(all, "Interfaces", verdicts);
        check_all_classes<Material>(all, "Materials", verdicts);
        check_all_classes<Load>(all, "Loads", verdicts);
        check_all_classes<Projection>(all, "Constraints", verdicts);
        check_all_classes<Observer>(all, "Output", verdicts);
        check_all_classes<MeshGenerator>(all, "Mesh", verdicts);
        verdicts.is_true("without a case: entries of mesh files",
                         all.at("Mesh").contains("file"));
        for (const std::string kind : {"constraints",
                                       "interfaces",
                                       "loads",
                                       "materials",
                                       "meshes",
                                       "observers"})
          verdicts.is_true("--list " + kind,
                           printed({"--list", kind}).find(": ") !=
                             std::string::npos);
        verdicts.is_true("--help names every option",
                         printed({"--help"}).find("--restart") !=
                           std::string::npos);
        verdicts.is_true("--version", !printed({"--version"}).empty());
      }

    private:
      /** Whether a section, as printed without a case, has a subsection with
       *  entries for each class. */
      template <typename Base>
      static void
      check_all_classes(const nlohmann::json &all,
                        const std::string    &section,
                        Verdicts             &verdicts)
      {
        bool complete = true;
        for (const std::string &name : Registry<Base>::names())
          complete = complete && all.at(section).contains(name) &&
                     !all.at(section).at(name).empty();
        verdicts.is_true("without a case: every class of " + section, complete);
      }

      std::string name;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Parameters>
      registered("parameters", "Printing and reading of a case.");
  } // namespace
} // namespace Voussoir
