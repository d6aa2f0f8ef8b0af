#include <voussoir/base/usual_range.h>

#include <deal.II/base/utilities.h>

#include <regex>
#include <set>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /**
     * The list of numbers that may be mistyped: a line for each number that a
     * class declares, with the values that are allowed or usual. A value far
     * beyond is refused or warned of. An entry that has neither range is WRONG
     * unless the test names it as one that can have any value.
     */
    class EntryRanges : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Any value",
                          any_value,
                          "Entries that need no range, \"Section/class/Entry\" "
                          "separated by |; * stands for every class.");
      }

      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const auto list = split_list(any_value, '|');
        excepted        = std::set<std::string>(list.begin(), list.end());
        std::ostringstream text;
        all.prm.print_parameters(text, ParameterHandler::JSON);
        const auto sections = nlohmann::json::parse(text.str());
        check_classes<InterfaceLaw>(sections, "Interfaces", verdicts);
        check_classes<Material>(sections, "Materials", verdicts);
        check_classes<Load>(sections, "Loads", verdicts);
        check_classes<Projection>(sections, "Constraints", verdicts);
        check_classes<Observer>(sections, "Output", verdicts);
        for (const std::string &entry : excepted)
          if (met.count(entry) == 0)
            verdicts.is_true(entry + ": there is such an entry without range",
                             false);
      }

    private:
      template <typename Base>
      void
      check_classes(const nlohmann::json &sections,
                    const std::string    &section,
                    Verdicts             &verdicts)
      {
        for (const std::string &name : Registry<Base>::names())
          check_section(sections.at(section).at(name),
                        {section, name},
                        verdicts);
      }

      void
      check_section(const nlohmann::json           &node,
                    const std::vector<std::string> &path,
                    Verdicts                       &verdicts)
      {
        for (const auto &[name, child] : node.items())
          if (child.contains("value") && child["value"].is_string())
            check_entry(child, path, name, verdicts);
          else if (child.is_object())
            {
              auto longer = path;
              longer.push_back(name);
              check_section(child, longer, verdicts);
            }
      }

      void
      check_entry(const nlohmann::json           &entry,
                  const std::vector<std::string> &path,
                  const std::string              &name,
                  Verdicts                       &verdicts)
      {
        static const std::regex number(
          R"re(.*\[(?:Double|Integer)(?: range)?(?: (\S*?)\.\.\.(\S+))?.*)re");
        static const std::regex usual(R"re([^]* Usually (.* to (\S+))\.)re");
        static const std::set<std::string> unbounded{
          "", "-MAX_DOUBLE", "MAX_DOUBLE", "-2147483648", "2147483647"};
        const std::string pattern     = entry["pattern_description"],
                          description = entry["documentation"];
        std::smatch parts;
        if (!std::regex_match(pattern, parts, number))
          return;
        auto names = path;
        names.push_back(name);
        const std::string place = join(names, "/");
        names[1]                = "*";
        const std::string alike = join(names, "/");
        std::smatch       last;
        if (std::regex_match(description, last, usual))
          verdicts.is_true(place + ": usually " + last[1].str(),
                           is_said(entry["value"],
                                   path,
                                   name,
                                   1e3 * Utilities::string_to_double(last[2])));
        else if (unbounded.count(parts[1]) + unbounded.count(parts[2]) == 0)
          verdicts.is_true(place + ": from " + parts[1].str() + " to " +
                             parts[2].str(),
                           true);
        else if (excepted.count(place) + excepted.count(alike) > 0)
          {
            met.insert(excepted.count(place) > 0 ? place : alike);
            verdicts.is_true(place + ": any value", true);
          }
        else
          verdicts.is_true(place + ": has neither range nor usual range",
                           false);
      }

      /** Whether the program warns of this value of an entry, or refuses it.
       */
      bool
      is_said(const std::string              &by_default,
              const std::vector<std::string> &path,
              const std::string              &name,
              const double                    value)
      {
        const std::size_t n = std::max<std::size_t>(
          1, Utilities::split_string_list(by_default).size());
        const std::string text =
          join(std::vector<std::string>(n, Utilities::to_string(value)), ", ");
        for (const std::string &section : path)
          all.prm.enter_subsection(section);
        bool said = false;
        try
          {
            all.prm.set(name, text);
            for (const std::string &warning : unusual_values(all.prm))
              said = said || warning.rfind("\"" + name + "\" in section \"" +
                                             join(path, "/") + "\"",
                                           0) == 0;
            all.prm.set(name, by_default);
          }
        catch (const ExceptionBase &)
          {
            said = true; // beyond what is allowed
          }
        for (std::size_t i = 0; i < path.size(); ++i)
          all.prm.leave_subsection();
        return said;
      }

      Case                  all;
      std::string           any_value;
      std::set<std::string> excepted, met;
    };

    // Reference: Voussoir
    const Registry<Check>::Add<EntryRanges>
      registered("entry ranges",
                 "Every number of a class has a range, allowed or usual.");
  } // namespace
} // namespace Voussoir
