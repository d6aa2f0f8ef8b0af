#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/loads/design_spectrum.h>
#include <voussoir/loads/load.h>
#include <voussoir/mesh/face_distance.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    /** Change of temperature of a dam: Tm(z) + Td(z) xi/T, with xi/T from -1/2
     *  at the upstream face to 1/2 at the downstream face. */
    class Temperature : public Load
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Cell sets",
                          cell_sets,
                          "Cell sets that it changes in, with their outer "
                          "nodes; in the cells beside them it fades to zero.");
        prm.add_parameter("Uniform change",
                          uniform,
                          "Change of temperature since the joints were closed, "
                          "the same everywhere [K]; negative where it is "
                          "colder. The table comes on top.");
        prm.add_parameter(
          "Table",
          table_text,
          "\"elevation mean difference\" separated by \";\", from below: at an "
          "elevation [m], the change of the mean over the thickness [K] and of "
          "the temperature downstream minus upstream [K]. The codes' Tm and "
          "Td; linear over the thickness and between the elevations, constant "
          "beyond them.");
        prm.add_parameter("Upstream faces",
                          upstream_faces,
                          "Face sets from which the thickness counts.");
        prm.add_parameter("Downstream faces",
                          downstream_faces,
                          "Face sets to which the thickness counts.");
      }

      bool
      steady() const override
      {
        return true;
      }

      void
      prepare(const LoadedModel &model,
              NodalTerms &,
              const std::string &place) override
      {
        const std::string section = " in section \"" + place + "\"";
        read_table("\"Table\"" + section);
        if (elevations.empty() && uniform == 0.)
          throw UserError("Section \"" + place +
                          "\" changes no temperature; give a \"Uniform "
                          "change\" or a \"Table\".");

        const Discretization &discretization = model.discretization;
        const auto            sets           = split_list(cell_sets);
        if (sets.empty())
          throw UserError("\"Cell sets\"" + section +
                          " is empty; name the cell sets that it changes in.");
        std::set<types::global_dof_index> touched;
        for_each_cell(discretization,
                      sets,
                      "\"Cell sets\"" + section,
                      [&](const Discretization::Cell &cell) {
                        for (const auto node : discretization.cell_nodes(cell))
                          touched.insert(node);
                      });
        nodes = owned_carriers(discretization, touched);
        changes.assign(nodes.size(), uniform);
        if (elevations.empty())
          return;

        const FaceDistance upstream(discretization.grid,
                                    split_list(upstream_faces),
                                    "\"Upstream faces\"" + section),
          downstream(discretization.grid,
                     split_list(downstream_faces),
                     "\"Downstream faces\"" + section);
        for (unsigned int i = 0; i < nodes.size(); ++i)
          {
            const Point<3> &x    = discretization.node_positions[nodes[i]];
            const double    from = upstream(x), to = downstream(x);
            // where the two faces meet it is the mean
            const double part = from + to > 0. ? from / (from + to) : 0.5;
            changes[i] +=
              interpolate(elevations, means, x[2]) +
              interpolate(elevations, differences, x[2]) * (part - 0.5);
          }
      }

      void
      add_temperature(Vector &temperature) const override
      {
        for (unsigned int i = 0; i < nodes.size(); ++i)
          for (unsigned int d = 0; d < 3; ++d)
            temperature.local_element(3 * nodes[i] + d) += changes[i];
      }

    private:
      void
      read_table(const std::string &place)
      {
        for (const std::string &row : split_list(table_text, ';'))
          {
            const auto numbers = parse_numbers(row);
            if (!numbers || numbers->size() != 3)
              throw UserError(place + ": \"" + row +
                              "\" needs three numbers, the elevation [m], the "
                              "change of the mean and that of the difference "
                              "downstream minus upstream [K].");
            if (!elevations.empty() && (*numbers)[0] <= elevations.back())
              throw UserError(place + ": \"" + row +
                              "\" does not lie above the row before it; list "
                              "the elevations from below.");
            elevations.push_back((*numbers)[0]);
            means.push_back((*numbers)[1]);
            differences.push_back((*numbers)[2]);
          }
      }

      std::string cell_sets = "dam";
      double      uniform   = 0.;
      std::string table_text;
      std::string upstream_faces   = "upstream face";
      std::string downstream_faces = "downstream face";

      std::vector<double>       elevations, means, differences; // the table
      std::vector<unsigned int> nodes;
      std::vector<double>       changes; // of these nodes [K]
    };

    const Registry<Load>::Add<Temperature>
      registered("temperature",
                 "A change of temperature, over the elevation and through the "
                 "dam.");
  } // namespace
} // namespace Voussoir
