#include <voussoir/files/hdf5_file.h>
#include <voussoir/files/tension_file.h>

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cstring>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // numbers of a cell: centre, edges, stress, material
    constexpr unsigned int width = 14;
  } // namespace


  std::string
  tension_file(const std::string &folder)
  {
    return folder + "/largest_tension.h5";
  }


  std::string
  write_tension(const std::string &file,
                const TensionFile &tension,
                const MPI_Comm     communicator)
  {
    std::vector<double> numbers;
    for (const CellTension &cell : tension.cells)
      {
        for (unsigned int d = 0; d < 3; ++d)
          numbers.push_back(cell.frame.centre[d]);
        for (unsigned int i = 0; i < 9; ++i)
          numbers.push_back(cell.frame.edges[i / 3][i % 3]);
        numbers.push_back(cell.stress);
        numbers.push_back(cell.material);
      }
    const std::string unfinished = file + ".unfinished";
    return problem_of(communicator, [&] {
      const RowRange rows = own_rows(tension.cells.size(), communicator);
      {
        HDF5Writer writer(unfinished, communicator, 8. * numbers.size());
        writer.write(
          "head",
          nlohmann::json::to_cbor(
            {{"materials", tension.materials},
             {"lower", {tension.lower[0], tension.lower[1], tension.lower[2]}},
             {"upper", {tension.upper[0], tension.upper[1], tension.upper[2]}},
             {"cells", rows.all}}));
        writer.write("cells", numbers, rows, width);
        writer.flush();
      }
      if (Utilities::MPI::this_mpi_process(communicator) == 0 &&
          std::rename(unfinished.c_str(), file.c_str()) != 0)
        throw FileProblem{std::strerror(errno)};
    });
  }


  TensionFile
  read_tension(const std::string &file)
  {
    const HDF5Reader     reader(file);
    const nlohmann::json head =
      nlohmann::json::from_cbor(reader.read("head"), true, false);
    if (!head.is_object())
      throw FileProblem{hdf5_not_whole};
    TensionFile tension;
    head.at("materials").get_to(tension.materials);
    for (unsigned int d = 0; d < 3; ++d)
      {
        tension.lower[d] = head.at("lower").at(d);
        tension.upper[d] = head.at("upper").at(d);
      }
    const hsize_t n       = head.at("cells");
    const auto    numbers = reader.read<double>("cells", {0, n, n}, width);
    for (const double *cell = numbers.data();
         cell != numbers.data() + n * width;
         cell += width)
      {
        CellTension read;
        for (unsigned int d = 0; d < 3; ++d)
          read.frame.centre[d] = cell[d];
        for (unsigned int i = 0; i < 9; ++i)
          read.frame.edges[i / 3][i % 3] = cell[3 + i];
        read.stress   = cell[12];
        read.material = static_cast<unsigned int>(cell[13]);
        tension.cells.push_back(read);
      }
    return tension;
  }
} // namespace Voussoir
