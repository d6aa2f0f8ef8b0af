#include <voussoir/analysis/stage_results.h>
#include <voussoir/base/json_entries.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/text.h>
#include <voussoir/fem/nodal_values.h>

#include <array>
#include <iomanip>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    const std::string place = "\"Points\" in section \"Static state\"";


    /** Vertices of the upstream face at its top and at its bottom, by x, of all
     *  ranks. */
    std::array<std::vector<std::array<double, 3>>, 2>
    top_and_bottom(const Grid &grid)
    {
      std::vector<std::array<double, 3>> mine;
      grid.for_each_face("upstream face",
                         [&](const auto &cell, const unsigned int face) {
                           for (unsigned int v = 0; v < 4; ++v)
                             {
                               const Point<3> &at = cell->face(face)->vertex(v);
                               mine.push_back({{at[0], at[1], at[2]}});
                             }
                         });
      double top    = std::numeric_limits<double>::lowest(),
             bottom = std::numeric_limits<double>::max();
      for (const auto &at : mine)
        {
          top    = std::max(top, at[2]);
          bottom = std::min(bottom, at[2]);
        }
      top                = Utilities::MPI::max(top, grid.communicator());
      bottom             = Utilities::MPI::min(bottom, grid.communicator());
      const double level = 1e-6 * (top - bottom);

      std::array<std::vector<std::array<double, 3>>, 2> result;
      for (const auto &at : mine)
        if (at[2] > top - level)
          result[0].push_back(at);
        else if (at[2] < bottom + level)
          result[1].push_back(at);
      for (auto &vertices : result)
        {
          vertices = join_over_ranks(vertices, grid.communicator());
          std::sort(vertices.begin(), vertices.end());
        }
      return result;
    }


    NamedPoint
    nearest_in_x(const std::string                        &name,
                 const std::vector<std::array<double, 3>> &vertices,
                 const double                              x)
    {
      const auto nearest =
        *std::min_element(vertices.begin(),
                          vertices.end(),
                          [x](const auto &a, const auto &b) {
                            return std::abs(a[0] - x) < std::abs(b[0] - x);
                          });
      return {name, Point<3>(nearest[0], nearest[1], nearest[2])};
    }


    std::vector<NamedPoint>
    usual_points(const Grid &grid)
    {
      const auto &sets = grid.face_set_names();
      if (std::find(sets.begin(), sets.end(), "upstream face") == sets.end())
        return {};
      const auto [crest, foot] = top_and_bottom(grid);
      if (crest.empty() || foot.empty())
        return {};
      const double first = crest.front()[0], last = crest.back()[0];
      const auto   base = nearest_in_x("base of the crown",
                                     foot,
                                     0.5 * (foot.front()[0] + foot.back()[0]));
      const auto   crown =
        nearest_in_x("crest at the crown", crest, base.position[0]);
      const auto lower = nearest_in_x("crest at the right quarter point",
                                      crest,
                                      first + 0.25 * (last - first));
      const auto upper = nearest_in_x("crest at the left quarter point",
                                      crest,
                                      first + 0.75 * (last - first));
      // a section of one cell has no quarters
      if (lower.position[0] < crown.position[0] &&
          crown.position[0] < upper.position[0])
        return {lower, crown, upper, base};
      return {crown, base};
    }


    std::vector<NamedPoint>
    points_of(const Grid &grid, const std::string &list)
    {
      std::vector<std::string> given;
      bool                     usual = false;
      for (const std::string &item : split_list(list, ';'))
        if (item == usual_points_of_stages)
          usual = true;
        else
          given.push_back(item);
      std::vector<NamedPoint> points = parse_points(join(given, "; "), place);
      if (usual)
        for (const NamedPoint &point : usual_points(grid))
          if (std::none_of(points.begin(),
                           points.end(),
                           [&point](const NamedPoint &other) {
                             return other.name == point.name;
                           }))
            points.push_back(point);
      return points;
    }


    void
    describe_interfaces(const Contact  &contact,
                        const MPI_Comm  communicator,
                        nlohmann::json &report)
    {
      const auto         &names = contact.surface_names();
      std::vector<double> largest(2 * names.size()), sums(4 * names.size());
      for (const ContactPoint &point : contact.points())
        {
          double *most = &largest[2 * point.surface],
                 *sum  = &sums[4 * point.surface];
          if (point.joined)
            {
              most[0] = std::max(most[0], point.gap[0]);
              most[1] =
                std::max(most[1], std::hypot(point.gap[1], point.gap[2]));
            }
          const Tensor<1, 3> force = point.force * point.frame;
          sum[0] += point.force[0];
          for (unsigned int d = 0; d < 3; ++d)
            sum[1 + d] += force[d] - point.force[0] * point.frame[0][d];
        }
      Utilities::MPI::max(largest, communicator, largest);
      sums = sum_over_ranks(sums, communicator);
      for (unsigned int s = 0; s < names.size(); ++s)
        report[names[s]] = {{"largest opening [mm]", 1e3 * largest[2 * s]},
                            {"largest slip [mm]", 1e3 * largest[2 * s + 1]},
                            {"normal force [MN]", 1e-6 * sums[4 * s]},
                            {"shear force [MN]",
                             1e-6 * std::hypot(sums[4 * s + 1],
                                               sums[4 * s + 2],
                                               sums[4 * s + 3])}};
    }
  } // namespace


  StageResults::StageResults(const Discretization   &discretization,
                             const StaticParameters &parameters)
    : discretization(discretization)
    , points(points_of(discretization.grid, parameters.points))
    , weights(
        points.empty() ?
          nullptr :
          std::make_unique<const PointWeights>(discretization, points, place))
    , stresses(discretization, parameters.faces)
    , point_stresses(discretization, points, stresses.faces_with_arches())
  {}


  void
  StageResults::describe(const StressModel &model,
                         const Contact     *contact,
                         nlohmann::json    &report) const
  {
    const Vector  &displacement = model.initial.displacement;
    const MPI_Comm communicator = discretization.grid.communicator();
    // amount, place, displacement
    std::array<double, 7> most{};
    for (unsigned int node = 0; node < discretization.n_owned_nodes(); ++node)
      {
        const Tensor<1, 3> u  = node_value(displacement, node);
        const Point<3>    &at = discretization.node_positions[node];
        if (u.norm() > most[0])
          most = {{u.norm(), at[0], at[1], at[2], u[0], u[1], u[2]}};
      }
    for (const auto &other : Utilities::MPI::all_gather(communicator, most))
      most = std::max(most, other);
    report["place of the largest displacement [m]"] = {most[1],
                                                       most[2],
                                                       most[3]};
    report["largest displacement x, y, z [m]"] = {most[4], most[5], most[6]};
    if (weights)
      {
        const auto values = weights->value(displacement);
        for (unsigned int p = 0; p < points.size(); ++p)
          report["points"][points[p].name] = {
            {"position [m]", to_json(points[p].position)},
            {"displacement x [m]", values[p][0]},
            {"displacement y [m]", values[p][1]},
            {"displacement z [m]", values[p][2]}};
        point_stresses.describe(model, report["points"]);
      }
    stresses.describe(model, report);
    if (contact != nullptr)
      describe_interfaces(*contact, communicator, report["interfaces"]);
  }


  std::string
  description_of_stage(const nlohmann::json &report)
  {
    std::ostringstream text;
    text << std::setprecision(4);
    // smaller numbers are round-off [mm, MPa, MN]
    constexpr double least = 1e-9;
    const auto number = [](const nlohmann::json &values, const auto &name) {
      const double value = values.at(name);
      return std::abs(value) < least ? 0. : value;
    };
    if (report.contains("points"))
      for (const auto &[name, point] : report.at("points").items())
        {
          text << "    " << name << ": displacement (";
          for (const char axis : {'x', 'y', 'z'})
            text << 1e3 * number(point,
                                 std::string("displacement ") + axis + " [m]")
                 << (axis == 'z' ? ") mm" : ", ");
          text << ", principal stress "
               << number(point, "smallest principal stress [MPa]") << " to "
               << number(point, "largest principal stress [MPa]");
          for (const std::string kind : {"arch", "cantilever"})
            if (point.contains(kind + " stress [MPa]"))
              text << ", " << kind << " stress "
                   << number(point, kind + " stress [MPa]");
          text << " MPa\n";
        }
    if (report.contains("faces"))
      for (const auto &[name, face] : report.at("faces").items())
        {
          std::string between = "    " + name + ": ";
          for (const std::string kind : {"principal", "arch", "cantilever"})
            if (const std::string stress = kind + " stress [MPa]";
                face.contains("largest " + stress))
              {
                text << between << kind << " stress "
                     << number(face, "smallest " + stress) << " to "
                     << number(face, "largest " + stress) << " MPa";
                between = ", ";
              }
          text << '\n';
        }
    if (report.contains("interfaces"))
      for (const auto &[name, surface] : report.at("interfaces").items())
        text << "    " << name << ": opening "
             << number(surface, "largest opening [mm]") << " mm, slip "
             << number(surface, "largest slip [mm]") << " mm, normal force "
             << number(surface, "normal force [MN]") << " MN, shear "
             << number(surface, "shear force [MN]") << " MN\n";
    return text.str();
  }
} // namespace Voussoir
