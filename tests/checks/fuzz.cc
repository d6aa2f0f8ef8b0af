#include <voussoir/fem/point_weights.h>
#include <voussoir/materials/softening_curve.h>
#include <voussoir/mesh_sources/reader.h>
#include <voussoir/signals/record.h>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double longest_time = 5.; // for one input [s]

    /** A format: its samples, and the function that reads it. */
    struct FuzzedFormat
    {
      std::vector<std::string>                 folders, endings;
      std::function<void(const std::string &)> read;
    };


    void
    read_any_mesh(const std::string &filename)
    {
      std::ostringstream report;
      read_mesh(filename, &report);
    }


    void
    read_table(const std::string &filename)
    {
      std::ifstream in(filename);
      for (std::string line; std::getline(in, line);)
        for (const auto &parse : std::vector<std::function<void()>>{
               [&] { SofteningCurve::parse(line, "table"); },
               [&] { parse_points(line, "points"); }})
          try
            {
              parse();
            }
          catch (const UserError &)
            {}
    }


    const std::map<std::string, FuzzedFormat> &
    formats()
    {
      const std::string meshes = "../data/meshes";
      static const std::map<std::string, FuzzedFormat> all{
        {"prm",
         {{"../../prm", "../refusal"},
          {".prm"},
          [](const std::string &filename) { Case{ParameterFile(filename)}; }}},
        {"AT2",
         {{"corpus", "../data/records"},
          {".AT2"},
          [](const std::string &filename) { read_record(filename, {}); }}},
        {"columns",
         {{"corpus", "../data/records"},
          {".txt"},
          [](const std::string &filename) { read_record(filename, {}); }}},
        {"table", {{"corpus"}, {".table"}, read_table}},
        {"gmsh", {{meshes}, {".msh"}, read_any_mesh}},
        {"inp", {{meshes}, {".inp"}, read_any_mesh}}, // Abaqus and UCD
        {"ucd", {{meshes}, {".ucd"}, read_any_mesh}},
        {"vtk", {{meshes}, {".vtk"}, read_any_mesh}}};
      return all;
    }


    struct Sample
    {
      std::string text, ending;
    };


    std::vector<Sample>
    load_samples(const FuzzedFormat &format, const ParameterFile &file)
    {
      std::set<std::filesystem::path> paths; // in alphabetical order
      for (const std::string &folder : format.folders)
        for (const auto &item : std::filesystem::recursive_directory_iterator(
               file.resolve(folder)))
          if (std::find(format.endings.begin(),
                        format.endings.end(),
                        item.path().extension()) != format.endings.end())
            paths.insert(item.path());
      std::vector<Sample> samples;
      for (const auto &path : paths)
        {
          std::ifstream in(path, std::ios::binary);
          samples.push_back({{std::istreambuf_iterator<char>(in), {}},
                             path.extension().string()});
        }
      return samples;
    }


    /** A sample with some damage, which the number determines. */
    class Damager
    {
    public:
      Damager(const std::vector<Sample> &samples, const unsigned int number)
        : samples(samples)
        , random(number)
      {}

      Sample
      run()
      {
        Sample             result  = pick(samples);
        const unsigned int n_times = 1 + below(3);
        for (unsigned int i = 0; i < n_times; ++i)
          damage(result.text);
        return result;
      }

    private:
      std::size_t
      below(const std::size_t n)
      {
        return n == 0 ? 0 : random() % n;
      }

      template <typename Item>
      const Item &
      pick(const std::vector<Item> &items)
      {
        return items[below(items.size())];
      }

      void
      damage(std::string &text)
      {
        static const std::vector<std::string> words{"0",
                                                    "-1",
                                                    "1",
                                                    "3",
                                                    "nan",
                                                    "-inf",
                                                    "1e308",
                                                    "-1e308",
                                                    "1e-320",
                                                    "1e400",
                                                    "0.5",
                                                    "255",
                                                    "65536",
                                                    "2147483647",
                                                    "-2147483648",
                                                    "4294967296",
                                                    "1000000000",
                                                    "9223372036854775807",
                                                    "99999999999999999999999",
                                                    "+",
                                                    "=",
                                                    "",
                                                    ",",
                                                    ";",
                                                    ":",
                                                    "#",
                                                    "\\",
                                                    "\"",
                                                    "*",
                                                    "$",
                                                    "end",
                                                    "subsection",
                                                    "\xC2\xA0",
                                                    "\xFF",
                                                    std::string(1, '\0'),
                                                    "\r",
                                                    std::string(300, 'n'),
                                                    std::string(5000, '9'),
                                                    std::string(20000, ' ')};
        const std::size_t                     at = below(text.size() + 1);
        switch (below(12))
          {
            case 0: // a byte
              if (at < text.size())
                text[at] = static_cast<char>(random());
              break;
            case 1: // the end is missing
              text.resize(at);
              break;
            case 2: // a piece is missing
              text.erase(at, below(64));
              break;
            case 3: // a piece is repeated
              text.insert(at, text.substr(below(text.size() + 1), below(256)));
              break;
            case 4: // a piece of another sample
              {
                const std::string &other = pick(samples).text;
                text.insert(at,
                            other.substr(below(other.size() + 1), below(512)));
                break;
              }
            case 5: // a line is missing or repeated
              {
                const auto begin = text.rfind('\n', at) + 1;
                const auto end   = std::min(text.find('\n', at), text.size());
                const std::string line = text.substr(begin, end - begin + 1);
                if (below(2) == 0)
                  text.insert(begin, line);
                else
                  text.erase(begin, line.size());
                break;
              }
            case 6: // a binary number
              {
                static const std::vector<std::uint64_t> numbers{
                  0,
                  1,
                  5,
                  0x7FFFFFFF,
                  0xFFFFFFFF,
                  0x80000000,
                  0x7FFFFFFFFFFFFFFF,
                  0xFFFFFFFFFFFFFFFF,
                  0x7FF0000000000000,
                  0x7FE0000000000000};
                std::uint64_t value = pick(numbers);
                if (below(2) == 0)
                  value = __builtin_bswap64(value);
                for (unsigned int i = 0; i < 4 + 4 * below(2); ++i)
                  if (at + i < text.size())
                    text[at + i] = static_cast<char>(value >> (8 * i));
                break;
              }
            case 7: // a digit
            case 8:
              if (const auto digit = text.find_first_of("0123456789", at);
                  digit != std::string::npos)
                text[digit] = static_cast<char>('0' + below(10));
              break;
            default: // a word
              {
                const std::string white_space = " \t\n,;:=";
                const auto begin = text.find_first_not_of(white_space, at);
                if (begin == std::string::npos)
                  break;
                const auto end =
                  std::min(text.find_first_of(white_space, begin), text.size());
                text.replace(begin, end - begin, pick(words));
              }
          }
      }

      const std::vector<Sample> &samples;
      std::mt19937_64            random;
    };


    /**
     * Damaged files are read, or refused by a sentence, within seconds: none
     * ends the program, makes it hang or throws anything else. A child process
     * reads them one by one; if it ends early, another process continues, and
     * the input is kept.
     */
    class Fuzz : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Format", name, "Format of the files.");
        prm.add_parameter("First input", first, "Number of the first file.");
        prm.add_parameter("Inputs", n_inputs, "How many files to read.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const FuzzedFormat       &format  = formats().at(name);
        const std::vector<Sample> samples = load_samples(format, file);
        verdicts.is_true("there are samples", !samples.empty());
        progress            = static_cast<Progress *>(mmap(nullptr,
                                                sizeof(Progress),
                                                PROT_READ | PROT_WRITE,
                                                MAP_SHARED | MAP_ANONYMOUS,
                                                -1,
                                                0));
        progress->number    = first;
        unsigned int n_lost = 0;
        while (progress->number < first + n_inputs)
          if (const std::string end = read_in_child(format, samples);
              !end.empty())
            {
              keep_input(samples, end);
              ++n_lost;
              ++progress->number;
            }
        std::ofstream("figures.txt")
          << name << ": " << n_inputs << " inputs, " << progress->n_refused
          << " refused, " << n_lost << " lost, the slowest took "
          << progress->slowest << " s" << std::endl;
        verdicts.is_true(std::to_string(n_inputs) + " damaged files are read "
                                                    "or refused by a sentence",
                         n_lost == 0);
      }

    private:
      /** Shared with the child process. */
      struct Progress
      {
        std::atomic<unsigned int> number, n_refused;
        std::atomic<double>       slowest;
        char                      error[200];
      };

      // Why the child process ended before the last input; empty if it did not.
      std::string
      read_in_child(const FuzzedFormat        &format,
                    const std::vector<Sample> &samples)
      {
        progress->error[0] = '\0';
        const pid_t child  = fork();
        if (child == 0)
          read_all(format, samples);
        unsigned int number = progress->number;
        auto         since  = std::chrono::steady_clock::now();
        while (true)
          {
            int status = 0;
            if (waitpid(child, &status, WNOHANG) == child)
              return WIFSIGNALED(status) ?
                       "signal " + std::to_string(WTERMSIG(status)) :
                       progress->error;
            const auto now = std::chrono::steady_clock::now();
            if (number != progress->number)
              {
                number = progress->number;
                since  = now;
              }
            else if (std::chrono::duration<double>(now - since).count() >
                     longest_time)
              {
                kill(child, SIGKILL);
                waitpid(child, &status, 0);
                return "no end";
              }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
      }


      // In the child process, which ends here.
      [[noreturn]] void
      read_all(const FuzzedFormat &format, const std::vector<Sample> &samples)
      {
        const rlimit memory{std::size_t(1) << 32, std::size_t(1) << 32};
        setrlimit(RLIMIT_AS, &memory);
        for (; progress->number < first + n_inputs; ++progress->number)
          {
            const auto        start  = std::chrono::steady_clock::now();
            const Sample      sample = Damager(samples, progress->number).run();
            const std::string filename = "input" + sample.ending;
            std::ofstream(filename, std::ios::binary) << sample.text;
            try
              {
                format.read(filename);
              }
            catch (const UserError &)
              {
                ++progress->n_refused;
              }
            catch (const std::exception &error)
              {
                std::strncpy(progress->error,
                             error.what(),
                             sizeof(progress->error) - 1);
                if (progress->error[0] == '\0')
                  std::strcpy(progress->error, "an exception");
                _exit(1);
              }
            progress->slowest =
              std::max(progress->slowest.load(),
                       std::chrono::duration<double>(
                         std::chrono::steady_clock::now() - start)
                         .count());
          }
        _exit(0);
      }


      void
      keep_input(const std::vector<Sample> &samples, const std::string &end)
      {
        const Sample      sample = Damager(samples, progress->number).run();
        const std::string filename =
          name + "_" + std::to_string(progress->number) + sample.ending;
        std::ofstream(filename, std::ios::binary) << sample.text;
        std::clog << filename << ": " << end << std::endl;
      }

      std::string  name;
      unsigned int first = 0, n_inputs = 1000;
      Progress    *progress = nullptr;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<Fuzz> registered("fuzz",
                                                "Damaged files of one format.");
  } // namespace
} // namespace Voussoir
