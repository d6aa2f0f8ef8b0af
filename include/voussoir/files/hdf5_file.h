#ifndef voussoir_files_hdf5_file_h
#define voussoir_files_hdf5_file_h

#include <deal.II/base/mpi.h>

#include <hdf5.h>

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace Voussoir
{
  using Bytes = std::vector<std::uint8_t>;

  /** An error of one rank with a file, not yet passed to the other ranks. */
  struct FileProblem
  {
    std::string what;
  };

  /** Runs an action on all ranks; returns the error of the first rank that has
   *  one, or an empty text. */
  std::string
  problem_of(const MPI_Comm communicator, const std::function<void()> &action);

  constexpr char hdf5_not_whole[] = "it is cut or damaged";


  /** The rows of a dataset that belong to a rank. */
  struct RowRange
  {
    hsize_t first, n, all;
  };

  /** One after the other, as many as each rank has. */
  RowRange
  own_rows(const hsize_t n, const MPI_Comm communicator);

  /** About the same number for each rank. */
  RowRange
  even_rows(const hsize_t all, const MPI_Comm communicator);


  /** A handle of the HDF5 library, which is closed at the end. */
  class HDF5Handle
  {
  public:
    HDF5Handle(const hid_t id, herr_t (*close)(hid_t), const char *problem);

    HDF5Handle(const HDF5Handle &) = delete;

    ~HDF5Handle();

    operator hid_t() const
    {
      return id;
    }

  private:
    const hid_t id;
    herr_t (*const close)(hid_t);
  };


  /** A file that all ranks write together. Errors are FileProblems. */
  class HDF5Writer
  {
  public:
    /** @param bytes that this rank will write; refused where the disk has no
     *   room for those of all ranks */
    HDF5Writer(const std::string &name,
               const MPI_Comm     communicator,
               const double       bytes);

    template <typename Number>
    void
    write(const std::string         &name,
          const std::vector<Number> &numbers,
          const RowRange            &rows,
          const unsigned int         width);

    /** Written by the first rank. */
    void
    write(const std::string &name, const Bytes &bytes);

    void
    flush();

  private:
    static hid_t
    create(const std::string &name,
           const MPI_Comm     communicator,
           const double       bytes);

    void
    write(const std::string &name,
          const hid_t        type,
          const void        *numbers,
          const RowRange    &rows,
          const unsigned int width);

    /** Throws on all ranks if one has an error. The file is then abandoned, as
     *  the library cannot close a file on a full disk and would crash later. */
    void
    together(const std::function<void()> &action);

    const std::string name;
    const MPI_Comm    communicator;
    const HDF5Handle  file;
  };


  /** A file that a rank reads by itself. Errors are FileProblems. */
  class HDF5Reader
  {
  public:
    explicit HDF5Reader(const std::string &name);

    template <typename Number>
    std::vector<Number>
    read(const std::string &name,
         const RowRange    &rows,
         const unsigned int width) const;

    Bytes
    read(const std::string &name) const;

  private:
    static hid_t
    open(const std::string &name);

    HDF5Handle
    dataset(const std::string &name) const;

    hsize_t
    n_rows(const std::string &name) const;

    void
    read(const std::string &name,
         const hid_t        type,
         void              *numbers,
         const RowRange    &rows,
         const unsigned int width) const;

    const HDF5Handle file;
  };


  // ------------------------------------------------------------- templates

  template <typename Number>
  hid_t
  hdf5_type()
  {
    return std::is_same_v<Number, double>        ? H5T_NATIVE_DOUBLE :
           std::is_same_v<Number, std::uint64_t> ? H5T_NATIVE_UINT64 :
                                                   H5T_NATIVE_UINT8;
  }


  template <typename Number>
  void
  HDF5Writer::write(const std::string         &name,
                    const std::vector<Number> &numbers,
                    const RowRange            &rows,
                    const unsigned int         width)
  {
    write(name, hdf5_type<Number>(), numbers.data(), rows, width);
  }


  template <typename Number>
  std::vector<Number>
  HDF5Reader::read(const std::string &name,
                   const RowRange    &rows,
                   const unsigned int width) const
  {
    std::vector<Number> numbers(rows.n * width);
    read(name, hdf5_type<Number>(), numbers.data(), rows, width);
    return numbers;
  }
} // namespace Voussoir

#endif
