#include <voussoir/files/hdf5_file.h>

#include <filesystem>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  std::string
  problem_of(const MPI_Comm communicator, const std::function<void()> &action)
  {
    std::string mine;
    try
      {
        action();
      }
    catch (const FileProblem &problem)
      {
        mine = problem.what;
      }
    for (const std::string &problem :
         Utilities::MPI::all_gather(communicator, mine))
      if (!problem.empty())
        return problem;
    return "";
  }


  RowRange
  own_rows(const hsize_t n, const MPI_Comm communicator)
  {
    const auto all = Utilities::MPI::all_gather(communicator, n);
    const auto own =
      all.begin() + Utilities::MPI::this_mpi_process(communicator);
    return {std::accumulate(all.begin(), own, hsize_t(0)),
            n,
            std::accumulate(all.begin(), all.end(), hsize_t(0))};
  }


  RowRange
  even_rows(const hsize_t all, const MPI_Comm communicator)
  {
    const hsize_t n_ranks = Utilities::MPI::n_mpi_processes(communicator),
                  rank    = Utilities::MPI::this_mpi_process(communicator),
                  first   = all * rank / n_ranks;
    return {first, all * (rank + 1) / n_ranks - first, all};
  }


  HDF5Handle::HDF5Handle(const hid_t id,
                         herr_t (*close)(hid_t),
                         const char *problem)
    : id(id)
    , close(close)
  {
    if (id < 0)
      throw FileProblem{problem};
  }


  HDF5Handle::~HDF5Handle()
  {
    close(id);
  }


  namespace
  {
    constexpr char not_written[] =
      "it could not be written completely; check whether the disk is full";


    void
    check(const herr_t result, const char *problem)
    {
      if (result < 0)
        throw FileProblem{problem};
    }


    /** Checks for disk space, where the system reports it, also for a small
     *  file: cutting it would not make the room in which it can be closed. */
    void
    check_room(const std::string &file, const double bytes)
    {
      constexpr double of_library = 65536.; // beside the numbers
      std::error_code  none;
      const auto       space =
        std::filesystem::space(std::filesystem::path(file).parent_path(), none);
      if (none || bytes + of_library <= space.available)
        return;
      std::ostringstream problem;
      problem << std::fixed << std::setprecision(1) << "it needs "
              << 1e-6 * (bytes + of_library) << " MB, and the disk has "
              << 1e-6 * space.available << " MB left";
      throw FileProblem{problem.str()};
    }


    /** Rows of a dataset in the file and in memory, for a transfer. */
    struct Selection
    {
      Selection(const RowRange &rows, const hsize_t width, const char *problem)
        : in_file(space(rows.all, width), H5Sclose, problem)
        , in_memory(space(rows.n, width), H5Sclose, problem)
      {
        const hsize_t start[2]{rows.first, 0}, count[2]{rows.n, width};
        check(rows.n > 0 ?
                H5Sselect_hyperslab(
                  in_file, H5S_SELECT_SET, start, nullptr, count, nullptr) :
                H5Sselect_none(in_file),
              problem);
        if (rows.n == 0)
          check(H5Sselect_none(in_memory), problem);
      }

      static hid_t
      space(const hsize_t rows, const hsize_t width)
      {
        const hsize_t size[2]{rows, width};
        return H5Screate_simple(2, size, nullptr);
      }

      HDF5Handle in_file, in_memory;
    };
  } // namespace


  HDF5Writer::HDF5Writer(const std::string &name,
                         const MPI_Comm     communicator,
                         const double       bytes)
    : name(name)
    , communicator(communicator)
    , file(create(name, communicator, bytes), H5Fclose, not_written)
  {}


  void
  HDF5Writer::write(const std::string &name, const Bytes &bytes)
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    write(name, bytes, own_rows(first ? bytes.size() : 0, communicator), 1);
  }


  void
  HDF5Writer::flush()
  {
    together([&] { check(H5Fflush(file, H5F_SCOPE_GLOBAL), not_written); });
  }


  hid_t
  HDF5Writer::create(const std::string &name,
                     const MPI_Comm     communicator,
                     const double       bytes)
  {
    check_room(name, Utilities::MPI::sum(bytes, communicator));
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const HDF5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, not_written);
    check(H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL), not_written);
    return H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  }


  void
  HDF5Writer::write(const std::string &name,
                    const hid_t        type,
                    const void        *numbers,
                    const RowRange    &rows,
                    const unsigned int width)
  {
    // all ranks continue or none does, as the next call is collective
    const Selection selection(rows, width, not_written);
    // the same results make the same file, at any time
    const HDF5Handle undated(H5Pcreate(H5P_DATASET_CREATE),
                             H5Pclose,
                             not_written);
    check(H5Pset_obj_track_times(undated, false), not_written);
    const HDF5Handle data(H5Dcreate2(file,
                                     name.c_str(),
                                     type,
                                     selection.in_file,
                                     H5P_DEFAULT,
                                     undated,
                                     H5P_DEFAULT),
                          H5Dclose,
                          not_written);
    together([&] {
      check(H5Dwrite(data,
                     type,
                     selection.in_memory,
                     selection.in_file,
                     H5P_DEFAULT,
                     numbers),
            not_written);
    });
  }


  void
  HDF5Writer::together(const std::function<void()> &action)
  {
    const std::string problem = problem_of(communicator, action);
    if (problem.empty())
      return;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::error_code ignored;
        std::filesystem::resize_file(name, 0, ignored);
      }
    MPI_Barrier(communicator);
    throw FileProblem{problem};
  }


  HDF5Reader::HDF5Reader(const std::string &name)
    : file(open(name), H5Fclose, hdf5_not_whole)
  {}


  Bytes
  HDF5Reader::read(const std::string &name) const
  {
    const hsize_t n = n_rows(name);
    return read<std::uint8_t>(name, {0, n, n}, 1);
  }


  hid_t
  HDF5Reader::open(const std::string &name)
  {
    // opening a pipe would block
    std::error_code none;
    if (!std::filesystem::is_regular_file(name, none))
      throw FileProblem{"it is not a regular file"};
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  }


  HDF5Handle
  HDF5Reader::dataset(const std::string &name) const
  {
    return HDF5Handle(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                      H5Dclose,
                      hdf5_not_whole);
  }


  hsize_t
  HDF5Reader::n_rows(const std::string &name) const
  {
    const HDF5Handle data = dataset(name);
    const HDF5Handle space(H5Dget_space(data), H5Sclose, hdf5_not_whole);
    hsize_t          size[2];
    if (H5Sget_simple_extent_ndims(space) != 2)
      throw FileProblem{hdf5_not_whole};
    check(H5Sget_simple_extent_dims(space, size, nullptr), hdf5_not_whole);
    return size[0];
  }


  void
  HDF5Reader::read(const std::string &name,
                   const hid_t        type,
                   void              *numbers,
                   const RowRange    &rows,
                   const unsigned int width) const
  {
    const HDF5Handle data = dataset(name);
    const Selection  selection(rows, width, hdf5_not_whole);
    check(H5Dread(data,
                  type,
                  selection.in_memory,
                  selection.in_file,
                  H5P_DEFAULT,
                  numbers),
          hdf5_not_whole);
  }
} // namespace Voussoir
