#include <voussoir/base/error.h>

#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Entries and sections that become unused by --set, or by a file that
     *  includes another, are left out with a note; mistakes are refused as
     *  before. */
    class UnusedByChange : public Check
    {
    public:
      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm) override
      {
        const std::string law = "Interfaces/plane/Law=friction",
                          note =
                            "entry \"Tensile strength\" in section "
                            "\"Interfaces/plane\" is not used, as \"Law\" in "
                            "section \"Interfaces/plane\" is now \"friction\"";
        verdicts.is_true("as it is: no note", make_case(file)->notes.empty());
        verdicts.same_text("entry of the law before",
                           only_note(file.with({law})),
                           note);
        verdicts.same_text(
          "section that \"Names\" had",
          only_note(file.with({"Interfaces/Names="})),
          "section \"Interfaces/plane\" is not used, as \"Names\" in section "
          "\"Interfaces\" is now \"\"");
        verdicts.is_true("the same entry by --set: refused",
                         is_refused(file.with(
                           {law, "Interfaces/plane/Tensile strength=1"})));
        verdicts.is_true("a section that it never had: refused",
                         is_refused(file.with({"Interfaces/Names=",
                                               "Interfaces/other/Law="
                                               "friction"})));

        verdicts.is_true("an unknown entry in a later set of changes: refused",
                         is_refused(file.with({law}).with(
                           {"Interfaces/plane/Tensile strenght=1"})));

        std::ofstream("unused_including.prm")
          << "include " << file.resolve("unused_by_change.prm")
          << "\nsubsection Interfaces\n  subsection plane\n"
             "    set Law = friction\n  end\nend\n";
        verdicts.same_text("in a file that is included",
                           only_note(ParameterFile("unused_including.prm")),
                           note);

        std::ofstream("misspelt_below.prm")
          << "include " << file.resolve("unused_by_change.prm")
          << "\nsubsection Interfaces\n  set Names = plane, other\n"
             "  subsection plane\n    set Lawe = friction\n  end\nend\n";
        std::ofstream("misspelt_above.prm")
          << "include misspelt_below.prm\nsubsection Interfaces\n"
             "  set Names = plane\nend\n";
        verdicts.is_true(
          "an unknown entry of a section that \"Names\" keeps: refused",
          is_refused(ParameterFile("misspelt_above.prm")));

        for (const std::string name : {"crest", "heel"})
          std::ofstream(name + "_criterion.prm")
            << "subsection Acceptance\n  set Names = " << name
            << "\n  subsection " << name
            << "\n    set Quantity = x\n    set At most = 1\n"
               "    set Source = user's\n  end\nend\n";
        std::ofstream("two_lists.prm")
          << "include " << file.resolve("unused_by_change.prm")
          << "\ninclude crest_criterion.prm\ninclude heel_criterion.prm\n";
        verdicts.is_true("lists of two files that are included: one",
                         make_case(ParameterFile("two_lists.prm"))
                             ->acceptance.of_the_run()
                             .size() == 2);

        const std::string friction = "Materials/rock/Crack friction=0.5";
        verdicts.same_text(
          "friction of cracks that turn",
          only_note(file.with({"Materials/rock/Class=rock damage", friction})),
          "\"Crack friction\" in section \"Materials/rock\" is not used, as "
          "\"Crack direction\" there is \"rotating\"");
        verdicts.is_true("of fixed ones: no note",
                         make_case(
                           file.with({"Materials/rock/Class=rock damage",
                                      "Materials/rock/Crack direction=fixed",
                                      friction}))
                           ->notes.empty());

        const std::string vertical = "Ground motion/Spectrum/Vertical/",
                          period   = vertical + "Characteristic period=0.15";
        verdicts.same_text(
          "vertical spectrum that is the horizontal one",
          only_note(file.with({period})),
          "\"Characteristic period\" in section \"Ground "
          "motion/Spectrum/Vertical\" is not used, as \"Shape\" there is \"as "
          "horizontal\"");
        verdicts.is_true(
          "of its own: no note",
          make_case(file.with({vertical + "Shape=hydropower code", period}))
            ->notes.empty());

        const std::string azimuth = "Wave field/Azimuth=30";
        verdicts.same_text("azimuth of a vertical wave",
                           only_note(file.with({azimuth})),
                           "\"Azimuth\" in section \"Wave field\" is not used, "
                           "as \"Type\" there is \"vertical\"");
        verdicts.is_true("of an oblique wave: no note",
                         make_case(
                           file.with({"Wave field/Type=oblique SH", azimuth}))
                           ->notes.empty());
        verdicts.same_text(
          "place of a motion that moves a rigid base",
          only_note(file.with({"Wave field/Enters through=rigid base",
                               "Ground motion/Given at=outcrop"})),
          "\"Given at\" in section \"Ground motion\" is not used, as \"Enters "
          "through\" in section \"Wave field\" is \"rigid base\", which moves "
          "as given");
      }

    private:
      static std::string
      only_note(const ParameterFile &file)
      {
        const auto  parameters = make_case(file);
        const auto &notes      = parameters->notes;
        return notes.size() == 1 ? notes[0] :
                                   std::to_string(notes.size()) + " notes";
      }

      static bool
      is_refused(const ParameterFile &file)
      {
        try
          {
            make_case(file);
          }
        catch (const UserError &)
          {
            return true;
          }
        return false;
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<UnusedByChange>
      registered("unused by change",
                 "Entries that a change leaves without use.");
  } // namespace
} // namespace Voussoir
