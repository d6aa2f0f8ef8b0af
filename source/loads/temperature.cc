#include <voussoir/base/error.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/fem/named_sets.h>
#include <voussoir/grid/face_distance.h>
#include <voussoir/loads/load.h>
#include <voussoir/signals/design_spectrum.h>

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
        prm.add_parameter(
          "Cell sets",
          cell_sets,
          "Cell sets whose temperature changes, outer nodes included; in the "
          "cells beside them the change decreases to zero.");
        prm.add_parameter("Uniform change",
                          uniform,
                          "Change of temperature since the joints were closed, "
                          "the same everywhere [K]; negative if colder. The "
                          "table is added to this change.");
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
                          "Face sets from which the thickness is measured.");
        prm.add_parameter("Downstream faces",
                          downstream_faces,
                          "Face sets to which the thickness is measured.");
      }

      bool
      steady() const override
      {
        return true;
      }

      void
      prepare(const Solid &solid,
              const ParameterFile &,
              const std::string &place,
              Log               &log) override
      {
        const std::string section = " in section \"" + place + "\"";
        read_table("\"Table\"" + section);
        if (elevations.empty() && uniform == 0.)
          throw UserError("Section \"" + place +
                          "\" changes no temperature; give a \"Uniform "
                          "change\" or a \"Table\".");

        const Discretization &discretization = solid.discretization;
        const auto            sets           = split_list(cell_sets);
        if (sets.empty())
          throw UserError(
            "\"Cell sets\"" + section +
            " is empty; name the cell sets whose temperature changes.");
        double                            largest_expansion = 0.;
        std::set<types::global_dof_index> touched;
        for_each_cell(discretization,
                      sets,
                      "\"Cell sets\"" + section,
                      [&](const Discretization::Cell &cell) {
                        largest_expansion =
                          std::max(largest_expansion,
                                   solid.material_of(cell).expansion);
                        for (const auto node : discretization.cell_nodes(cell))
                          touched.insert(node);
                      });
        if (Utilities::MPI::max(largest_expansion,
                                discretization.grid.communicator()) == 0.)
          throw UserError("Section \"" + place +
                          "\" does nothing, as \"Thermal expansion\" of the "
                          "materials of its cells is zero; give it in section "
                          "\"Materials\".");
        heated_nodes = owned_carriers(discretization, touched);
        changes.assign(heated_nodes.size(), uniform);
        if (!elevations.empty())
          add_table(discretization, section);
        check_changes(discretization, section, log);
        report_error_of_stress(solid, sets, section, log);
      }

      void
      add_temperature(Vector &temperature) const override
      {
        for (unsigned int i = 0; i < heated_nodes.size(); ++i)
          for (unsigned int d = 0; d < 3; ++d)
            temperature.local_element(3 * heated_nodes[i] + d) += changes[i];
      }

    private:
      void
      add_table(const Discretization &discretization,
                const std::string    &section)
      {
        if (split_list(upstream_faces) == split_list(downstream_faces))
          throw UserError("\"Upstream faces\" and \"Downstream faces\"" +
                          section +
                          " are the same, so that there is no thickness "
                          "between them; name those of both sides.");
        const FaceDistance upstream(discretization.grid,
                                    split_list(upstream_faces),
                                    "\"Upstream faces\"" + section),
          downstream(discretization.grid,
                     split_list(downstream_faces),
                     "\"Downstream faces\"" + section);
        for (unsigned int i = 0; i < heated_nodes.size(); ++i)
          {
            const Point<3> &x = discretization.node_positions[heated_nodes[i]];
            const double    from = upstream(x), to = downstream(x);
            // where the two faces meet, the mean
            const double part = from + to > 0. ? from / (from + to) : 0.5;
            changes[i] +=
              interpolate(elevations, means, x[2]) +
              interpolate(elevations, differences, x[2]) * (part - 0.5);
          }
      }

      void
      check_changes(const Discretization &discretization,
                    const std::string    &section,
                    Log                  &log) const
      {
        constexpr double usual = 60.; // [K]

        double largest = 0., bottom = std::numeric_limits<double>::max(),
               top = -bottom;
        for (unsigned int i = 0; i < heated_nodes.size(); ++i)
          {
            const double z = discretization.node_positions[heated_nodes[i]][2];
            bottom         = std::min(bottom, z);
            top            = std::max(top, z);
            largest        = std::max(largest, std::abs(changes[i]));
          }
        const MPI_Comm communicator = discretization.grid.communicator();
        largest = Utilities::MPI::max(largest, communicator);
        bottom  = Utilities::MPI::min(bottom, communicator);
        top     = Utilities::MPI::max(top, communicator);
        if (largest > usual)
          log.warn("the temperature",
                   section,
                   " changes by up to ",
                   largest,
                   " K; give changes since the joints were closed, not the "
                   "temperature itself");
        if (elevations.size() > 1 && // a single row holds everywhere
            (elevations.front() > top || elevations.back() < bottom))
          log.warn("\"Table\"",
                   section,
                   " goes from z = ",
                   elevations.front(),
                   " to ",
                   elevations.back(),
                   " m, but the cells from ",
                   bottom,
                   " to ",
                   top,
                   " m; give elevations z in the coordinates of the mesh");
      }

      /** Logs the error of the stress in trilinear cells: their thermal strain
       *  is linear across them, but their strain constant. At the faces of a
       *  cell across which the temperature changes by D, the stress normal to
       *  them errs by E a D / (2 (1 - 2 nu)). */
      void
      report_error_of_stress(const Solid                    &solid,
                             const std::vector<std::string> &sets,
                             const std::string              &section,
                             Log                            &log) const
      {
        constexpr double      noteworthy     = 1e5; // [Pa]
        const Discretization &discretization = solid.discretization;
        if (discretization.degree > 1)
          return;
        Vector temperature = discretization.create_vector();
        add_temperature(temperature);
        temperature.update_ghost_values();
        const auto &partitioner =
          *discretization.matrix_free.get_vector_partitioner();
        double difference = 0., error = 0.;
        for_each_cell(
          discretization,
          sets,
          "\"Cell sets\"" + section,
          [&](const Discretization::Cell &cell) {
            double low = std::numeric_limits<double>::max(), high = -low;
            for (const auto node : discretization.cell_nodes(cell))
              {
                double change = 0.;
                for (const auto &carrier : discretization.carriers(node))
                  change += carrier.weight *
                            temperature.local_element(
                              partitioner.global_to_local(3 * carrier.node));
                low  = std::min(low, change);
                high = std::max(high, change);
              }
            const Material        &material = solid.material_of(cell);
            const ElasticConstants c        = material.elastic_constants();
            difference                      = std::max(difference, high - low);
            error                           = std::max(error,
                             material.static_factor * c.young_modulus *
                               material.expansion * (high - low) /
                               (2. * (1. - 2. * c.poisson_ratio)));
          });
        const MPI_Comm communicator = discretization.grid.communicator();
        difference = Utilities::MPI::max(difference, communicator);
        error      = Utilities::MPI::max(error, communicator);
        if (error > noteworthy)
          log.line(std::setprecision(2),
                   "note: the temperature",
                   section,
                   " changes by up to ",
                   difference,
                   " K within a cell of degree 1, at whose faces the stress "
                   "normal to them errs by up to ",
                   1e-6 * error,
                   " MPa; more cells through the thickness reduce this error, "
                   "degree 2 removes most of it");
      }

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
      std::vector<unsigned int> heated_nodes;
      std::vector<double>       changes; // of these nodes [K]
    };

    const Registry<Load>::Add<Temperature> registered_temperature(
      "temperature",
      "A change of temperature, over the elevation and through the "
      "dam.");
  } // namespace
} // namespace Voussoir
