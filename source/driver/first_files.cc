#include <voussoir/driver/first_files.h>
#include <voussoir/files/table.h>
#include <voussoir/output/field_writer.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    void
    write_accelerations(const EarthquakeMotion &motion,
                        const std::string      &folder,
                        Log                    &log)
    {
      const auto              &components = motion.accelerations;
      std::vector<std::string> titles{"time [s]"};
      std::size_t              n_samples = 0;
      for (unsigned int d = 0; d < 3; ++d)
        if (!components[d].empty())
          {
            titles.push_back(std::string("acceleration ") + "xyz"[d] +
                             " [m/s2]");
            n_samples = components[d].size();
          }
      if (n_samples == 0 ||
          Utilities::MPI::this_mpi_process(log.communicator()) != 0)
        return;
      std::string text = csv_heading(titles) + '\n';
      for (std::size_t i = 0; i < n_samples; ++i)
        {
          std::vector<double> line{i * EarthquakeMotion::sample_interval};
          for (const auto &component : components)
            if (!component.empty())
              line.push_back(component[i]);
          text += csv_line(line) + '\n';
        }
      const std::string name = folder + "/ground_motion.csv";
      log.attempted(name, write_file(name, text));
    }


    /** Spectra of a matched motion beside their targets. */
    void
    write_spectra(const std::vector<SpectrumFit> &fits,
                  const std::string              &folder,
                  Log                            &log)
    {
      if (fits.empty() ||
          Utilities::MPI::this_mpi_process(log.communicator()) != 0)
        return;
      std::vector<std::string>         titles{"period [s]"};
      std::vector<std::vector<double>> columns{fits[0].periods};
      for (const SpectrumFit &fit : fits)
        {
          const std::string component(1, "xyz"[fit.component]);
          titles.push_back(component + " target [m/s2]");
          titles.push_back(component + " scaled record [m/s2]");
          titles.push_back(component + " matched [m/s2]");
          columns.push_back(fit.target);
          columns.push_back(fit.before);
          columns.push_back(fit.after);
        }
      const std::string name = folder + "/ground_motion_spectra.csv";
      log.attempted(name, write_file(name, csv_of_columns(titles, columns)));
    }
  } // namespace


  void
  write_ground_motion(const EarthquakeMotion &motion,
                      const std::string      &folder,
                      Log                    &log)
  {
    write_accelerations(motion, folder, log);
    write_spectra(motion.fits, folder, log);
  }


  void
  write_static_stages(const nlohmann::json &static_state,
                      const std::string    &folder,
                      Log                  &log)
  {
    if (!static_state.contains("stages") ||
        Utilities::MPI::this_mpi_process(log.communicator()) != 0)
      return;
    std::string text;
    for (const nlohmann::json &stage : static_state.at("stages"))
      {
        std::vector<std::string> titles{"stage"},
          line{stage.at("name").get<std::string>()};
        const auto add = [&](const std::string &title, const double value) {
          titles.push_back(title);
          line.push_back(csv_line({value}));
        };
        const auto add_vector = [&](const std::string    &what,
                                    const std::string    &unit,
                                    const nlohmann::json &vector,
                                    const double          factor) {
          for (unsigned int d = 0; d < 3; ++d)
            add(what + ' ' + "xyz"[d] + ' ' + unit,
                factor * vector.at(d).get<double>());
        };
        add_vector("loads so far",
                   "[MN]",
                   stage.at("sum of loads so far [N]"),
                   1e-6);
        add_vector("reactions", "[MN]", stage.at("sum of reactions [N]"), 1e-6);
        add("largest displacement [m]", stage.at("largest displacement [m]"));
        add_vector("largest displacement",
                   "[m]",
                   stage.at("largest displacement x, y, z [m]"),
                   1.);
        add_vector("place of the largest displacement",
                   "[m]",
                   stage.at("place of the largest displacement [m]"),
                   1.);
        for (const char *group : {"points", "faces", "interfaces"})
          if (stage.contains(group))
            for (const auto &[name, values] : stage.at(group).items())
              for (const auto &[quantity, value] : values.items())
                if (value.is_number())
                  add(name + ' ' + quantity, value);
        if (text.empty())
          text = csv_heading(titles) + '\n';
        text += csv_heading(line) + '\n';
      }
    const std::string name = folder + "/static_stages.csv";
    log.attempted(name, write_file(name, text));
  }


  void
  write_modes(const Modes &modes, const ObservedRun &run)
  {
    if (modes.list.empty())
      return;
    std::vector<NodalField> fields;
    for (unsigned int j = 0; j < modes.list.size(); ++j)
      {
        std::ostringstream name;
        name << std::setprecision(4) << "mode " << j + 1 << " ("
             << modes.list[j].frequency << " Hz)";
        fields.push_back({&modes.list[j].shape, {name.str()}});
      }
    write_fields(run, fields, nullptr, "modes", 0.);
  }
} // namespace Voussoir
