#include <voussoir/base/error.h>
#include <voussoir/files/hdf5_file.h>
#include <voussoir/files/keyed_rows.h>
#include <voussoir/files/state_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr int format =
      12; // since uplift is linear along interfaces between faces that lean


    Bytes
    bytes_of(const nlohmann::json &value)
    {
      return nlohmann::json::to_cbor(value);
    }


    nlohmann::json
    value_of(const Bytes &bytes, const std::uint64_t expected)
    {
      if (byte_checksum(bytes) != expected)
        throw FileProblem{hdf5_not_whole};
      return nlohmann::json::from_cbor(bytes);
    }


    /** The table of contents, with the header of the user. */
    nlohmann::json
    contents_of(const HDF5Reader &reader)
    {
      const auto sum = reader.read<std::uint64_t>("checksum", {0, 1, 1}, 1);
      const nlohmann::json contents =
        value_of(reader.read("contents"), sum.at(0));
      if (contents.at("format") != format)
        throw FileProblem{"another version of Voussoir wrote it"};
      return contents;
    }


    KeyedRows
    read_rows(const HDF5Reader     &reader,
              const std::string    &number,
              const nlohmann::json &entry,
              const MPI_Comm        communicator)
    {
      KeyedRows      rows(entry.at("width"));
      const RowRange part = even_rows(entry.at("rows"), communicator);
      rows.keys    = reader.read<std::uint64_t>("keys " + number, part, 1);
      rows.numbers = reader.read<double>("numbers " + number, part, rows.width);
      return rows;
    }


    /** Bytes of the rows of this rank. */
    double
    size_of_rows(const StateContent &content)
    {
      double bytes = 0.;
      for (const auto &[name, values] : content.values)
        bytes += n_kept_rows(values) * 8. * (values.width + 1.);
      return bytes;
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
        throw FileProblem{std::strerror(errno)};
      // the new name, too, where the file system can synchronise folders
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
    std::error_code   ignored; // an error shows when the file is written
    if (first)
      std::filesystem::create_directory(
        std::filesystem::path(file).parent_path(), ignored);
    MPI_Barrier(communicator);

    std::string problem = problem_of(communicator, [&] {
      nlohmann::json contents{{"format", format},
                              {"header", header},
                              {"values", nlohmann::json::array()},
                              {"documents", nlohmann::json::array()}};
      HDF5Writer     writer(unfinished, communicator, size_of_rows(content));
      for (const auto &[name, values] : content.values)
        {
          const std::string number = std::to_string(contents["values"].size());
          const KeyedRows   rows(values);
          const RowRange    part = own_rows(rows.keys.size(), communicator);
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
            {{"name", name}, {"checksum", byte_checksum(bytes)}});
        }
      const Bytes bytes = bytes_of(contents);
      writer.write("contents", bytes);
      writer.write("checksum",
                   std::vector<std::uint64_t>{byte_checksum(bytes)},
                   own_rows(first ? 1 : 0, communicator),
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
      header = contents_of(HDF5Reader(file)).at("header");
    });
    if (!problem.empty())
      throw UserError("\"" + file + "\" cannot be read: " + problem + ".");
    return header;
  }


  std::string
  damage_of_state(const std::string &file, const MPI_Comm communicator)
  {
    nlohmann::json contents;
    std::string    problem = problem_of(communicator, [&] {
      contents = contents_of(HDF5Reader(file));
    });
    if (!problem.empty())
      return problem;
    for (unsigned int i = 0; i < contents.at("values").size(); ++i)
      {
        const nlohmann::json &entry = contents["values"][i];
        KeyedRows             rows(0);
        problem = problem_of(communicator, [&] {
          rows =
            read_rows(HDF5Reader(file), std::to_string(i), entry, communicator);
        });
        if (!problem.empty())
          return problem;
        if (rows.checksum(communicator) != entry.at("checksum"))
          return hdf5_not_whole;
      }
    return problem_of(communicator, [&] {
      const HDF5Reader reader(file);
      for (unsigned int i = 0; i < contents.at("documents").size(); ++i)
        if (byte_checksum(reader.read("document " + std::to_string(i))) !=
            contents["documents"][i].at("checksum"))
          throw FileProblem{hdf5_not_whole};
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
      const HDF5Reader     reader(file);
      const nlohmann::json contents = contents_of(reader);
      const auto           find     = [](const nlohmann::json &list,
                           const std::string    &name) {
        for (unsigned int i = 0; i < list.size(); ++i)
          if (list[i].at("name") == name)
            return i;
        throw FileProblem{"it holds no \"" + name +
                          "\"; restart with the same parameters"};
      };
      for (const auto &[name, values] : content.values)
        {
          const unsigned int    i     = find(contents.at("values"), name);
          const nlohmann::json &entry = contents["values"][i];
          if (entry.at("width") != values.width)
            throw FileProblem{"its \"" + name +
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
