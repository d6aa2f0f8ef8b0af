#include <voussoir/base/mpi.h>
#include <voussoir/output/checkpoint.h>

#include "check.h"
#include "folders.h"
#include "same.h"
#include "with_files.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Numbers by name and by a key that does not depend on the partition. */
    using Content = std::map<std::string, std::map<std::uint64_t, std::string>>;


    /** The numbers of all ranks, on each rank, byte by byte. */
    std::map<std::uint64_t, std::string>
    gathered(const KeyedValues &values, const MPI_Comm communicator)
    {
      std::vector<std::pair<std::uint64_t, std::string>> mine;
      std::vector<double>                                scratch;
      for (std::size_t i = 0; i < values.items.size(); ++i)
        mine.emplace_back(values.items[i].first,
                          std::string(reinterpret_cast<const char *>(
                                        values.row(i, scratch)),
                                      values.width * sizeof(double)));
      const auto all = join_over_ranks(mine, communicator);
      return {all.begin(), all.end()};
    }


    /** All state that the next step depends on. */
    Content
    content_of(Simulation &simulation)
    {
      Run            &run          = simulation.run;
      const MPI_Comm  communicator = run.log.communicator();
      const NodalKeys nodes(run.model.solid.discretization);
      Content         content;
      const auto add = [&](const std::string &name, const KeyedValues &values) {
        content[name] = gathered(values, communicator);
      };
      add("displacement", nodes.values(run.state.displacement));
      add("velocity", nodes.values(run.state.velocity));
      for (unsigned int i = 0; i < run.state.memory.size(); ++i)
        add("damping memory " + std::to_string(i + 1),
            nodes.values(run.state.memory[i]));
      for (unsigned int m = 0; m < run.model.solid.materials.size(); ++m)
        if (PointHistory *history = run.state.material_memory.of(m))
          add("internal variables " + std::to_string(m + 1),
              history->checkpoint_values());
      if (run.contact)
        add("contact", run.contact->checkpoint_values());
      return content;
    }


    double
    number_of_cracked(const Run &run)
    {
      double cracked = 0.;
      for (unsigned int m = 0; m < run.model.solid.materials.size(); ++m)
        if (const PointHistory *history = run.state.material_memory.of(m))
          for (const auto &item : history->cells())
            for (unsigned int q = 0; q < history->n_points(); ++q)
              cracked += history->band(item.second, q) > 0. ? 1. : 0.;
      return Utilities::MPI::sum(cracked, run.log.communicator());
    }


    /**
     * With reproducible sums all ranks together, with either partition, compute
     * bit for bit what one rank computes by itself, and without reproducible
     * sums they do not: otherwise the comparison would prove nothing.
     */
    class Bitwise : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Tables", tables, "Files that must be the same.");
        prm.add_parameter("Cracked points",
                          cracked,
                          "Largest displacement, at least, at the end.");
        prm.add_parameter("Slip", slip, "Slip of an interface, at least [m].");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        remove_folders({"bitwise"}, communicator);
        const auto marched = [&](const std::string &sums,
                                 const std::string &partition,
                                 const MPI_Comm     ranks) {
          const auto parameters =
            make_case(file.with({"Discretization/Sums=" + sums,
                                 "Mesh/Partition=" + partition,
                                 "Output/Folder=bitwise/run"}));
          const auto simulation =
            make_simulation_with_files(*parameters, ranks);
          simulation->run.march();
          evaluate(simulation->run);
          Content content = content_of(*simulation);
          for (const std::string &table : split_list(tables))
            content[table][0] = text_of("bitwise/run/" + table);
          content["time step"][0] =
            std::to_string(simulation->run.time_step.length);
          return content;
        };
        const auto different = [&](const Content &alone,
                                   const Content &together) {
          std::string names;
          for (const auto &[name, values] : alone)
            if (values.empty() || values.begin()->second.empty() ||
                together.at(name) != values)
              names += (names.empty() ? "" : ", ") + name;
          return Utilities::MPI::broadcast(communicator, names);
        };

        for (const std::string partition : {"p4est", "METIS"})
          {
            // the static state is found by all ranks and kept for the single
            // rank
            const Content together =
              marched("reproducible", partition, communicator);
            Content alone;
            on_first(communicator, [&] {
              alone = marched("reproducible", partition, MPI_COMM_SELF);
            });
            verdicts.same_text("different from one rank, by " + partition,
                               different(alone, together),
                               "");
          }
        if (cracked > 0.)
          verdicts.above("cracked points", most_cracked, cracked);
        if (slip > 0.)
          verdicts.above("slip [m]", most_slip, slip);

        const Content together = marched("as dealt", "p4est", communicator);
        Content       alone;
        on_first(communicator,
                 [&] { alone = marched("as dealt", "p4est", MPI_COMM_SELF); });
        verdicts.is_true("as dealt they differ",
                         different(alone, together).find("displacement") !=
                           std::string::npos);
      }

    private:
      /** Stores numbers that show that joints and cracks take part. */
      void
      evaluate(const Run &run)
      {
        most_cracked = number_of_cracked(run);
        if (run.contact)
          for (const ContactPoint &point : run.contact->points())
            most_slip = std::max(most_slip, point.largest_slip);
        most_slip = Utilities::MPI::max(most_slip, run.log.communicator());
      }

      std::string tables  = "histories.csv";
      double      cracked = 0., slip = 0., most_cracked = 0., most_slip = 0.;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Bitwise>
      registered("bitwise", "Reproducible sums hold bit for bit.");
  } // namespace
} // namespace Voussoir
