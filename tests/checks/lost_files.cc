#include <voussoir/base/error.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "folders.h"
#include "same.h"
#include "test_observer.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    /** Damages the results in the middle of a run. */
    class Harm : public TestObserver
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Kind", kind, "What it does.");
        prm.add_parameter("Times", time, "When [s].");
      }

      void
      prepare() override
      {
        done = false;
      }

      void
      observe(const State &state) override
      {
        if (done || state.time < time)
          return;
        done = true;
        on_first(communicator(), [this] { harm(); });
      }

    private:
      void
      harm() const
      {
        const std::string &folder = run().folder;
        const std::string  table  = folder + "/histories.csv";
        if (kind == "folder removed")
          fs::remove_all(folder);
        else if (kind == "folder moved")
          fs::rename(folder, folder + "_elsewhere");
        else if (kind == "table removed")
          fs::remove(table);
        else if (kind == "table replaced")
          {
            std::ofstream(table + ".new") << text_of(table) << "0,0,0,0\n";
            fs::rename(table + ".new", table);
          }
        else if (kind == "table cut off")
          fs::resize_file(table, fs::file_size(table) / 2);
        else if (kind == "picture removed")
          fs::remove(folder + "/fields/fields-00000000.vtu");
      }

      std::string kind;
      double      time = 0.;

      bool done = false;
    };

    const Registry<Observer>::Add<Harm>
      harm("harm", "Takes results away, for the tests.");


    /**
     * Results that are removed during a run are not created again without their
     * beginning: the run names the missing files and ends with an error. No run
     * continues without them.
     */
    class LostFiles : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        const auto folder_of = [](std::string kind) {
          std::replace(kind.begin(), kind.end(), ' ', '_');
          return kind;
        };
        for (const std::string kind : {"nothing",
                                       "folder removed",
                                       "folder moved",
                                       "table removed",
                                       "table replaced",
                                       "table cut off",
                                       "picture removed"})
          {
            const std::string folder = folder_of(kind);
            remove_folders({folder, folder + "_elsewhere"}, communicator);
            verdicts.same_text(kind,
                               march(file, kind, folder, communicator),
                               end_of(kind, folder));
            verdicts.is_true(kind + ": no file has bytes that are zero",
                             !has_zeros(folder));
          }
        verdicts.is_true("the table removed is not made anew",
                         !fs::exists("table_removed/histories.csv"));
        verdicts.near(
          "files that the summary names",
          read_summary("table_removed").at("files not written").size(),
          1,
          0.);

        // restart from a checkpoint: it stores the size of each table, and must
        // be a file
        const auto go_on = [&](const std::string           &name,
                               const std::function<void()> &change,
                               const std::string           &sentence) {
          remove_folders({"restart"}, communicator);
          march(file, "nothing", "restart", communicator);
          on_first(communicator, change);
          verdicts.same_text("restart, " + name,
                             march(file.with({"Time/End time=0.2"}),
                                   "nothing",
                                   "restart",
                                   communicator,
                                   true),
                             sentence);
        };
        const std::string table       = "restart/histories.csv",
                          checkpoints = "restart/checkpoint/step-00000000";
        const std::string since =
          " since the checkpoint \"" + checkpoints +
          "2000.h5\" was written; restore the file, or start the case anew.";
        go_on(
          "table removed",
          [&] { fs::remove(table); },
          "The file \"" + table + "\" is missing" + since);
        go_on(
          "table cut off",
          [&] { fs::resize_file(table, 100); },
          "The file \"" + table + "\" has been cut off" + since);
        go_on(
          "pipes for checkpoints",
          [&] {
            for (const std::string step : {"0000", "2000"})
              {
                fs::remove(checkpoints + step + ".h5");
                mkfifo((checkpoints + step + ".h5").c_str(), 0600);
              }
          },
          "There is no checkpoint in \"restart\" to restart from (\"" +
            checkpoints + "2000.h5\": it is not a regular file; \"" +
            checkpoints +
            "0000.h5\": it is not a regular file); run the case without "
            "--restart.");
        go_on(
          "nothing changed", [] {}, "done");

        // the list of pictures has no file before the first one
        const ParameterFile without =
          file.with({"Output/fields/Interval=0", "Output/fields/Times="});
        remove_folders({"restart"}, communicator);
        march(without, "nothing", "restart", communicator);
        verdicts.same_text("restart, no picture yet",
                           march(without.with({"Time/End time=0.2"}),
                                 "nothing",
                                 "restart",
                                 communicator,
                                 true),
                           "done");
      }

    private:
      static std::string
      march(const ParameterFile &file,
            const std::string   &kind,
            const std::string   &folder,
            const MPI_Comm       communicator,
            const bool           restart = false)
      {
        RunOptions options;
        options.quiet     = true;
        options.overwrite = !restart;
        options.restart   = restart;
        try
          {
            const auto parameters = make_case(file.with(
              {"Output/Folder=" + folder, "Output/harm/Kind=" + kind}));
            Simulation(*parameters, options, communicator).run.march();
          }
        catch (const UserError &error)
          {
            return error.what();
          }
        return "done";
      }

      /** How a run ends. */
      static std::string
      end_of(const std::string &kind, const std::string &folder)
      {
        const auto lost = [](const std::string &files,
                             const std::string &reason) {
          return "Done, but \"" + files + " could not be written because " +
                 reason + "; remove the cause and run the case again.";
        };
        const std::string removed = "it was removed while the run went on";
        if (kind == "nothing")
          return "done";
        if (kind == "folder removed" || kind == "folder moved")
          return lost(folder +
                        "/energy.csv\" and 18 other files (see the warnings)",
                      removed);
        if (kind == "picture removed")
          return lost(folder + "/fields/fields-00000000.vtu\"", removed);
        return lost(folder + "/histories.csv\"",
                    kind == "table removed" ?
                      removed :
                    kind == "table replaced" ?
                      "another file was put in its place while the run went "
                      "on" :
                      "it was cut off while the run went on");
      }

      static bool
      has_zeros(const std::string &folder)
      {
        std::error_code none;
        for (const auto &entry : fs::directory_iterator(folder, none))
          if (entry.is_regular_file() &&
              text_of(entry.path()).find('\0') != std::string::npos)
            return true;
        return false;
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<LostFiles>
      registered("lost files", "Results that are taken away during a run.");
  } // namespace
} // namespace Voussoir
