#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/driver/material_test.h>

#include <deal.II/base/utilities.h>

#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    struct Path
    {
      bool                is_strain;
      std::vector<double> values;
    };


    /** Reads "xx: 0, 1e-4; yy: 0, 0". */
    void
    read_paths(const std::string            &text,
               const bool                    is_strain,
               std::map<unsigned int, Path> &paths)
    {
      const std::string place =
        std::string(is_strain ? "\"Strains\"" : "\"Stresses\"") +
        " in section \"Material test\"";
      for (const std::string &item : Utilities::split_string_list(text, ';'))
        {
          const auto         colon = item.find(':');
          const std::string  name  = Utilities::trim(item.substr(0, colon));
          const auto        &names = PointTest::component_names();
          const unsigned int component =
            std::find(names.begin(), names.end(), name) - names.begin();
          if (colon == std::string::npos || component == 6)
            throw UserError("\"" + item + "\" in " + place +
                            " does not begin with a component; write, as in "
                            "\"xx: 0, 1e-4, 0\", one of xx, yy, zz, xy, xz, "
                            "yz.");
          if (paths.count(component) > 0)
            throw UserError("Component " + name +
                            " of the material test is given twice.");
          Path path{is_strain, {}};
          for (const std::string &number : split_list(item.substr(colon + 1)))
            if (const auto value = parse_number(number); value)
              path.values.push_back(*value);
            else
              throw UserError("\"" + number + "\" in " + place +
                              " is no number.");
          paths[component] = path;
        }
    }
  } // namespace


  void
  MaterialTestParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Material",
                      material,
                      "Name of the material that \"voussoir --material-test\" "
                      "tests; empty for the first one.");
    prm.add_parameter("Strains",
                      strains,
                      "Corners of the path of each given strain, components "
                      "separated by semicolons, as in \"xx: 0, 2e-4, 0; yy: 0, "
                      "0, 0\". Shear strains are those of the tensor.");
    prm.add_parameter(
      "Stresses",
      stresses,
      "The same for given stresses [Pa]. Components that are not given are "
      "free of stress.");
    prm.add_parameter("Steps",
                      steps,
                      "Number of steps from corner to corner.",
                      Patterns::Integer(1));
    prm.add_parameter("Time between corners",
                      segment_time,
                      "Time from corner to corner, for rate-dependent laws "
                      "[s].",
                      Patterns::Double(1e-9));
    prm.add_parameter("Element length",
                      element_length,
                      "Size of the cell around the point, for the crack band "
                      "[m].",
                      Patterns::Double(1e-6));
  }


  void
  MaterialTestParameters::run(const Material &tested, std::ostream &csv) const
  {
    std::map<unsigned int, Path> paths;
    read_paths(strains, true, paths);
    read_paths(stresses, false, paths);
    std::size_t corners = 0;
    for (const auto &path : paths)
      corners = std::max(corners, path.second.values.size());
    for (const auto &[component, path] : paths)
      if (path.values.size() != corners || corners < 2)
        throw UserError("The paths in section \"Material test\" need the same "
                        "number of corners, two or more; that of " +
                        PointTest::component_names()[component] + " has " +
                        std::to_string(path.values.size()) + ".");

    const double time_step = segment_time / steps;
    PointTest    test(tested, element_length, time_step);
    csv << "time [s]";
    for (const std::string &name : PointTest::component_names())
      csv << ",strain " << name;
    for (const std::string &name : PointTest::component_names())
      csv << ",stress " << name << " [MPa]";
    csv << ",work [kJ/m3],stored [kJ/m3],lost [kJ/m3]";
    for (const std::string &name : tested.output_names())
      csv << ',' << name;
    csv << '\n' << std::setprecision(9);

    for (std::size_t i = 0; i + 1 < corners; ++i)
      for (unsigned int step = i == 0 ? 0 : 1; step <= steps; ++step)
        {
          PointTest::Controls controls;
          for (const auto &[component, path] : paths)
            controls[component] = {path.is_strain,
                                   path.values[i] +
                                     (path.values[i + 1] - path.values[i]) *
                                       step / steps};
          test.advance(controls);
          csv << (i * steps + step) * time_step;
          for (unsigned int c = 0; c < 6; ++c)
            csv << ',' << test.strain.access_raw_entry(c);
          for (unsigned int c = 0; c < 6; ++c)
            csv << ',' << 1e-6 * test.stress.access_raw_entry(c);
          csv << ',' << 1e-3 * test.work << ',' << 1e-3 * test.stored << ','
              << 1e-3 * test.dissipated;
          for (const double value : test.outputs())
            csv << ',' << value;
          csv << '\n';
        }
  }
} // namespace Voussoir
