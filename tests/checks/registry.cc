#include "check.h"

namespace Voussoir
{
  namespace
  {
    struct Shape
    {};

    /** A name belongs to one class. */
    class RegistryCheck : public Check
    {
    public:
      void
      run(const ParameterFile &, Verdicts &verdicts, const MPI_Comm) override
      {
        const auto create = [] { return std::make_unique<Shape>(); };
        Registry<Shape>::add("arch", {"Curved.", create});
        Registry<Shape>::add("slab", {"Flat.", create});
        verdicts.is_true("two names", Registry<Shape>::names().size() == 2);

        std::string sentence;
        try
          {
            Registry<Shape>::add("arch", {"Pointed.", create});
          }
        catch (const UserError &error)
          {
            sentence = error.what();
          }
        verdicts.is_true("a name twice is refused, both classes are named",
                         sentence.find("\"arch\"") != std::string::npos &&
                           sentence.find("\"Curved.\"") != std::string::npos &&
                           sentence.find("\"Pointed.\"") != std::string::npos);
        verdicts.is_true("the first class keeps the name",
                         Registry<Shape>::entries()["arch"].description ==
                           "Curved.");
      }
    };

    // Reference: Voussoir
    const Registry<Check>::Add<RegistryCheck>
      registered("registry", "Registration of classes by name.");
  } // namespace
} // namespace Voussoir
