#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/boundary_parameters.h>

#include <map>

namespace Voussoir
{
  using namespace dealii;

  void
  BoundaryParameters::declare(ParameterHandler &prm)
  {
    supports.declare(prm);
    absorbing.declare(prm);
  }


  void
  BoundaryParameters::check(const Grid &grid) const
  {
    std::map<std::string, std::string> kind_of_set;
    for (const auto &[kind, list] :
         std::map<std::string, std::string>{{"Fixed", supports.fixed},
                                            {"Roller", supports.roller},
                                            {"Antisymmetric",
                                             supports.antisymmetric},
                                            {"Absorbing", absorbing.face_sets}})
      for (const std::string &set : split_list(list))
        {
          check_outer_face_set(grid,
                               set,
                               "\"" + kind + "\" in section \"Boundaries\"");
          const auto [place, is_new] = kind_of_set.emplace(set, kind);
          if (!is_new)
            throw UserError("In section \"Boundaries\" the face set \"" + set +
                            "\" is named twice, as \"" + place->second +
                            "\" and as \"" + kind + "\"; keep one of them.");
        }
  }


  bool
  BoundaryParameters::empty() const
  {
    return supports.list().empty() && split_list(absorbing.face_sets).empty();
  }


  std::vector<Support>
  BoundaryParameters::supports_with_absorbing(const bool roller) const
  {
    std::vector<Support> result = supports.list();
    for (const std::string &set : split_list(absorbing.face_sets))
      result.push_back(
        {set, roller ? Support::Fixed::normal : Support::Fixed::all});
    return result;
  }
} // namespace Voussoir
