#include <voussoir/base/error.h>

#include <filesystem>
#include <fstream>

#include "check.h"
#include "folders.h"
#include "quiet_options.h"
#include "same.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * A run that is continued to a later end time has the results of one with
     * that end time from the beginning, bit for bit, also where the incident
     * wave is computed from a record at the free surface; a restart with a
     * changed record is refused.
     */
    class RestartLonger : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"at_once", "in_two"}, communicator);
        write_record(0., communicator);

        const double end = make_case(with(file, "at_once", 0.))->time.end_time;
        const auto   at_once = make_case(with(file, "at_once", end));
        Simulation   straight(*at_once, quiet_options(false), communicator);
        straight.run.march();

        const auto shorter = make_case(with(file, "in_two", 0.6 * end));
        Simulation(*shorter, quiet_options(false), communicator).run.march();
        const auto longer = make_case(with(file, "in_two", end));
        {
          Simulation going_on(*longer, quiet_options(true), communicator);
          verdicts.is_true("continues from between start and end",
                           going_on.run.state.time > 0.3 * end &&
                             going_on.run.state.time < 0.6 * end);
          going_on.run.march();
          verdicts.is_true("same warnings",
                           straight.log.warnings() == going_on.log.warnings());
          verdicts.is_true("same displacement, bit for bit",
                           same(straight.run.state.displacement,
                                going_on.run.state.displacement));
          verdicts.is_true("and the ground has moved",
                           straight.run.state.displacement.linfty_norm() >
                             1e-4);
        } // which leaves the folder to the next one
        std::ostringstream sentence_of_extension;
        sentence_of_extension << "The run in \"in_two\" had come to its end at "
                              << shorter->time.end_time
                              << " s and is extended to " << end << " s";
        verdicts.is_true(
          "the log says what is extended, and to when",
          text_of("in_two/log.txt").find(sentence_of_extension.str()) !=
            std::string::npos);

        write_record(1e-3, communicator);
        const auto  changed  = make_case(with(file, "in_two", 2. * end));
        std::string sentence = "accepted";
        try
          {
            Simulation(*changed, quiet_options(true), communicator);
          }
        catch (const UserError &error)
          {
            sentence = error.what();
          }
        verdicts.is_true("another record is refused by name",
                         sentence.find("surface.txt") != std::string::npos);
      }

    private:
      static ParameterFile
      with(const ParameterFile &file,
           const std::string   &folder,
           const double         end_time)
      {
        std::vector<std::string> changes{
          "Output/Folder=" + folder,
          "Ground motion/Type=record",
          "Ground motion/Record/File x=" +
            std::filesystem::absolute("surface.txt").string()};
        if (end_time > 0.)
          changes.push_back("Time/End time=" + std::to_string(end_time));
        return file.with(changes);
      }


      /** Writes times and one burst of a sine, amplified by 1 + @p more. */
      static void
      write_record(const double more, const MPI_Comm communicator)
      {
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          {
            std::ofstream out("surface.txt");
            for (unsigned int i = 0; i <= 200; ++i)
              {
                const double t = 0.005 * i, pulse = std::sin(numbers::PI * t);
                out << t << ' '
                    << (1. + more) * pulse * pulse *
                         std::sin(6. * numbers::PI * t)
                    << '\n';
              }
          }
        MPI_Barrier(communicator);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<RestartLonger>
      registered("restart longer", "Runs that go on to a later end time.");
  } // namespace
} // namespace Voussoir
