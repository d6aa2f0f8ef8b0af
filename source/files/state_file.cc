#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/files/state_file.h>

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr int format = 3;

    // Rows that are read in one exchange.
    constexpr std::size_t items_at_once = 1 << 14;

    using Words = std::vector<std::uint64_t>;
    using Bytes = std::vector<std::uint8_t>;


    /** An error of one rank, of which the others are not informed yet. */
    struct Problem
    {
      std::string what;
    };


    /** Runs an action on all ranks; returns the error of the first rank that
     *  has one, or an empty text. */
    std::string
    problem_of(const MPI_Comm communicator, const std::function<void()> &action)
    {
      std::string mine;
      try
        {
          action();
        }
      catch (const Problem &problem)
        {
          mine = problem.what;
        }
      for (const std::string &problem :
           Utilities::MPI::all_gather(communicator, mine))
        if (!problem.empty())
          return problem;
      return "";
    }


    // splitmix64: neighbouring words become uncorrelated
    std::uint64_t
    mixed(std::uint64_t word)
    {
      word += 0x9e3779b97f4a7c15;
      word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9;
      word = (word ^ (word >> 27)) * 0x94d049bb133111eb;
      return word ^ (word >> 31);
    }


    std::uint64_t
    checksum(const Bytes &bytes)
    {
      std::uint64_t sum = bytes.size();
      for (const std::uint8_t byte : bytes)
        sum = mixed(sum ^ byte);
      return sum;
    }


    /** Rows of numbers, each with its key. */
    struct Rows
    {
      explicit Rows(const unsigned int width)
        : width(width)
      {}

      const double *
      row(const std::size_t i) const
      {
        return numbers.data() + i * width;
      }

      /** Checksum of the rows of all ranks, independent of their order. */
      std::uint64_t
      checksum(const MPI_Comm communicator) const
      {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < keys.size(); ++i)
          {
            std::uint64_t of_row = mixed(keys[i]);
            for (unsigned int k = 0; k < width; ++k)
              {
                std::uint64_t bits;
                std::memcpy(&bits, row(i) + k, sizeof(bits));
                of_row = mixed(of_row ^ bits);
              }
            sum += of_row;
          }
        MPI_Allreduce(
          MPI_IN_PLACE, &sum, 1, MPI_UINT64_T, MPI_SUM, communicator);
        return sum;
      }

      unsigned int        width;
      Words               keys;
      std::vector<double> numbers;
    };


    /** Rows of zeros are not kept. */
    bool
    is_kept(const double *row, const unsigned int width)
    {
      return std::any_of(row, row + width, [](const double x) {
        return x != 0. || std::signbit(x);
      });
    }


    std::size_t
    n_kept(const KeyedValues &values)
    {
      std::size_t         n = 0;
      std::vector<double> scratch;
      for (std::size_t i = 0; i < values.items.size(); ++i)
        n += is_kept(values.row(i, scratch), values.width);
      return n;
    }


    Rows
    rows_of(const KeyedValues &values)
    {
      Rows rows(values.width);
      rows.keys.reserve(n_kept(values));
      rows.numbers.reserve(rows.keys.capacity() * rows.width);
      std::vector<double> scratch;
      for (std::size_t i = 0; i < values.items.size(); ++i)
        if (const double *row = values.row(i, scratch);
            is_kept(row, rows.width))
          {
            rows.keys.push_back(values.items[i].first);
            rows.numbers.insert(rows.numbers.end(), row, row + rows.width);
          }
      return rows;
    }


    /** Which rows of a dataset are those of a rank. */
    struct Part
    {
      hsize_t first, n, all;
    };


    /** One after the other, as many as each rank has. */
    Part
    own_part(const hsize_t n, const MPI_Comm communicator)
    {
      const auto all = Utilities::MPI::all_gather(communicator, n);
      const auto own =
        all.begin() + Utilities::MPI::this_mpi_process(communicator);
      return {std::accumulate(all.begin(), own, hsize_t(0)),
              n,
              std::accumulate(all.begin(), all.end(), hsize_t(0))};
    }


    /** About the same number for each rank. */
    Part
    even_part(const hsize_t all, const MPI_Comm communicator)
    {
      const hsize_t n_ranks = Utilities::MPI::n_mpi_processes(communicator),
                    rank    = Utilities::MPI::this_mpi_process(communicator),
                    first   = all * rank / n_ranks;
      return {first, all * (rank + 1) / n_ranks - first, all};
    }


    template <typename Number>
    hid_t
    type_of()
    {
      return std::is_same_v<Number, double>        ? H5T_NATIVE_DOUBLE :
             std::is_same_v<Number, std::uint64_t> ? H5T_NATIVE_UINT64 :
                                                     H5T_NATIVE_UINT8;
    }


    /** A handle of the HDF5 library, which is closed at the end. */
    class Handle
    {
    public:
      Handle(const hid_t id, herr_t (*close)(hid_t), const char *problem)
        : id(id)
        , close(close)
      {
        if (id < 0)
          throw Problem{problem};
      }

      Handle(const Handle &) = delete;

      ~Handle()
      {
        close(id);
      }

      operator hid_t() const
      {
        return id;
      }

    private:
      const hid_t id;
      herr_t (*const close)(hid_t);
    };


    void
    check(const herr_t result, const char *problem)
    {
      if (result < 0)
        throw Problem{problem};
    }


    constexpr char not_written[] =
      "it could not be written completely; check whether the disk is full",
                   not_whole[] = "it is cut or damaged";


    /** Rows of a dataset in the file and in memory, for a transfer. */
    struct Selection
    {
      Selection(const Part &part, const hsize_t width, const char *problem)
        : in_file(space(part.all, width), H5Sclose, problem)
        , in_memory(space(part.n, width), H5Sclose, problem)
      {
        const hsize_t start[2]{part.first, 0}, count[2]{part.n, width};
        check(part.n > 0 ?
                H5Sselect_hyperslab(
                  in_file, H5S_SELECT_SET, start, nullptr, count, nullptr) :
                H5Sselect_none(in_file),
              problem);
        if (part.n == 0)
          check(H5Sselect_none(in_memory), problem);
      }

      static hid_t
      space(const hsize_t rows, const hsize_t width)
      {
        const hsize_t size[2]{rows, width};
        return H5Screate_simple(2, size, nullptr);
      }

      Handle in_file, in_memory;
    };


    /** A file that all ranks write together. */
    class Writer
    {
    public:
      Writer(const std::string &name, const MPI_Comm communicator)
        : name(name)
        , communicator(communicator)
        , file(create(name, communicator), H5Fclose, not_written)
      {}

      template <typename Number>
      void
      write(const std::string         &name,
            const std::vector<Number> &numbers,
            const Part                &part,
            const unsigned int         width)
      {
        // either all ranks continue or none, as the next call is collective
        const Selection selection(part, width, not_written);
        const Handle    data(H5Dcreate2(file,
                                     name.c_str(),
                                     type_of<Number>(),
                                     selection.in_file,
                                     H5P_DEFAULT,
                                     H5P_DEFAULT,
                                     H5P_DEFAULT),
                          H5Dclose,
                          not_written);
        together([&] {
          check(H5Dwrite(data,
                         type_of<Number>(),
                         selection.in_memory,
                         selection.in_file,
                         H5P_DEFAULT,
                         numbers.data()),
                not_written);
        });
      }

      /** Written by the first rank. */
      void
      write(const std::string &name, const Bytes &bytes)
      {
        const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
        write(name, bytes, own_part(first ? bytes.size() : 0, communicator), 1);
      }

      void
      flush()
      {
        together([&] { check(H5Fflush(file, H5F_SCOPE_GLOBAL), not_written); });
      }

    private:
      static hid_t
      create(const std::string &name, const MPI_Comm communicator)
      {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, not_written);
        check(H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL),
              not_written);
        return H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
      }

      /** Throws on all ranks if one has an error. The file is then abandoned,
       *  as the library cannot close a file on a full disk, and crashes later.
       */
      void
      together(const std::function<void()> &action)
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
        throw Problem{problem};
      }

      const std::string name;
      const MPI_Comm    communicator;
      const Handle      file;
    };


    /** A file that a rank reads by itself. */
    class Reader
    {
    public:
      explicit Reader(const std::string &name)
        : file(open(name), H5Fclose, not_whole)
      {}

      hsize_t
      n_rows(const std::string &name) const
      {
        const Handle data = dataset(name);
        const Handle space(H5Dget_space(data), H5Sclose, not_whole);
        hsize_t      size[2];
        if (H5Sget_simple_extent_ndims(space) != 2)
          throw Problem{not_whole};
        check(H5Sget_simple_extent_dims(space, size, nullptr), not_whole);
        return size[0];
      }

      template <typename Number>
      std::vector<Number>
      read(const std::string &name,
           const Part        &part,
           const unsigned int width) const
      {
        const Handle        data = dataset(name);
        const Selection     selection(part, width, not_whole);
        std::vector<Number> numbers(part.n * width);
        check(H5Dread(data,
                      type_of<Number>(),
                      selection.in_memory,
                      selection.in_file,
                      H5P_DEFAULT,
                      numbers.data()),
              not_whole);
        return numbers;
      }

      Bytes
      read(const std::string &name) const
      {
        const hsize_t n = n_rows(name);
        return read<std::uint8_t>(name, {0, n, n}, 1);
      }

    private:
      static hid_t
      open(const std::string &name)
      {
        // opening a pipe would block
        std::error_code none;
        if (!std::filesystem::is_regular_file(name, none))
          throw Problem{"it is not a regular file"};
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
        return H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
      }

      Handle
      dataset(const std::string &name) const
      {
        return Handle(H5Dopen2(file, name.c_str(), H5P_DEFAULT),
                      H5Dclose,
                      not_whole);
      }

      const Handle file;
    };


    Bytes
    bytes_of(const nlohmann::json &value)
    {
      return nlohmann::json::to_cbor(value);
    }


    nlohmann::json
    value_of(const Bytes &bytes, const std::uint64_t expected)
    {
      if (checksum(bytes) != expected)
        throw Problem{not_whole};
      return nlohmann::json::from_cbor(bytes);
    }


    /** The table of contents, with the header of the user. */
    nlohmann::json
    contents_of(const Reader &reader)
    {
      const auto sum = reader.read<std::uint64_t>("checksum", {0, 1, 1}, 1);
      const nlohmann::json contents =
        value_of(reader.read("contents"), sum.at(0));
      if (contents.at("format") != format)
        throw Problem{"another version of Voussoir wrote it"};
      return contents;
    }


    Rows
    read_rows(const Reader         &reader,
              const std::string    &number,
              const nlohmann::json &entry,
              const MPI_Comm        communicator)
    {
      Rows       rows(entry.at("width"));
      const Part part = even_part(entry.at("rows"), communicator);
      rows.keys       = reader.read<std::uint64_t>("keys " + number, part, 1);
      rows.numbers = reader.read<double>("numbers " + number, part, rows.width);
      return rows;
    }


    /** Sends items of @p width numbers, @p n_to [r] of them to rank r, in the
     *  order of ranks; returns the received items in the same order. */
    template <typename Number>
    std::vector<Number>
    exchange(const std::vector<Number> &numbers,
             const unsigned int         width,
             const std::vector<int>    &n_to,
             const std::vector<int>    &n_from,
             const MPI_Comm             communicator)
    {
      static_assert(sizeof(Number) == sizeof(std::uint64_t));
      const auto starts = [](const std::vector<int> &n) {
        std::vector<int> result(n.size());
        std::partial_sum(n.begin(), n.end() - 1, result.begin() + 1);
        return result;
      };
      const std::vector<int> to = starts(n_to), from = starts(n_from);
      std::vector<Number>    received(std::size_t(width) *
                                   (from.back() + n_from.back()));
      MPI_Datatype           item;
      MPI_Type_contiguous(width, MPI_UINT64_T, &item);
      MPI_Type_commit(&item);
      MPI_Alltoallv(numbers.data(),
                    n_to.data(),
                    to.data(),
                    item,
                    received.data(),
                    n_from.data(),
                    from.data(),
                    item,
                    communicator);
      MPI_Type_free(&item);
      return received;
    }


    /** Sends each key to the rank that keeps it: any, but the same for all who
     *  have that key. */
    struct Addresses
    {
      Addresses(const Words &keys, const MPI_Comm communicator)
        : n_to(Utilities::MPI::n_mpi_processes(communicator))
        , n_from(n_to.size())
      {
        std::vector<std::vector<std::size_t>> places(n_to.size());
        for (std::size_t i = 0; i < keys.size(); ++i)
          places[mixed(keys[i]) % n_to.size()].push_back(i);
        for (std::size_t rank = 0; rank < n_to.size(); ++rank)
          {
            n_to[rank] = places[rank].size();
            order.insert(order.end(), places[rank].begin(), places[rank].end());
          }
        MPI_Alltoall(
          n_to.data(), 1, MPI_INT, n_from.data(), 1, MPI_INT, communicator);
      }

      std::vector<int>         n_to, n_from;
      std::vector<std::size_t> order; // of the sent rows
    };


    template <typename Number>
    std::vector<Number>
    ordered(const std::vector<Number>      &numbers,
            const unsigned int              width,
            const std::vector<std::size_t> &order)
    {
      std::vector<Number> result;
      result.reserve(numbers.size());
      for (const std::size_t i : order)
        result.insert(result.end(),
                      numbers.begin() + i * width,
                      numbers.begin() + (i + 1) * width);
      return result;
    }


    /** Sends the rows from any ranks to those that have their keys; numbers
     *  without a row become zero. */
    void
    distribute(const Rows        &rows,
               const KeyedValues &values,
               const MPI_Comm     communicator)
    {
      const unsigned int width = rows.width;
      const Addresses    to_keeper(rows.keys, communicator);
      Rows               kept(width);
      kept.keys    = exchange(ordered(rows.keys, 1, to_keeper.order),
                           1,
                           to_keeper.n_to,
                           to_keeper.n_from,
                           communicator);
      kept.numbers = exchange(ordered(rows.numbers, width, to_keeper.order),
                              width,
                              to_keeper.n_to,
                              to_keeper.n_from,
                              communicator);
      std::unordered_map<std::uint64_t, std::size_t> place;
      for (std::size_t i = 0; i < kept.keys.size(); ++i)
        place[kept.keys[i]] = i;

      // in parts, as most rows may be zeros that only the ranks' memory holds
      const std::size_t last =
        Utilities::MPI::max(values.items.size(), communicator);
      for (std::size_t first = 0; first < last; first += items_at_once)
        {
          Words keys;
          for (std::size_t i = first;
               i < std::min(first + items_at_once, values.items.size());
               ++i)
            keys.push_back(values.items[i].first);
          const Addresses     from_keeper(keys, communicator);
          std::vector<double> replies;
          for (const std::uint64_t key :
               exchange(ordered(keys, 1, from_keeper.order),
                        1,
                        from_keeper.n_to,
                        from_keeper.n_from,
                        communicator))
            {
              const auto found = place.find(key);
              if (found == place.end())
                replies.insert(replies.end(), width, 0.);
              else
                replies.insert(replies.end(),
                               kept.row(found->second),
                               kept.row(found->second) + width);
            }
          const auto numbers = exchange(
            replies, width, from_keeper.n_from, from_keeper.n_to, communicator);
          const double *row = numbers.data();
          for (const std::size_t i : from_keeper.order)
            {
              values.set(first + i, row);
              row += width;
            }
        }
    }


    /** Whether the disk has space for the rows, as far as that can be known. */
    void
    check_room(const std::string  &file,
               const StateContent &content,
               const MPI_Comm      communicator)
    {
      double bytes = 0.;
      for (const auto &[name, values] : content.values)
        bytes += n_kept(values) * 8. * (values.width + 1.);
      bytes = Utilities::MPI::sum(bytes, communicator);
      std::error_code none;
      const auto      space =
        std::filesystem::space(std::filesystem::path(file).parent_path(), none);
      if (!none && bytes > space.available)
        {
          std::ostringstream problem;
          problem << std::fixed << std::setprecision(1) << "it needs "
                  << 1e-6 * bytes << " MB, and the disk has "
                  << 1e-6 * space.available << " MB left";
          throw Problem{problem.str()};
        }
    }


    /** Renames the file to its final name once it is on the disk. */
    void
    put_in_place(const std::string &unfinished, const std::string &file)
    {
      const int  open_file = open(unfinished.c_str(), O_WRONLY);
      const bool on_disk   = open_file >= 0 && fsync(open_file) == 0;
      if (open_file >= 0)
        close(open_file);
      if (!on_disk || std::rename(unfinished.c_str(), file.c_str()) != 0)
        throw Problem{std::strerror(errno)};
      // the name itself, where the file system can synchronise folders
      const std::string folder = std::filesystem::path(file).parent_path();
      const int open_folder    = open(folder.c_str(), O_RDONLY | O_DIRECTORY);
      if (open_folder >= 0)
        {
          fsync(open_folder);
          close(open_folder);
        }
    }
  } // namespace


  void
  write_state(const std::string    &file,
              const nlohmann::json &header,
              const StateContent   &content,
              const MPI_Comm        communicator)
  {
    const bool first = Utilities::MPI::this_mpi_process(communicator) == 0;
    const std::string unfinished = file + ".unfinished";
    std::error_code   ignored; // stands for an error when the file is written
    if (first)
      std::filesystem::create_directory(
        std::filesystem::path(file).parent_path(), ignored);
    MPI_Barrier(communicator);

    std::string problem = problem_of(communicator, [&] {
      check_room(file, content, communicator);
      nlohmann::json contents{{"format", format},
                              {"header", header},
                              {"values", nlohmann::json::array()},
                              {"documents", nlohmann::json::array()}};
      Writer         writer(unfinished, communicator);
      for (const auto &[name, values] : content.values)
        {
          const std::string number = std::to_string(contents["values"].size());
          const Rows        rows   = rows_of(values);
          const Part        part   = own_part(rows.keys.size(), communicator);
          writer.write("keys " + number, rows.keys, part, 1);
          writer.write("numbers " + number, rows.numbers, part, rows.width);
          contents["values"].push_back(
            {{"name", name},
             {"width", rows.width},
             {"rows", part.all},
             {"checksum", rows.checksum(communicator)}});
        }
      for (const auto &[name, document] : content.documents)
        {
          const Bytes bytes = bytes_of(document);
          writer.write("document " +
                         std::to_string(contents["documents"].size()),
                       bytes);
          contents["documents"].push_back(
            {{"name", name}, {"checksum", checksum(bytes)}});
        }
      const Bytes bytes = bytes_of(contents);
      writer.write("contents", bytes);
      writer.write("checksum",
                   Words{checksum(bytes)},
                   own_part(first ? 1 : 0, communicator),
                   1);
      writer.flush();
    });
    // only documents that can be read again are written
    if (problem.empty())
      problem = damage_of_state(unfinished, communicator);
    if (problem.empty())
      problem = problem_of(communicator, [&] {
        if (first)
          put_in_place(unfinished, file);
      });
    if (problem.empty())
      return;
    if (first)
      std::filesystem::remove(unfinished, ignored);
    throw UserError("\"" + file + "\" could not be written: " + problem + ".");
  }


  nlohmann::json
  read_state_header(const std::string &file, const MPI_Comm communicator)
  {
    nlohmann::json    header;
    const std::string problem = problem_of(communicator, [&] {
      header = contents_of(Reader(file)).at("header");
    });
    if (!problem.empty())
      throw UserError("\"" + file + "\" cannot be read: " + problem + ".");
    return header;
  }


  std::string
  damage_of_state(const std::string &file, const MPI_Comm communicator)
  {
    nlohmann::json contents;
    std::string    problem =
      problem_of(communicator, [&] { contents = contents_of(Reader(file)); });
    if (!problem.empty())
      return problem;
    for (unsigned int i = 0; i < contents.at("values").size(); ++i)
      {
        const nlohmann::json &entry = contents["values"][i];
        Rows                  rows(0);
        problem = problem_of(communicator, [&] {
          rows =
            read_rows(Reader(file), std::to_string(i), entry, communicator);
        });
        if (!problem.empty())
          return problem;
        if (rows.checksum(communicator) != entry.at("checksum"))
          return not_whole;
      }
    return problem_of(communicator, [&] {
      const Reader reader(file);
      for (unsigned int i = 0; i < contents.at("documents").size(); ++i)
        if (checksum(reader.read("document " + std::to_string(i))) !=
            contents["documents"][i].at("checksum"))
          throw Problem{not_whole};
    });
  }


  void
  read_state(const std::string &file,
             StateContent      &content,
             const MPI_Comm     communicator)
  {
    const auto refuse_if = [&](const std::string &problem) {
      if (!problem.empty())
        throw UserError("\"" + file + "\" cannot be read: " + problem + ".");
    };
    refuse_if(damage_of_state(file, communicator));
    refuse_if(problem_of(communicator, [&] {
      const Reader         reader(file);
      const nlohmann::json contents = contents_of(reader);
      const auto           find     = [](const nlohmann::json &list,
                           const std::string    &name) {
        for (unsigned int i = 0; i < list.size(); ++i)
          if (list[i].at("name") == name)
            return i;
        throw Problem{"it holds no \"" + name +
                      "\"; restart with the same parameters"};
      };
      for (const auto &[name, values] : content.values)
        {
          const unsigned int    i     = find(contents.at("values"), name);
          const nlohmann::json &entry = contents["values"][i];
          if (entry.at("width") != values.width)
            throw Problem{"its \"" + name +
                          "\" has another size; restart with the same "
                          "parameters and version of the program"};
          distribute(read_rows(reader, std::to_string(i), entry, communicator),
                     values,
                     communicator);
        }
      for (auto &[name, document] : content.documents)
        {
          const unsigned int i = find(contents.at("documents"), name);
          document = value_of(reader.read("document " + std::to_string(i)),
                              contents["documents"][i].at("checksum"));
        }
    }));
  }
} // namespace Voussoir
