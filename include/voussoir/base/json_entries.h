#ifndef voussoir_base_json_entries_h
#define voussoir_base_json_entries_h

#include <deal.II/base/tensor.h>

#include <nlohmann/json.hpp>

#include <limits>
#include <map>
#include <optional>
#include <string>

namespace Voussoir
{
  // Structs whose members have names in JSON, listed once for writing and
  // reading: for_each_entry(part, entry) calls entry(name, member) for all
  // members. Unknown values, that is an empty optional, map or JSON, are left
  // out.

  template <typename T>
  void
  write_entry(nlohmann::json &json, const char *name, const T &value)
  {
    json[name] = value;
  }

  template <typename T>
  void
  write_entry(nlohmann::json         &json,
              const char             *name,
              const std::optional<T> &value)
  {
    if (value)
      json[name] = *value;
  }

  template <typename T>
  void
  write_entry(nlohmann::json                 &json,
              const char                     *name,
              const std::map<std::string, T> &parts)
  {
    if (!parts.empty())
      json[name] = parts;
  }

  inline void
  write_entry(nlohmann::json       &json,
              const char           *name,
              const nlohmann::json &part)
  {
    if (!part.is_null())
      json[name] = part;
  }

  template <typename T>
  void
  read_entry(const nlohmann::json &json, T &value)
  {
    json.get_to(value);
  }

  /** The components in a list. */
  inline nlohmann::json
  to_json(const dealii::Tensor<1, 3> &vector)
  {
    return {vector[0], vector[1], vector[2]};
  }

  /** JSON has neither NaN nor infinity. */
  inline void
  read_entry(const nlohmann::json &json, double &value)
  {
    value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() :
                             json.get<double>();
  }

  template <typename T>
  void
  read_entry(const nlohmann::json &json, std::optional<T> &value)
  {
    read_entry(json, value.emplace());
  }

  template <typename T>
  void
  write_entries(nlohmann::json &json, T part)
  {
    for_each_entry(part, [&json](const char *name, const auto &member) {
      write_entry(json, name, member);
    });
  }

  /** Members that the JSON lacks stay unchanged. */
  template <typename T>
  void
  read_entries(const nlohmann::json &json, T &part)
  {
    for_each_entry(part, [&json](const char *name, auto &member) {
      if (json.contains(name))
        read_entry(json.at(name), member);
    });
  }
} // namespace Voussoir

#endif
