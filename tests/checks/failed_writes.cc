#include <voussoir/base/error.h>
#include <voussoir/base/file.h>

#include <filesystem>

#include "folders.h"
#include "limit_files.h"
#include "same.h"
#include "test_observer.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const char *const too_large =
      "it would be larger than files may be here (ulimit -f)";

    /** Limits the size of files during a part of a run. */
    class FullDisk : public TestObserver
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("From",
                          from,
                          "Time from which the disk is full [s].");
        prm.add_parameter("To",
                          to,
                          "Time from which there is space again [s].");
        prm.add_parameter("Size", size, "Largest size of files [bytes].");
      }

      void
      observe(const State &state) override
      {
        limit_files(state.time >= from && state.time < to ? size :
                                                            RLIM_INFINITY);
      }

    private:
      double       from = 0., to = 0.;
      unsigned int size = 0;
    };

    const Registry<Observer>::Add<FullDisk>
      full_disk("full disk", "Limits the size of files, for the tests.");


    /**
     * A disk that is full for a while costs the pictures of that time, and
     * nothing else; a disk that stays full is reported, and the run ends with
     * an error.
     */
    class FailedWrites : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        on_first(communicator, [&verdicts] { evaluate_files(verdicts); });
        const auto march = [&](const std::string &folder,
                               const std::string &from,
                               const std::string &to) {
          const auto parameters =
            make_case(file.with({"Output/Folder=" + folder,
                                 "Output/full disk/From=" + from,
                                 "Output/full disk/To=" + to}));
          std::string end = "done";
          // the output must not grow either
          said.str("");
          std::streambuf *terminal = std::cout.rdbuf(said.rdbuf());
          try
            {
              make_simulation_with_files(*parameters, communicator)
                ->run.march();
            }
          catch (const UserError &error)
            {
              end = error.what();
            }
          std::cout.rdbuf(terminal);
          limit_files(RLIM_INFINITY);
          MPI_Barrier(communicator);
          return end;
        };

        const std::string rest =
          std::string(" (see the warnings) could not be written because ") +
          too_large + "; remove the cause and run the case again.";
        verdicts.same_text("with space", march("room", "9", "9"), "done");
        verdicts.same_text(
          "full for a while",
          march("while", "0.0295", "0.0595"),
          "Done, but \"while/fields/fields-00000600.vtu\" and 2 other files" +
            rest);
        for (const std::string table : {"histories.csv", "energy.csv"})
          verdicts.is_true("all of " + table + " is there",
                           text_of("room/" + table).size() > 3000 &&
                             text_of("while/" + table) ==
                               text_of("room/" + table));
        verdicts.is_true("pictures of that time are missing from the list",
                         pictures("room") == 11 && pictures("while") == 8);
        verdicts.is_true("and from the folder",
                         files_in("room/fields") == 11 &&
                           files_in("while/fields") == 8);
        const nlohmann::json summary = read_summary("while");
        const auto          &missing = summary["files not written"];
        verdicts.near("files that the summary names", missing.size(), 3, 0.);
        for (const std::string step : {"600", "800", "1000"})
          {
            const std::string name = "while/fields/fields-" +
                                     std::string(8 - step.size(), '0') + step +
                                     ".vtu";
            verdicts.same_text("the summary names " + name,
                               missing.value(name, std::string("nothing")),
                               too_large);
          }
        for (const std::string file :
             {"histories.csv", "energy.csv", "fields/fields-00000600.vtu"})
          verdicts.is_true("the summary warns of " + file + ", as was said",
                           warns_of(summary, "while/" + file) &&
                             text_of("while/log.txt").find(file) !=
                               std::string::npos);

        verdicts.same_text("full to the end",
                           march("full", "0.0295", "9"),
                           "Done, but \"full/energy.csv\" and 11 other files" +
                             rest);
        verdicts.is_true("histories.csv ends with a whole line",
                         text_of("full/histories.csv").size() > 1000 &&
                           text_of("room/histories.csv")
                               .rfind(text_of("full/histories.csv"), 0) == 0 &&
                           text_of("full/histories.csv").back() == '\n');
        verdicts.is_true("no part of a summary",
                         !fs::exists("full/summary.json") &&
                           !fs::exists("full/summary.json.part"));
      }

    private:
      static void
      evaluate_files(Verdicts &verdicts)
      {
        const auto report = [&](const std::string &what,
                                const std::string &reason,
                                const std::string &expected = "written") {
          verdicts.same_text(what,
                             reason.empty() ? "written" : reason,
                             expected);
        };
        fs::remove_all("files");
        fs::create_directories("files/folder");
        report("a new file", write_file("files/a", "first"));
        report("in a folder that does not exist",
               write_file("nowhere/a", "text"),
               "its folder does not exist");
        report("in a file",
               write_file("files/a/b", "text"),
               "a part of its path is not a folder");
        report("with the name of a folder",
               write_file("files/folder", "text"),
               "there is a folder of that name");
        report("with a long name",
               write_file(std::string(300, 'a'), "text"),
               "the name is too long");
        report("full disk",
               write_file("/dev/full", "text"),
               "the disk is full");
        limit_files(100);
        const std::string too_long =
          write_file("files/a", std::string(200, '.'));
        limit_files(RLIM_INFINITY); // before this check writes to its own file
        report("too long", too_long, too_large);
        verdicts.is_true("what was there before is there still",
                         text_of("files/a") == "first");
        fs::create_symlink("a", "files/link");
        report("through a link", write_file("files/link", "second"));
        verdicts.is_true("which stays one",
                         fs::is_symlink("files/link") &&
                           text_of("files/a") == "second");

        fs::create_symlink("/dev/full", "files/growing");
        GrowingFile growing;
        growing.open("files/growing");
        growing.append("one\n");
        report("a file that grows on a full disk",
               growing.flush(),
               "the disk is full");
        fs::remove("files/growing");
        growing.append("two\n");
        report("with space", growing.flush());
        limit_files(10);
        growing.append("three\n");
        const std::string too_little = growing.flush();
        limit_files(RLIM_INFINITY);
        report("with too little space", too_little, too_large);
        verdicts.is_true("no part of what does not fit",
                         text_of("files/growing") == "one\ntwo\n");
        report("with space again", growing.flush());
        verdicts.is_true("all of it",
                         text_of("files/growing") == "one\ntwo\nthree\n");
        verdicts.is_true("nothing else is left", files_in("files") == 4);
      }

      static bool
      warns_of(const nlohmann::json &summary, const std::string &file)
      {
        const auto &warnings = summary["warnings"];
        return std::any_of(warnings.begin(),
                           warnings.end(),
                           [&](const std::string &warning) {
                             return warning.find('"' + file + '"') !=
                                    std::string::npos;
                           });
      }

      static std::size_t
      files_in(const std::string &folder)
      {
        return std::distance(fs::directory_iterator(folder), {});
      }

      static std::size_t
      pictures(const std::string &folder)
      {
        const std::string list = text_of(folder + "/fields.txt");
        return std::count(list.begin(), list.end(), '\n');
      }

      std::ostringstream said;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<FailedWrites>
      registered("failed writes", "Results on a full disk.");
  } // namespace
} // namespace Voussoir
