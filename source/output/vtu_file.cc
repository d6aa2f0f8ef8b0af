#include <voussoir/base/error.h>
#include <voussoir/output/vtu_file.h>

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** The element of field data. Strings are the numbers of their bytes, each
     *  with a zero at its end. */
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


    /** Puts the field data in before the end of the file, since deal.II writes
     *  no texts. The time is among them: of several elements of field data VTK
     *  reads the last one only.
     *  @return whether that was possible */
    bool
    add_field_data(const std::string &file, const std::string &data)
    {
      std::ostringstream end;
      DataOutBase::write_vtu_footer(end);
      std::string  found(end.str().size(), ' ');
      std::fstream stream(file,
                          std::ios::in | std::ios::out | std::ios::binary);
      stream.seekg(-std::streamoff(found.size()), std::ios::end);
      const auto place = stream.tellg();
      stream.read(found.data(), found.size());
      if (!stream || found != end.str())
        return false;
      stream.seekp(place);
      stream << data << end.str() << std::flush;
      return stream.good();
    }
  } // namespace


  template <int dim>
  void
  write_vtu(DataOutInterface<dim, 3>   &output,
            const std::string          &file,
            const double                time,
            const std::vector<VtuText> &texts,
            const MPI_Comm              communicator)
  {
    DataOutBase::VtkFlags flags;
    flags.compression_level        = DataOutBase::VtkFlags::best_speed;
    flags.write_higher_order_cells = false;
    output.set_flags(flags);
    output.write_vtu_in_parallel(file, communicator);
    const bool written = Utilities::MPI::this_mpi_process(communicator) != 0 ||
                         add_field_data(file, field_data(time, texts));
    if (Utilities::MPI::min(written ? 1 : 0, communicator) == 0)
      throw UserError("The file \"" + file +
                      "\" cannot be written; look whether the disk is full.");
  }


  template void
  write_vtu<2>(DataOutInterface<2, 3> &,
               const std::string &,
               const double,
               const std::vector<VtuText> &,
               const MPI_Comm);
  template void
  write_vtu<3>(DataOutInterface<3, 3> &,
               const std::string &,
               const double,
               const std::vector<VtuText> &,
               const MPI_Comm);
} // namespace Voussoir
