#include <voussoir/files/table.h>
#include <voussoir/output/picture_series.h>

#include <deal.II/base/data_out_base.h>

#include <fstream>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  PictureSeries::PictureSeries(const std::string &name,
                               const std::string &section)
    : name(name)
    , section(section)
  {}


  void
  PictureSeries::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Interval",
                      interval,
                      "Time between two pictures [s]; 0 for the pictures of "
                      "\"Times\" only.",
                      Patterns::Double(0.));
    prm.add_parameter("Times",
                      times,
                      "Further times of pictures [s].",
                      Patterns::List(Patterns::Double(0.)));
  }


  void
  PictureSeries::check(const ObservedModel &model) const
  {
    for (const double time : times)
      if (time > model.end_time)
        model.log.line("note: no picture at ",
                       time,
                       " s, which \"Times\" in section \"",
                       section,
                       "\" names: the run ends at ",
                       model.end_time,
                       " s");
  }


  void
  PictureSeries::prepare(const ObservedRun &run)
  {
    folder    = run.folder;
    time_step = run.time_step;
    log       = &run.log;
    pictures.clear();
    const std::string list_file = folder + "/" + name + ".txt";
    const double      before    = run.start_time - 0.5 * time_step;
    if (run.restarted)
      {
        std::ifstream in(list_file);
        double        time;
        std::string   file;
        while (in >> time >> file)
          if (time < before)
            pictures.emplace_back(time, file);
      }
    list =
      log->grow(list_file, run.restarted ? size_before(list_file, before) : 0);
  }


  bool
  PictureSeries::due(const State &state) const
  {
    bool result =
      interval > 0. && Schedule(interval, time_step).due(state.step);
    for (const double time : times)
      result = result || std::abs(state.time - time) <= 0.5 * time_step;
    return result;
  }


  std::string
  PictureSeries::next_name(const State &state) const
  {
    std::ostringstream text;
    text << name << '/' << name << '-' << std::setw(8) << std::setfill('0')
         << state.step;
    return text.str();
  }


  void
  PictureSeries::add(const double time, const std::string &file)
  {
    if (file.empty())
      return;
    pictures.emplace_back(time, file);
    if (Utilities::MPI::this_mpi_process(log->communicator()) != 0)
      return;
    std::ostringstream pvd, line;
    DataOutBase::write_pvd_record(pvd, pictures);
    const std::string pvd_file = folder + "/" + name + ".pvd";
    log->attempted(pvd_file, write_file(pvd_file, pvd.str()));
    line << std::setprecision(17) << time << ' ' << file << '\n';
    list->append(line.str());
    log->write(*list);
  }


  std::size_t
  PictureSeries::size() const
  {
    return pictures.size();
  }
} // namespace Voussoir
