#ifndef voussoir_base_registry_h
#define voussoir_base_registry_h

#include <voussoir/base/error.h>
#include <voussoir/base/text.h>

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Voussoir
{
  /**
   * The named classes of one kind (materials, loads, projections, observers). A
   * class is registered by one line in its own source file,
   *
   *   const Registry<Material>::Add<LinearElastic> registered_linear_elastic(
   *     "linear elastic", "Isotropic Hooke's law.");
   *
   * and from that line follow the allowed values in the parameter file, the
   * manual, `--list` and the tests that run over all classes.
   */
  template <typename Base>
  class Registry
  {
  public:
    struct Entry
    {
      std::string                            description;
      std::function<std::unique_ptr<Base>()> create;
    };

    /**
     * Registers a class, as in the line above. Nothing can catch an error
     * before `main` begins, so a second class of the same name ends the program
     * at its start.
     */
    template <typename Class>
    struct Add
    {
      Add(const std::string &name, const std::string &description)
      {
        try
          {
            add(name, {description, [] { return std::make_unique<Class>(); }});
          }
        catch (const UserError &error)
          {
            std::cerr << "Error: " << error.what() << std::endl;
            std::exit(1);
          }
      }
    };

    /** Throws a UserError if there is a class of this name. */
    static void
    add(const std::string &name, const Entry &entry)
    {
      const auto [place, is_new] = entries().insert({name, entry});
      if (!is_new)
        throw UserError("Two classes register as \"" + name +
                        "\", described \"" + place->second.description +
                        "\" and \"" + entry.description +
                        "\"; rename one of the two.");
    }

    /** All classes by name, in alphabetical order. */
    static std::map<std::string, Entry> &
    entries()
    {
      static std::map<std::string, Entry> all;
      return all;
    }

    static std::vector<std::string>
    names()
    {
      std::vector<std::string> result;
      for (const auto &entry : entries())
        result.push_back(entry.first);
      return result;
    }

    /**
     * A new object of the class called @p name. @p place names where the name
     * was read, for the message when there is no such class.
     */
    static std::unique_ptr<Base>
    create(const std::string &name, const std::string &place)
    {
      const auto entry = entries().find(name);
      if (entry == entries().end())
        throw UserError(place + " cannot be \"" + name + "\"" +
                        known_names(name, names()) + ".");
      return entry->second.create();
    }
  };
} // namespace Voussoir

#endif
