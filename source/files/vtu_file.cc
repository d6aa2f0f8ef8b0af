#include <voussoir/files/vtu_file.h>

#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The element of field data. A string is written as the numbers of its
     *  bytes, with a zero at the end. */
    std::string
    field_data(const double time, const std::vector<VtuText> &texts)
    {
      std::ostringstream out;
      out << "<FieldData>\n"
          << "<DataArray type=\"Float64\" Name=\"TIME\" NumberOfTuples=\"1\" "
             "format=\"ascii\">"
          << std::setprecision(17) << time << "</DataArray>\n";
      for (const VtuText &text : texts)
        {
          out << "<Array type=\"String\" Name=\"" << text.name
              << "\" NumberOfTuples=\"" << text.lines.size()
              << "\" format=\"ascii\">";
          for (const std::string &line : text.lines)
            {
              for (const char byte : line)
                out << static_cast<int>(byte) << ' ';
              out << "0 ";
            }
          out << "</Array>\n";
        }
      out << "</FieldData>\n";
      return out.str();
    }


    /** The patches of one rank without head and end of the file; empty if there
     *  are none, since ParaView accepts no empty piece at the beginning. */
    std::string
    piece_of(const std::string &file)
    {
      const std::string begin = "<Piece", end = "</Piece>\n";
      const auto        first = file.find(begin);
      const auto        past  = file.rfind(end) + end.size();
      const std::string piece = file.substr(first, past - first);
      const auto        none  = piece.find("NumberOfCells=\"0\"");
      return none < piece.find('>') ? "" : piece;
    }
  } // namespace


  template <int dim>
  bool
  write_vtu(DataOutInterface<dim, 3>   &output,
            const std::string          &file,
            const double                time,
            const std::vector<VtuText> &texts,
            Log                        &log)
  {
    const MPI_Comm        communicator = log.communicator();
    DataOutBase::VtkFlags flags;
    flags.compression_level        = DataOutBase::VtkFlags::best_speed;
    flags.write_higher_order_cells = false;
    output.set_flags(flags);

    // deal.II's own writer of parallel files leaves the other ranks waiting
    // when one cannot write, and has no strings. The time stands with the
    // strings: of several elements of field data VTK reads only the last one.
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    std::ostringstream own, part;
    output.write_vtu(own);
    if (rank == 0)
      DataOutBase::write_vtu_header(part, flags);
    part << piece_of(own.str());
    if (rank + 1 == Utilities::MPI::n_mpi_processes(communicator))
      {
        part << field_data(time, texts);
        DataOutBase::write_vtu_footer(part);
      }
    const std::string reason =
      write_file_in_parts(file, part.str(), communicator);
    log.attempted(file, reason);
    return reason.empty();
  }


  template bool
  write_vtu<2>(DataOutInterface<2, 3> &,
               const std::string &,
               const double,
               const std::vector<VtuText> &,
               Log &);
  template bool
  write_vtu<3>(DataOutInterface<3, 3> &,
               const std::string &,
               const double,
               const std::vector<VtuText> &,
               Log &);
} // namespace Voussoir
