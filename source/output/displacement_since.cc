#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/contact.h>
#include <voussoir/output/displacement_since.h>

namespace Voussoir
{
  using namespace dealii;

  const Vector *
  origin_of(const std::string &quantity, const InitialState &initial)
  {
    const Vector *origin =
      quantity == since_static_state ? &initial.displacement :
      quantity == since_grouting     ? &initial.grouted_displacement :
                                       nullptr;
    return origin != nullptr && origin->size() > 0 ? origin : nullptr;
  }


  namespace
  {
    /** Whether interfaces wait for their grout before the static state. */
    bool
    is_grouted_later(const ObservedModel &model)
    {
      bool result = false;
      if (model.interfaces != nullptr)
        for (const ContactPoint &point : model.interfaces->points())
          result = result || !point.joined;
      return Utilities::MPI::logical_or(result,
                                        model.solid.grid().communicator());
    }
  } // namespace


  void
  check_grouting(const std::string   &quantities,
                 const std::string   &section,
                 const ObservedModel &model)
  {
    const auto list = split_list(quantities);
    if (std::find(list.begin(), list.end(), since_grouting) != list.end() &&
        !is_grouted_later(model))
      throw UserError("\"Quantities\" in section \"" + section + "\" has \"" +
                      since_grouting +
                      "\", but no interface is grouted; give one \"Grouted "
                      "after\" in section \"Interfaces\", or take \"" +
                      since_static_state + "\".");
  }
} // namespace Voussoir
