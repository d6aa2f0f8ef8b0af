#include <voussoir/analysis/stage_results.h>
#include <voussoir/base/active.h>
#include <voussoir/base/error.h>
#include <voussoir/base/parameter_entries.h>
#include <voussoir/base/parameter_section.h>
#include <voussoir/base/section_names.h>
#include <voussoir/base/text.h>
#include <voussoir/base/usual_range.h>
#include <voussoir/driver/case.h>
#include <voussoir/driver/crack_refinement.h>
#include <voussoir/driver/random_classes.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_report.h>
#include <voussoir/output/material_memory.h>

#include <algorithm>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    std::vector<std::string>
    mesh_types()
    {
      std::vector<std::string> names{"file"};
      for (const std::string &name : Registry<MeshGenerator>::names())
        names.push_back(name);
      return names;
    }
  } // namespace


  void
  TimeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("End time",
                      end_time,
                      "Duration of the motion to compute [s].",
                      Patterns::Double(0.));
    prm.add_parameter("Time step",
                      time_step,
                      "Time step [s]; 0 for the largest stable one times the "
                      "safety factor.",
                      Patterns::Double(0.));
    prm.add_parameter("Safety factor",
                      safety_factor,
                      "Time step over the largest stable one.",
                      Patterns::Double(0.01, 1.));
    add_option(
      prm,
      "Scheme",
      scheme,
      "Velocity on which dashpots and mass damping act. Central difference: "
      "that at the step, which does not reduce the stable step. Paper: that "
      "of the half step before, as in PSDAP.");
  }


  namespace
  {
    /** Adds an object for each class, with the name of the class. */
    template <typename Base>
    void
    name_each_class(std::vector<std::string> &changes,
                    const std::string        &section,
                    const std::string        &class_entry)
    {
      const auto names = Registry<Base>::names();
      changes.push_back(section + "/Names=" + join(names, ", "));
      for (const std::string &name : names)
        changes.push_back(section + "/" + name + "/" + class_entry + "=" +
                          name);
    }

    ParameterFile
    one_of_each_class()
    {
      std::vector<std::string> changes{"Output/Observers=" +
                                       join(Registry<Observer>::names(), ", ")};
      changes.push_back("Acceptance/Names=criterion");
      name_each_class<InterfaceLaw>(changes, "Interfaces", "Law");
      name_each_class<Material>(changes, "Materials", "Class");
      name_each_class<Load>(changes, "Loads", "Class");
      name_each_class<Projection>(changes, "Constraints", "Class");
      return ParameterFile().with(changes);
    }
  } // namespace


  Case::Case()
    : file(one_of_each_class())
  {
    declare();
    file.parse(prm);
  }


  namespace
  {
    /** Static stages report results at the points of the histories, too, unless
     *  the file gives other points. */
    void
    add_points_of_histories(Case &parameters)
    {
      std::string &points = parameters.static_state.points;
      if (!points.empty())
        return;
      points = usual_points_of_stages;
      for (const auto &observer : parameters.observers.objects)
        if (observer.first == "histories")
          points += "; " + parameters.file.given("Output/histories/Points");
    }


    /** Notes an entry, by its path, which the file gives but does not use. */
    void
    note_if_given(Case              &parameters,
                  const std::string &path,
                  const std::string &cause)
    {
      if (!parameters.file.given(path).empty())
        parameters.notes.push_back("\"" + entry_of(path) + "\" in section \"" +
                                   section_of(path) + "\" is not used, as " +
                                   cause);
    }


    void
    note_unused_crack_friction(Case &parameters)
    {
      parameters.materials.for_each(
        [&parameters](const std::string &place, Material &) {
          if (parameters.file.given(place + "/Crack direction", "rotating") ==
              "rotating")
            note_if_given(parameters,
                          place + "/Crack friction",
                          "\"Crack direction\" there is \"rotating\"");
        });
    }


    /** Notes entries of a design spectrum that its shape does not use. */
    void
    note_unused_spectrum(Case &parameters)
    {
      const std::string place = "Ground motion/Spectrum",
                        code  = "hydropower code";
      for (const auto &[section, usual] :
           {std::pair(place, code),
            std::pair(place + "/Vertical", std::string("as horizontal"))})
        {
          const std::string shape =
            parameters.file.given(section + "/Shape", usual);
          for (const auto &[entry, own_shape] :
               {std::pair<std::string, std::string>("Maximum amplification",
                                                    code),
                {"Characteristic period", code},
                {"Decay exponent", code},
                {"Periods", "table"},
                {"Amplifications", "table"}})
            if (shape != own_shape)
              note_if_given(parameters,
                            section + "/" + entry,
                            "\"Shape\" there is \"" + shape + "\"");
        }
    }


    /** Notes entries of waves that a rigid base or a vertical wave leaves out.
     */
    void
    note_unused_wave(Case &parameters)
    {
      const WaveParameters &wave = parameters.wave;
      if (wave.enters_through == WaveEntrance::rigid_base)
        for (const char *const path : {"Wave field/Type",
                                       "Wave field/Angle",
                                       "Wave field/Azimuth",
                                       "Wave field/Maximum frequency",
                                       "Ground motion/Given at"})
          note_if_given(parameters,
                        path,
                        "\"Enters through\" in section \"Wave field\" is "
                        "\"rigid base\", which moves as given");
      else if (wave.type == WaveType::vertical)
        for (const char *const path :
             {"Wave field/Angle", "Wave field/Azimuth"})
          note_if_given(parameters, path, "\"Type\" there is \"vertical\"");
    }
  } // namespace


  Case::Case(const ParameterFile                           &file,
             const std::function<void(ParameterHandler &)> &declare_more)
    : file(with_random_classes(file))
  {
    const ParameterFile without_added = this->file;
    add_observers();
    declare();
    if (declare_more)
      declare_more(prm);
    for (const std::string &note : without_added.parse(prm))
      notes.push_back(note);
    if (!generator && !reader.file.empty())
      reader.file = file.resolve(reader.file);
    warnings = unusual_values(prm);
    find_water_of_uplift();
    add_points_of_histories(*this);
    note_unused_crack_friction(*this);
    note_unused_spectrum(*this);
    note_unused_wave(*this);
    check();
    for (const std::string &warning : ground_motion.warnings())
      warnings.push_back(warning);
    // natural modes alone need no steps
    if (modes.number > 0 && !moves())
      time.end_time = 0.;
  }


  Case::~Case() = default;


  void
  Case::declare()
  {
    prm.add_parameter("Title",
                      title,
                      "Title of the case, one line, for the "
                      "log.");

    in_section(prm, "Mesh", [&] {
      prm.add_parameter("Type",
                        mesh_type,
                        "A built-in generator, or a file of Gmsh, Abaqus, "
                        "UCD or VTK; the section of that name has its "
                        "entries.",
                        Patterns::Selection(join(mesh_types(), "|")));
      grid.declare(prm);
      const std::string type = file.given("Mesh/Type", mesh_type);
      if (type == "file")
        in_section(prm, type, [&] { reader.declare(prm); });
      else if (Registry<MeshGenerator>::entries().count(type) > 0)
        {
          generator = Registry<MeshGenerator>::entries()[type].create();
          in_section(prm, type, [&] { generator->declare_parameters(prm); });
        }
    });
    interfaces.declare(prm, file);
    in_section(prm, "Discretization", [&] { discretization.declare(prm); });
    materials.declare(
      prm, file, "Materials", "materials", "linear elastic", false);
    in_section(prm, "Boundaries", [&] { boundaries.declare(prm); });
    in_section(prm, "Ground motion", [&] { ground_motion.declare(prm); });
    in_section(prm, "Wave field", [&] { wave.declare(prm); });
    loads.declare(prm, file, "Loads", "loads", "surface load", true);
    for (const auto &load : loads.inactive)
      static_state.left_out.push_back(load.first);
    in_section(prm, "Reservoir", [&] { reservoir.declare(prm); });
    in_section(prm, "Static state", [&] { static_state.declare(prm); });
    in_section(prm, "Modes", [&] { modes.declare(prm); });
    in_section(prm, "Material test", [&] { material_test.declare(prm); });
    projections.declare(
      prm, file, "Constraints", "constraints", "prescribed motion", true);
    in_section(prm, "Damping", [&] { damping.declare(prm); });
    in_section(prm, "Time", [&] { time.declare(prm); });
    in_section(prm, "Study", [&] { study.declare(prm); });
    check_section_names(split_list(file.given("Acceptance/Names")),
                        "\"Names\" in section \"Acceptance\"");
    in_section(prm, "Acceptance", [&] { acceptance.declare(prm, file); });
    in_section(prm, "Output", [&] {
      output.declare(prm);
      const auto names =
        split_list(file.given("Output/Observers", output.observers));
      check_section_names(names, "\"Observers\" in section \"Output\"");
      declare_unused_observers(names);
      for (const std::string &name : names)
        if (Registry<Observer>::entries().count(name) > 0)
          {
            in_section(prm, name, [&] {
              observers.declare_one(prm,
                                    name,
                                    "Output/" + name,
                                    name,
                                    "\"Observers\" in section \"Output\"");
            });
          }
    });
  }


  void
  Case::check()
  {
    if (generator)
      generator->check();
    else
      reader.check();
    if (materials.objects.empty())
      throw UserError("\"Names\" in section \"Materials\" is empty; name at "
                      "least one material and give it cell sets.");
    materials.for_each([](const std::string &place, Material &material) {
      material.check("Section \"" + place + "\"");
    });
    if (discretization.one_point(false) && discretization.degree > 1)
      throw UserError("\"Quadrature\" in section \"Discretization\" is \"" +
                      option_name(discretization.quadrature) +
                      "\", which cells of \"Degree\" " +
                      std::to_string(discretization.degree) +
                      " do not have; set \"Degree = 1\", or take \"Gauss\" "
                      "or \"Gauss-Lobatto\".");
    materials.for_each([&](const std::string &place, const Material &material) {
      if (material.cracks_along_planes() && !discretization.one_point(true))
        throw UserError("\"Crack growth\" in section \"" + place +
                        "\" is \"along planes\", which needs cells with one "
                        "integration point; set \"Quadrature = one point\" in "
                        "section \"Discretization\", or take another growth.");
    });
    interfaces.check();
    static_state.check(loads.objects, interfaces);
    modes.check(material_names(), boundaries);
    ground_motion.check();
    damping.check(modes.number);
    check_reproducible();
    check_refinement(*this);
    study.check();
    acceptance.check();
    const bool rigid_base = wave.enters_through == WaveEntrance::rigid_base;
    if (ground_motion.type != GroundMotionType::none && !rigid_base &&
        split_list(boundaries.absorbing.face_sets).empty())
      throw UserError("The earthquake of section \"Ground motion\" enters "
                      "through an absorbing boundary, but \"Absorbing\" in "
                      "section \"Boundaries\" names no face sets; name some, "
                      "or set \"Enters through = rigid base\" in section "
                      "\"Wave field\".");
    if (ground_motion.type != GroundMotionType::none && rigid_base &&
        split_list(boundaries.supports.fixed).empty())
      throw UserError("The earthquake of section \"Ground motion\" enters "
                      "through a rigid base, but \"Fixed\" in section "
                      "\"Boundaries\" names no face sets; name the base.");
  }


  void
  Case::check_reproducible() const
  {
    if (discretization.sums != Sums::reproducible)
      return;
    const auto refuse = [](const std::string &what, const std::string &remedy) {
      throw UserError("\"Sums = reproducible\" in section \"Discretization\" "
                      "does not cover " +
                      what + "; " + remedy + ", or set \"Sums = as dealt\".");
    };
    if (discretization.degree != 1)
      refuse("cells of \"Degree\" " + std::to_string(discretization.degree),
             "set \"Degree = 1\"");
    if (reservoir.model == ReservoirModel::compressible)
      refuse("compressible water",
             "set \"Model = added mass\" in section \"Reservoir\"");
    if (modes.number > 0 && damping.depends_on_modes())
      refuse("damping that is fitted to modes by \"" +
               std::string(damping.modes.empty() ? "Reference frequency" :
                                                   "From modes") +
               "\" in section \"Damping\"",
             damping.modes.empty() ?
               "give it in Hz" :
               "give the ends of the band and leave it empty");
    if (!static_state.stage_names().empty() && static_state.kept.empty())
      refuse("a static state that is computed again for each number of ranks",
             "name a folder in \"Keep in\" of section \"Static state\"");
  }


  void
  Case::find_water_of_uplift()
  {
    std::string first;
    for (const auto &stage : static_state.stage_names())
      for (const std::string &name : stage)
        if (first.empty() && file.given("Loads/" + name + "/Class") == "water")
          first = name;
    for (InterfaceParameters &interface : interfaces.list)
      if (interface.uplift.given() && interface.uplift.comes_with.empty())
        interface.uplift.comes_with = first;
  }


  CoarseMesh
  Case::make_mesh(std::ostream &log) const
  {
    CoarseMesh mesh;
    if (generator)
      {
        mesh = generator->generate();
        check_mesh(mesh,
                   "The generated mesh",
                   "change sizes and shape in section \"Mesh/" + mesh_type +
                     "\" so that the cells there are less distorted");
      }
    else
      mesh = reader.read(&log);
    log << describe_mesh(mesh);
    if (generator)
      log << generator->describe(mesh);
    for (const std::string &remark : mesh.remarks)
      log << remark << '\n';
    return mesh;
  }


  std::vector<unsigned int>
  Case::material_of_coarse_cells(const CoarseMesh &mesh) const
  {
    constexpr unsigned int    none = numbers::invalid_unsigned_int;
    std::vector<unsigned int> result(mesh.cells.size(), none);
    std::vector<std::string>  known;
    RandomClasses             random_classes(mesh);
    for (const auto &set : mesh.cell_sets)
      known.push_back(set.first);

    for (unsigned int m = 0; m < materials.objects.size(); ++m)
      {
        const auto &[name, material] = materials.objects[m];
        for (const std::string &set : split_list(material->cell_sets))
          {
            const auto cells = mesh.cell_sets.find(set);
            if (cells == mesh.cell_sets.end())
              throw UserError("\"Cell sets\" in section \"Materials/" + name +
                              "\" names \"" + set +
                              "\", which the mesh does not have" +
                              known_names(set, known) + ".");
            for (const unsigned int cell : cells->second)
              {
                if (!random_classes.holds(material->random_field, cell))
                  continue;
                if (result[cell] != none && result[cell] != m)
                  throw UserError(
                    "Cells of the set \"" + set + "\" have two materials, \"" +
                    materials.objects[result[cell]].first + "\" and \"" + name +
                    "\"; make their \"Cell sets\" in section \"Materials\" "
                    "disjoint.");
                result[cell] = m;
              }
          }
      }

    std::size_t without = 0, example = 0;
    for (std::size_t cell = 0; cell < result.size(); ++cell)
      if (result[cell] == none)
        {
          ++without;
          example = cell;
        }
    if (without > 0)
      {
        std::vector<std::string> sets;
        for (const auto &[name, cells] : mesh.cell_sets)
          if (std::find(cells.begin(), cells.end(), example) != cells.end())
            sets.push_back(name);
        throw UserError(
          counted(without, "cell has", "cells have") +
          " no material, for example one of " +
          (sets.empty() ? "no set at all" :
                          "the set \"" + join(sets, "\", \"") + "\"") +
          "; add the set to the \"Cell sets\" of a material in section "
          "\"Materials\".");
      }
    return result;
  }


  std::vector<const Material *>
  Case::material_list() const
  {
    std::vector<const Material *> list;
    for (const auto &item : materials.objects)
      list.push_back(item.second);
    return list;
  }


  std::vector<std::string>
  Case::material_names() const
  {
    std::vector<std::string> names;
    for (const auto &item : materials.objects)
      names.push_back(item.first);
    return names;
  }


  bool
  Case::moves() const
  {
    std::size_t n_staged = 0;
    for (const auto &stage : static_state.stage_names())
      n_staged += stage.size();
    return ground_motion.type != GroundMotionType::none ||
           !projections.objects.empty() || loads.objects.size() > n_staged;
  }
} // namespace Voussoir
