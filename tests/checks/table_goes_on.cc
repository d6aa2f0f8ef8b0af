#include <voussoir/files/table.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "check.h"

namespace Voussoir
{
  namespace
  {
    /**
     * A table whose run continues from a checkpoint at the time of one of its
     * lines: if the run is killed before it has written that line again, the
     * table has lost no line that the checkpoint counts; afterwards it has each
     * line once.
     */
    class TableGoesOn : public Check
    {
    public:
      void
      run(const ParameterFile &,
          Verdicts      &verdicts,
          const MPI_Comm communicator) override
      {
        const std::string name = "goes_on.csv";
        std::filesystem::remove(name);
        Log        log(communicator, true);
        const auto open = [&](const double start_time, const bool restarted) {
          TimeTable table;
          table.open(log, name, {"value"}, 0.5, start_time, restarted);
          return table;
        };
        {
          TimeTable table = open(0., false);
          for (const double time : {0., 1., 2.})
            table.write(time, {10. * time});
          table.flush();
        }
        const auto at_checkpoint = std::filesystem::file_size(name);
        {
          TimeTable table = open(2., true);
          verdicts.is_true("all lines before the checkpoint are there",
                           std::filesystem::file_size(name) == at_checkpoint);
          table.write(2., {20.});
          table.flush();
        }
        verdicts.is_true("the line of its time is there once",
                         contents(name) == "time [s],value\n0,0\n1,10\n2,20\n");
        {
          TimeTable table = open(1., true);
          table.write(1., {11.});
          table.flush();
        }
        verdicts.is_true("those after an earlier one are gone",
                         contents(name) == "time [s],value\n0,0\n1,11\n");
      }

    private:
      static std::string
      contents(const std::string &name)
      {
        std::ostringstream text;
        text << std::ifstream(name).rdbuf();
        return text.str();
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<TableGoesOn>
      registered("table goes on",
                 "A table whose run continues from a checkpoint.");
  } // namespace
} // namespace Voussoir
