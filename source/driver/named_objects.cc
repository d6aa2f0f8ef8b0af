#include <voussoir/base/active.h>
#include <voussoir/base/parameter_section.h>
#include <voussoir/base/section_names.h>
#include <voussoir/base/text.h>
#include <voussoir/driver/case.h>

namespace Voussoir
{
  using namespace dealii;

  template <typename Base>
  void
  NamedObjects<Base>::declare(ParameterHandler    &prm,
                              const ParameterFile &file,
                              const std::string   &section,
                              const std::string   &what,
                              const std::string   &default_class,
                              const bool           can_rest)
  {
    in_section(prm, section, [&] {
      prm.declare_entry("Names",
                        "",
                        Patterns::Anything(),
                        "Names of the " + what +
                          ", separated by commas; each has a section of that "
                          "name here.");
      const auto names = split_list(file.given(section + "/Names"));
      check_section_names(names, "\"Names\" in section \"" + section + "\"");
      for (const std::string &name : names)
        in_section(prm, name, [&] {
          const std::string path = section + "/" + name;
          prm.declare_entry("Class",
                            default_class,
                            Patterns::Selection(
                              join(Registry<Base>::names(), "|")),
                            "Class; the other entries depend on it.");
          const bool active = !can_rest || declared_active(prm, file, path);
          declare_one(prm,
                      name,
                      path,
                      file.given(path + "/Class", default_class),
                      "\"Class\" in section \"" + path + "\"",
                      active);
        });
    });
  }


  template <typename Base>
  void
  NamedObjects<Base>::declare_one(ParameterHandler  &prm,
                                  const std::string &name,
                                  const std::string &place,
                                  const std::string &class_name,
                                  const std::string &place_of_class,
                                  const bool         active)
  {
    auto object = Registry<Base>::create(class_name, place_of_class);
    object->declare_parameters(prm);
    (active ? objects : inactive).emplace_back(name, object.get());
    (active ? origins : origins_of_inactive)
      .push_back({place, class_name, std::move(object)});
  }


  template <typename Base>
  void
  NamedObjects<Base>::for_each(
    const std::function<void(const std::string &, Base &)> &visit)
  {
    for (Origin &origin : origins)
      visit(origin.place, *origin.object);
  }


  template <typename Base>
  typename NamedObjects<Base>::List
  NamedObjects<Base>::make(const ParameterFile &file) const
  {
    List list;
    for (unsigned int i = 0; i < objects.size(); ++i)
      {
        const auto &[place, class_name, read] = origins[i];
        auto             object = Registry<Base>::create(class_name, place);
        ParameterHandler prm;
        in_section(prm, place, [&] { object->declare_parameters(prm); });
        file.parse_declared(prm);
        list.emplace_back(objects[i].first, std::move(object));
      }
    return list;
  }


  template class NamedObjects<Material>;
  template class NamedObjects<Load>;
  template class NamedObjects<Projection>;
  template class NamedObjects<Observer>;
} // namespace Voussoir
