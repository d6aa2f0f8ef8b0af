// The pages that write a class from an empty file: their cases are run as a
// reader would run them, and the results are compared.

#include <voussoir/driver/command_line.h>

#include <fstream>

#include "check.h"

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr double g = 9.81; // [m/s2]

    /** Base class: runs the case of a page. */
    class Guide : public Check
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Page", page, "The page, relative to this file.");
      }

      void
      run(const ParameterFile &file,
          Verdicts            &verdicts,
          const MPI_Comm       communicator) override
      {
        prepare(file.resolve(page), verdicts);
        std::ofstream("case.prm") << block_of(file.resolve(page), "prm");
        std::vector<std::string> arguments{"voussoir",
                                           "case.prm",
                                           "--overwrite",
                                           "--set",
                                           "Output/Folder=results"};
        std::vector<char *>      pointers;
        for (std::string &argument : arguments)
          pointers.push_back(argument.data());

        std::ostringstream    said;
        std::streambuf *const terminal = std::cout.rdbuf(said.rdbuf());
        const int             code =
          run_command_line(pointers.size(), pointers.data(), communicator);
        std::cout.rdbuf(terminal);
        verdicts.is_true("the case of the page runs", code == 0);

        nlohmann::json summary;
        std::ifstream("results/summary.json") >> summary;
        compare(summary, verdicts);
      }

    protected:
      virtual void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const = 0;

      /** Makes the files that the case of the page needs. */
      virtual void
      prepare(const std::string & /*page*/, Verdicts & /*verdicts*/) const
      {}

      /** The first block of a language that a page shows. */
      static std::string
      block_of(const std::string &page, const std::string &language)
      {
        std::ifstream      in(page);
        std::ostringstream text;
        text << in.rdbuf();
        const std::string whole = text.str(), opening = "```" + language + "\n";
        const auto        begin = whole.find(opening) + opening.size();
        return whole.substr(begin, whole.find("```", begin) - begin);
      }

      /** The values of the first column of a table of the run whose header
       *  holds @p quantity. */
      static std::vector<double>
      column(const std::string &table, const std::string &quantity)
      {
        std::ifstream in("results/" + table);
        std::string   line;
        std::getline(in, line);
        const auto   headers = split_list(line);
        unsigned int number  = 0;
        while (headers.at(number).find(quantity) == std::string::npos)
          ++number;
        std::vector<double> values;
        while (std::getline(in, line))
          values.push_back(std::stod(split_list(line).at(number)));
        return values;
      }

    private:
      std::string page;
    };


    class GeneratorGuide : public Guide
    {
      void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const override
      {
        const double height = 12., length = 20., crest = 6., density = 2000.;
        const double base   = crest + (1.5 + 2.) * height;
        const double volume = 0.5 * (crest + base) * height * length;
        const auto  &weight =
          summary["static state"]["stages"][0]["loads"]["weight"];
        verdicts.near("weight of the prism [MN]",
                      -1e-6 * double(weight["resultant [N]"][2]),
                      1e-6 * density * g * volume,
                      1e-6);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<GeneratorGuide>
      registered_generator("guide to a mesh generator",
                           "The volume of the mesh.");


    class LoadGuide : public Guide
    {
      void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const override
      {
        const double volume = 30. * 10. * 0.5 * (2. + 8.), density = 1800.;
        const double weight = density * g * volume;
        const auto  &stage  = summary["static state"]["stages"][0];
        verdicts.near("resultant [MN]",
                      -1e-6 *
                        double(stage["loads"]["bank"]["resultant [N]"][2]),
                      1e-6 * weight,
                      1e-6);
        verdicts.near("reactions [MN]",
                      1e-6 * double(stage["sum of reactions [N]"][2]),
                      1e-6 * weight,
                      1e-6);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<LoadGuide>
      registered_load("guide to a load", "The resultant of the load.");


    class ObserverGuide : public Guide
    {
      void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const override
      {
        const double pressure = 1e6, density = 2000., modulus = 8e9;
        const double speed = pressure / std::sqrt(density * modulus);
        const auto   lines = column("speed.csv", "largest speed");
        verdicts.near("largest speed of all [m/s]",
                      summary["largest speed [m/s]"],
                      speed,
                      0.01);
        verdicts.near("largest in the table [m/s]",
                      *std::max_element(lines.begin(), lines.end()),
                      speed,
                      0.01);
        verdicts.below("last in the table, over the largest",
                       lines.back() / speed,
                       0.01);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<ObserverGuide>
      registered_observer("guide to an observer", "Speed of a pushed column.");


    class InterfaceLawGuide : public Guide
    {
      void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const override
      {
        const double area = 100., pressure = 2e6;      // [m2], [Pa]
        const double mu_s = 0.8, mu_d = 0.6, D = 4e-3; // D [m]
        const auto   normal = column("interfaces.csv", "normal force");
        const auto   shear  = column("interfaces.csv", "shear force");
        const double force  = area * pressure;
        verdicts.near("normal force [MN]", normal.back(), 1e-6 * force, 0.001);
        verdicts.near("strength at first, over the normal force",
                      *std::max_element(shear.begin(), shear.end()) /
                        normal.back(),
                      mu_s,
                      0.01);
        verdicts.near("strength at last, over the normal force",
                      shear.back() / normal.back(),
                      mu_d,
                      0.01);
        const auto  &plane = summary["interfaces"]["surfaces"]["plane"];
        const double slip  = 1e-3 * double(plane["residual slip [mm]"]);
        verdicts.near("lost in friction [MJ]",
                      1e-6 * double(plane["energies [J]"]["friction"]),
                      1e-6 * force * (mu_d * slip + (mu_s - mu_d) * D / 2.),
                      0.01);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<InterfaceLawGuide>
      registered_interface_law("guide to an interface law",
                               "Strengths and energy of the law.");


    class MeshGuide : public Guide
    {
      void
      prepare(const std::string &page, Verdicts &verdicts) const override
      {
        std::ofstream("wall.geo") << block_of(page, "geo");
        verdicts.is_true("Gmsh makes the mesh",
                         std::system("gmsh -3 wall.geo > gmsh.log") == 0);
      }

      void
      compare(const nlohmann::json &summary, Verdicts &verdicts) const override
      {
        const double height = 20., thickness = 8., length = 20., row = 2.5,
                     water = 18., density = 2400., density_of_water = 1000.;
        const auto &stages = summary["static state"]["stages"];
        verdicts.near(
          "weight of the wall [MN]",
          -1e-6 * double(stages[0]["loads"]["weight"]["resultant [N]"][2]),
          1e-6 * density * g * height * thickness * length,
          1e-6);
        verdicts.near("thrust of the water [MN]",
                      -1e-6 *
                        double(stages[1]["loads"]["water"]["resultant [N]"][1]),
                      1e-6 * density_of_water * g * 0.5 * water * water *
                        length,
                      1e-6);
        // the rock joins its lowest nodes
        verdicts.near("area of the joint [m2]",
                      summary["interfaces"]["surfaces"]["joint"]["area [m2]"],
                      (height - 0.5 * row) * thickness,
                      1e-6);
      }
    };

    // Reference: closed form
    const Registry<Check>::Add<MeshGuide>
      registered_mesh("guide to a mesh of one's own",
                      "The mesh that Gmsh makes, its names and its joint.");
  } // namespace
} // namespace Voussoir
