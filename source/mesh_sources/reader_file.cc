#include <voussoir/base/error.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh_sources/reader_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace Voussoir
{
  namespace
  {
    constexpr std::string_view white_space = " \t\r\n\v\f";
  }


  MeshFile::MeshFile(const std::string &filename)
    : name(filename)
  {
    // opening a pipe would block
    std::error_code error;
    std::ifstream   in;
    if (std::filesystem::is_regular_file(filename, error))
      in.open(filename, std::ios::binary);
    if (in.is_open())
      content.assign(std::istreambuf_iterator<char>(in), {});
    if (!in || content.empty())
      throw UserError("The mesh file \"" + filename +
                      "\" does not exist, cannot be read or is empty; give in "
                      "\"File\" the path of a mesh file, relative to the "
                      "folder of the parameter file.");
  }


  bool
  MeshFile::at_end()
  {
    position = std::min(content.find_first_not_of(white_space, position),
                        content.size());
    return position == content.size();
  }


  std::string_view
  MeshFile::word(const std::string &expected)
  {
    at_end();
    start_piece(expected);
    position =
      std::min(content.find_first_of(white_space, piece), content.size());
    return std::string_view(content).substr(piece, position - piece);
  }


  std::string_view
  MeshFile::peek_line() const
  {
    const std::size_t end =
      std::min(content.find('\n', position), content.size());
    return trimmed(std::string_view(content).substr(position, end - position));
  }


  std::string_view
  MeshFile::line(const std::string &expected)
  {
    start_piece(expected);
    const std::string_view text = peek_line();
    skip_line();
    return text;
  }


  void
  MeshFile::skip_line()
  {
    const std::size_t end = content.find('\n', position);
    position = (end == std::string::npos ? content.size() : end + 1);
  }


  bool
  MeshFile::go_to(const std::string &text)
  {
    const std::size_t found = content.find(text, position);
    if (found == std::string::npos)
      return false;
    position = piece = found;
    return true;
  }


  void
  MeshFile::expect(const std::string &expected)
  {
    const std::string_view found = word(expected);
    if (found != expected)
      fail("expected " + expected + ", but found " + in_quotes(found) +
           "; the file is damaged or of another format.");
  }


  std::string_view
  MeshFile::bytes(const std::size_t n, const std::string &expected)
  {
    start_piece(expected);
    if (n > content.size() - position)
      fail("the file ends within " + expected +
           "; export it again, it is incomplete.");
    position += n;
    return std::string_view(content).substr(piece, n);
  }


  std::size_t
  MeshFile::count(const std::string &expected)
  {
    return check_count(number<std::int64_t>(expected), expected);
  }


  std::size_t
  MeshFile::check_count(const std::int64_t n, const std::string &expected) const
  {
    if (n < 0 || n > static_cast<std::int64_t>(content.size()))
      fail("expected " + expected + ", but found " + std::to_string(n) +
           (n < 0 ? "" : ", more than the file can hold") +
           "; the file is damaged.");
    return n;
  }


  double
  MeshFile::coordinate()
  {
    return check_coordinate(number<double>("a coordinate"));
  }


  double
  MeshFile::check_coordinate(const double x) const
  {
    if (!(std::abs(x) <= largest_coordinate))
      {
        std::ostringstream text;
        text << "a coordinate is " << x
             << ", which is no place in a mesh; correct it.";
        fail(text.str());
      }
    return x;
  }


  void
  MeshFile::fail(const std::string &message) const
  {
    const auto line_number =
      1 + std::count(content.begin(), content.begin() + piece, '\n');
    throw UserError(name + ", line " + std::to_string(line_number) + ": " +
                    message);
  }


  void
  MeshFile::start_piece(const std::string &expected)
  {
    piece = position;
    if (position == content.size())
      fail("the file ends where " + expected +
           " should come; export it again, it is incomplete.");
  }


  std::string
  in_quotes(const std::string_view text)
  {
    constexpr std::size_t longest = 40;
    std::string           result(text.substr(0, longest));
    std::replace_if(
      result.begin(),
      result.end(),
      [](const unsigned char c) { return c < ' ' || c > '~'; },
      '?');
    return '"' + result + (text.size() > longest ? "..." : "") + '"';
  }


  std::string_view
  trimmed(std::string_view text)
  {
    const std::size_t begin = text.find_first_not_of(white_space);
    if (begin == std::string_view::npos)
      return {};
    return text.substr(begin, text.find_last_not_of(white_space) - begin + 1);
  }


  std::string_view
  take_word(std::string_view &text)
  {
    text = trimmed(text);
    const std::string_view word =
      text.substr(0, text.find_first_of(white_space));
    text.remove_prefix(word.size());
    return word;
  }
} // namespace Voussoir
