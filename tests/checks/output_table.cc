#include <voussoir/files/table.h>

#include "check.h"

namespace Voussoir
{
  namespace
  {
    /** Lines of comma-separated values: infinite numbers are empty cells. */
    class InfiniteNumbers : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const double none = std::numeric_limits<double>::infinity();
        const auto   line = [&](const std::vector<double> &values,
                              const std::string         &expected) {
          verdicts.is_true('"' + expected + '"', csv_line(values) == expected);
        };
        line({1., none, 0.5}, "1,,0.5");
        line({none, 1., -none}, ",1,");
        line({0.25, none, none}, "0.25,,");
        line({none}, "");
        line({1e300, 0., -1e-300}, "1e+300,0,-1e-300");
        line({1. / 3., 123456789.4, 1234567894.},
             "0.333333333,123456789,1.23456789e+09");
        verdicts.is_true("NaN is written as such",
                         csv_line({std::nan("")}).find("nan") !=
                           std::string::npos);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<InfiniteNumbers>
      registered("infinite numbers", "In tables of comma-separated values.");


    /** A text in a table is one cell, and no spreadsheet takes it for a
     *  formula. */
    class Headings : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const auto line = [&](const std::vector<std::string> &texts,
                              const std::string              &expected) {
          verdicts.is_true(expected, csv_heading(texts) == expected);
        };
        line({"crest, left", "a \"b\"", "c"},
             "\"crest, left\",\"a \"\"b\"\"\",c");
        line({"=1+1 [m]", "@SUM(A1) [m]", "+a", "-b"},
             "'=1+1 [m],'@SUM(A1) [m],'+a,'-b");
        line({"=A1,B1", "a=b", "a@b"}, "\"'=A1,B1\",a=b,a@b");
        line({"-0.5", "+2", "-1e9", "1"}, "-0.5,+2,-1e9,1");
        verdicts.is_true("a tab and a carriage return in front",
                         csv_heading({"\ta", "\rb"}) == "'\ta,\"'\rb\"");
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<Headings>
      headings("headings", "Texts in tables of comma-separated values.");
  } // namespace
} // namespace Voussoir
