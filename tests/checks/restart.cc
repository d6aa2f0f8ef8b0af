#include <voussoir/base/error.h>
#include <voussoir/base/interruption.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>

#include "check.h"
#include "folders.h"
#include "quiet_options.h"
#include "same.h"
#include "test_observer.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Sends the program the signal of Ctrl-C at a given time. */
    class Interruption : public TestObserver
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Times", time, "Times of interruption [s].");
      }

      void
      observe(const State &state) override
      {
        if (!sent && state.time >= time)
          std::raise(SIGINT);
        sent = state.time >= time;
      }

    private:
      double time = 0.;
      bool   sent = false;
    };

    const Registry<Observer>::Add<Interruption>
      interruption("interruption", "Interrupts a run, for the tests.");


    /**
     * A run that is interrupted and continues from its checkpoint equals the
     * uninterrupted run: bit for bit on the same number of ranks, to round-off
     * on others.
     */
    class Restart : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders(
          {"straight", "together", "older", "refused", "alone", "metis"},
          communicator);

        const auto straight = make_case(folder(file, "straight", false));
        Simulation uninterrupted(*straight, quiet_options(false), communicator);
        uninterrupted.run.march();

        // on the same ranks
        const auto stopped = make_case(folder(file, "together", true));
        interrupt(*stopped, communicator, verdicts);
        copy("together", "older", communicator);
        copy("together", "refused", communicator);
        const std::vector<std::string> unfinished{
          "together/checkpoint/step-000000000000.h5.unfinished-20-7.lock",
          "together/checkpoint/step-000000000000.h5.unfinished",
          "together/fields/fields-00000000.vtu.part-20-7.lock",
          "together/summary.json.part"};
        const std::string of_user = "together/checkpoint/notes.lock";
        on_first(communicator, [&] {
          for (const std::string &name : unfinished)
            std::ofstream(name) << "?";
          std::ofstream(of_user) << "!";
        });
        const auto continued = make_case(folder(file, "together", false));
        Simulation going_on(*continued, quiet_options(true), communicator);
        verdicts.is_true("it continues from a time between start and end",
                         going_on.run.state.time > 0. &&
                           going_on.run.state.time < continued->time.end_time);
        const auto is_there = [](const std::string &name) {
          return std::filesystem::exists(name);
        };
        verdicts.is_true("what a killed run leaves behind is removed",
                         std::none_of(unfinished.begin(),
                                      unfinished.end(),
                                      is_there) &&
                           is_there(of_user));
        going_on.run.march();
        verdicts.is_true("same displacement, bit for bit",
                         same(uninterrupted.run.state.displacement,
                              going_on.run.state.displacement));
        verdicts.is_true("same velocity, bit for bit",
                         same(uninterrupted.run.state.velocity,
                              going_on.run.state.velocity));
        bool memory = !going_on.run.state.memory.empty();
        for (unsigned int i = 0; i < going_on.run.state.memory.size(); ++i)
          memory = memory && same(uninterrupted.run.state.memory[i],
                                  going_on.run.state.memory[i]);
        verdicts.is_true("same damping memory, bit for bit", memory);
        for (unsigned int i = 0;
             i < uninterrupted.run.setup->plan.observers.size();
             ++i)
          for (const auto &[name, vector] :
               uninterrupted.run.setup->plan.observers[i]
                 .second->checkpoint_vectors())
            verdicts.is_true("same " + name + ", bit for bit",
                             same(*vector,
                                  *going_on.run.setup->plan.observers[i]
                                     .second->checkpoint_vectors()
                                     .at(name)));
        for (unsigned int i = 0;
             i < uninterrupted.run.setup->plan.observers.size();
             ++i)
          for (const auto &[name, values] :
               uninterrupted.run.setup->plan.observers[i]
                 .second->checkpoint_values())
            verdicts.is_true(
              "same " + uninterrupted.run.setup->plan.observers[i].first +
                " of " + name + ", bit for bit",
              same(values,
                   going_on.run.setup->plan.observers[i]
                     .second->checkpoint_values()
                     .at(name),
                   communicator));
        if (uninterrupted.run.contact)
          compare_contact(*uninterrupted.run.contact,
                          *going_on.run.contact,
                          communicator,
                          verdicts);
        verdicts.is_true("same list of pictures",
                         text_of("straight/fields.txt") ==
                             text_of("together/fields.txt") &&
                           text_of("straight/fields.txt").size() > 100);
        verdicts.is_true("same histories.csv",
                         text_of("straight/histories.csv") ==
                             text_of("together/histories.csv") &&
                           text_of("straight/histories.csv").size() > 1000);
        compare_tables("straight", "together", verdicts);

        // the newest checkpoint is damaged, so it continues from the one before
        damage("older", communicator);
        const auto older = make_case(folder(file, "older", false));
        Simulation older_run(*older, quiet_options(true), communicator);
        verdicts.is_true("with a damaged checkpoint it continues from t = 0",
                         older_run.run.state.step == 0);
        older_run.run.march();
        verdicts.is_true("same displacement, bit for bit",
                         same(uninterrupted.run.state.displacement,
                              older_run.run.state.displacement));
        verdicts.is_true("same histories.csv",
                         text_of("straight/histories.csv") ==
                           text_of("older/histories.csv"));
        verdicts.is_true("same energy.csv",
                         text_of("straight/energy.csv") ==
                           text_of("older/energy.csv"));

        // written by one rank, continued by all
        on_first(communicator, [&] {
          const auto alone = make_case(folder(file, "alone", true));
          interrupt(*alone, MPI_COMM_SELF, verdicts);
        });
        copy("alone", "metis", communicator);
        const auto shared = make_case(folder(file, "alone", false));
        Simulation shared_run(*shared, quiet_options(true), communicator);
        shared_run.run.march();
        verdicts.below("difference after a change of ranks",
                       difference(uninterrupted.run.state.displacement,
                                  shared_run.run.state.displacement),
                       1e-9);
        compare_tables("straight", "alone", verdicts);
        if (uninterrupted.run.contact)
          compare_energies(*uninterrupted.run.contact,
                           *shared_run.run.contact,
                           verdicts);

        // and by cells distributed otherwise
        const auto dealt = make_case(
          folder(file, "metis", false).with({"Mesh/Partition=METIS"}));
        Simulation dealt_run(*dealt, quiet_options(true), communicator);
        dealt_run.run.march();
        compare_tables("straight", "metis", verdicts);

        refuse(folder(file, "refused", false).with({"Discretization/Degree=3"}),
               communicator,
               verdicts);
        refuse(folder(file, "refused", false)
                 .with({"Output/histories/Points=top: 1 1 1"}),
               communicator,
               verdicts);
        refuse(folder(file, "nowhere", false), communicator, verdicts);
        refuse(folder(file, "refused", false).with({"Time/End time=0.1"}),
               communicator,
               verdicts);
        refuse(folder(file, "straight", false), communicator, verdicts);
      }

    private:
      static ParameterFile
      folder(const ParameterFile &file,
             const std::string   &name,
             const bool           interrupted)
      {
        return file.with({"Output/Folder=" + name,
                          "Static state/Keep in=", // each rank finds its own
                          std::string("Output/interruption/Times=") +
                            (interrupted ? "0.2" : "1e9")});
      }


      static void
      interrupt(Case          &parameters,
                const MPI_Comm communicator,
                Verdicts      &verdicts)
      {
        bool stopped = false;
        listen_to_signals(); // a second SIGINT would kill
        try
          {
            Simulation(parameters, quiet_options(false), communicator)
              .run.march();
          }
        catch (const Stopped &)
          {
            stopped = true;
          }
        verdicts.is_true("the run is interrupted", stopped);
      }


      /** A folder under another name. */
      static void
      copy(const std::string &from,
           const std::string &to,
           const MPI_Comm     communicator)
      {
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          std::filesystem::copy(from,
                                to,
                                std::filesystem::copy_options::recursive);
        MPI_Barrier(communicator);
      }


      /** Fills the middle of the newest checkpoint with zeros. */
      static void
      damage(const std::string &folder, const MPI_Comm communicator)
      {
        if (Utilities::MPI::this_mpi_process(communicator) == 0)
          {
            std::string newest;
            for (const auto &file :
                 std::filesystem::directory_iterator(folder + "/checkpoint"))
              if (file.path().filename().string().rfind("step-", 0) == 0)
                newest = std::max(newest, file.path().string());
            std::fstream file(newest,
                              std::ios::in | std::ios::out | std::ios::binary);
            const auto   size = std::filesystem::file_size(newest);
            file.seekp(size / 4);
            file << std::string(size / 2, '\0');
          }
        MPI_Barrier(communicator);
      }


      static void
      refuse(const ParameterFile &file,
             const MPI_Comm       communicator,
             Verdicts            &verdicts)
      {
        const auto  parameters = make_case(file);
        std::string sentence   = "accepted";
        try
          {
            Simulation(*parameters, quiet_options(true), communicator);
          }
        catch (const UserError &error)
          {
            // the time of interruption differs from run to run
            sentence = std::regex_replace(error.what(),
                                          std::regex("step-[0-9]+"),
                                          "step-N");
            sentence = std::regex_replace(sentence,
                                          std::regex("is of [0-9.]+ s"),
                                          "is of T s");
          }
        verdicts.is_true("refused: " + sentence, sentence != "accepted");
      }


      static void
      compare_contact(Contact       &a,
                      Contact       &b,
                      const MPI_Comm communicator,
                      Verdicts      &verdicts)
      {
        unsigned int slid = 0, open = 0;
        for (const ContactPoint &point : a.points())
          {
            slid += point.largest_slip > 0.;
            open += point.history.opening > 0.;
          }
        verdicts.is_true("points have slid and opened",
                         Utilities::MPI::sum(slid, communicator) > 0 &&
                           Utilities::MPI::sum(open, communicator) > 0);
        verdicts.is_true("same forces and history of contact, bit for bit",
                         same(a.checkpoint_values(),
                              b.checkpoint_values(),
                              communicator));
        verdicts.is_true("same energies of each surface, bit for bit",
                         a.save().at("energies") == b.save().at("energies"));
        compare_energies(a, b, verdicts);
      }


      static void
      compare_energies(const Contact &a, const Contact &b, Verdicts &verdicts)
      {
        // of all surfaces together: where two surfaces meet in a node, the
        // shares of its friction are indeterminate
        const nlohmann::json saved = a.save(), saved_too = b.save();
        double               change = 0., size = 0.;
        for (unsigned int part = 0; part < 5; ++part)
          {
            double energy = 0., too = 0.;
            for (std::size_t s = 0; s < a.surfaces().size(); ++s)
              {
                energy += saved["energies"][s][part].get<double>();
                too += saved_too["energies"][s][part].get<double>();
              }
            keep_largest(change, std::abs(energy - too));
            keep_largest(size, std::abs(energy));
          }
        verdicts.below("change of the energies of contact over the largest",
                       change / size,
                       1e-8);
      }


      static double
      difference(const Vector &a, const Vector &b)
      {
        Vector change = a;
        change -= b;
        return largest_entry(change) / largest_entry(a);
      }


      /** The numbers of a table without its heading. */
      static std::vector<double>
      numbers(const std::string &name)
      {
        std::ifstream in(name);
        std::string   line, word;
        std::getline(in, line);
        std::vector<double> values;
        while (std::getline(in, line))
          for (std::istringstream words(line); std::getline(words, word, ',');)
            values.push_back(std::stod(word));
        return values;
      }


      // the tables have nine digits; sums over other numbers of ranks round
      // differently
      static void
      compare_tables(const std::string &reference,
                     const std::string &folder,
                     Verdicts          &verdicts)
      {
        for (const std::string table : {"/histories.csv",
                                        "/energy.csv",
                                        "/support_forces.csv",
                                        "/section_forces.csv",
                                        "/over_stress.csv",
                                        "/response_spectra.csv"})
          {
            if (!std::filesystem::exists(reference + table))
              continue;
            const auto a = numbers(reference + table);
            const auto b = numbers(folder + table);
            verdicts.is_true("as many numbers in" + (" " + folder + table),
                             a.size() == b.size());
            double change = 0., size = 0.;
            for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
              {
                keep_largest(change, std::abs(a[i] - b[i]));
                keep_largest(size, std::abs(a[i]));
              }
            verdicts.below("largest change in it over the largest number",
                           change / size,
                           1e-8);
          }
        const auto a =
          nlohmann::json::parse(text_of(reference + "/summary.json"));
        const auto b = nlohmann::json::parse(text_of(folder + "/summary.json"));
        for (const std::string quantity :
             {"largest displacement [m]",
              "largest filtered acceleration [m/s2]"})
          verdicts.near("  " + quantity,
                        b.at("histories").at("top").at(quantity),
                        a.at("histories").at("top").at(quantity),
                        1e-8);
        if (!a.contains("face stresses"))
          return;
        for (const std::string quantity :
             {"largest arch stress [MPa]", "smallest principal stress [MPa]"})
          verdicts.near("  " + quantity,
                        b.at("face stresses").at(quantity),
                        a.at("face stresses").at(quantity),
                        1e-8);
        const std::string quantity = "smallest arch moment [MNm/m]";
        verdicts.near("  " + quantity,
                      b.at("section forces").at("middle").at(quantity),
                      a.at("section forces").at("middle").at(quantity),
                      1e-8);
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Restart>
      registered("restart", "Interrupted and continued runs.");
  } // namespace
} // namespace Voussoir
