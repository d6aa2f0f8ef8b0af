#ifndef voussoir_base_option_h
#define voussoir_base_option_h

#include <voussoir/base/text.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace Voussoir
{
  /**
   * The values of an entry that takes one of a few words, with these words, in
   * the order of the manual. Each such entry has an enum and a function
   *
   *   inline OptionNames<Partition>
   *   option_names(const Partition)
   *   {
   *     return {{Partition::p4est, "p4est"}, {Partition::metis, "METIS"}};
   *   }
   */
  template <typename Option>
  using OptionNames = std::vector<std::pair<Option, std::string>>;


  /** The word for a value. */
  template <typename Option>
  std::string
  option_name(const Option value)
  {
    const auto names = option_names(value);
    return std::find_if(names.begin(),
                        names.end(),
                        [value](const auto &option) {
                          return option.first == value;
                        })
      ->second;
  }


  /**
   * ParameterHandler::add_parameter for such an entry.
   *
   * @param allowed values that the entry can have; empty: all
   */
  template <typename Option>
  void
  add_option(dealii::ParameterHandler  &prm,
             const std::string         &entry,
             Option                    &value,
             const std::string         &documentation,
             const std::vector<Option> &allowed = {})
  {
    std::vector<std::string> words;
    for (const auto &[option, name] : option_names(value))
      if (allowed.empty() ||
          std::find(allowed.begin(), allowed.end(), option) != allowed.end())
        words.push_back(name);
    prm.declare_entry(entry,
                      option_name(value),
                      dealii::Patterns::Selection(join(words, "|")),
                      documentation);
    prm.add_action(entry, [&value](const std::string &word) {
      for (const auto &[option, name] : option_names(value))
        if (name == word)
          value = option;
    });
  }
} // namespace Voussoir

#endif
