#ifndef voussoir_mesh_sources_reader_file_h
#define voussoir_mesh_sources_reader_file_h

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace Voussoir
{
  /**
   * The text of a mesh file, read from its beginning to its end by words or by
   * lines. Errors name the file and the line.
   */
  class MeshFile
  {
  public:
    /** Throws UserError if the file cannot be read. */
    explicit MeshFile(const std::string &filename);

    /** Whether only white space is left. */
    bool
    at_end();

    /** The next word, however many line ends come before it. */
    std::string_view
    word(const std::string &expected);

    /** The rest of the current line, without blanks at its ends. */
    std::string_view
    line(const std::string &expected);

    /** Go on to the next line. */
    void
    skip_line();

    /** Moves to the next @p text; false, and unmoved, if there is none. */
    bool
    go_to(const std::string &text);

    /** Take the next word; fail if it is not @p expected. */
    void
    expect(const std::string &expected);

    /** The next line without taking it, empty at the end of the file. */
    std::string_view
    peek_line() const;

    /** The next @p n bytes as they are. */
    std::string_view
    bytes(const std::size_t n, const std::string &expected);

    /** The next word as a number; @p expected names it in an error. */
    template <typename Number>
    Number
    number(const std::string &expected)
    {
      return to_number<Number>(word(expected), expected);
    }

    /** The next word as the number of items that follow in the file. */
    std::size_t
    count(const std::string &expected);

    /** Returns @p n, the number of items that follow; fails if the file cannot
     *  hold as many. */
    std::size_t
    check_count(const std::int64_t n, const std::string &expected) const;

    /** The next word as a coordinate. */
    double
    coordinate();

    /** Returns @p x; fails if no mesh has such a coordinate. */
    double
    check_coordinate(const double x) const;

    /** The @p text as a number; @p expected names it in an error. */
    template <typename Number>
    Number
    to_number(std::string_view text, const std::string &expected) const;

    /** Throw UserError "FILE, line N: message", N being the line of the piece
     *  taken last. */
    [[noreturn]] void
    fail(const std::string &message) const;

    const std::string name;

  private:
    void
    start_piece(const std::string &expected);

    std::string content;
    std::size_t position = 0;
    std::size_t piece    = 0; // where the piece taken last begins
  };


  /** The printable part of a piece of a file, in quotation marks. */
  std::string
  in_quotes(const std::string_view text);


  /** The text without blanks, tabs and carriage returns at both ends. */
  std::string_view
  trimmed(std::string_view text);

  /**
   * Take the first word off @p text and return it; words are divided by white
   * space. Empty if there is none.
   */
  std::string_view
  take_word(std::string_view &text);


  template <typename Number>
  Number
  MeshFile::to_number(std::string_view text, const std::string &expected) const
  {
    const std::string_view written = text;
    if (!text.empty() && text.front() == '+')
      text.remove_prefix(1);

    // Fortran programs write 1.5D+02.
    std::string fortran;
    if (std::is_floating_point<Number>::value)
      {
        const std::size_t exponent = text.find_first_of("dD");
        if (exponent != std::string_view::npos)
          {
            fortran           = text;
            fortran[exponent] = 'e';
            text              = fortran;
          }
      }

    Number     value{};
    const auto result =
      std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
      fail("expected " + expected + ", but found " +
           (written.empty() ? "the end of the line" : in_quotes(written)) +
           "; the file is damaged or of another format.");
    return value;
  }
} // namespace Voussoir

#endif
