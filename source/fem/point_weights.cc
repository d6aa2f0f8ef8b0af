#include <voussoir/base/error.h>
#include <voussoir/base/mpi.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/fem/point_weights.h>

#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  std::vector<NamedPoint>
  parse_points(const std::string &text, const std::string &place)
  {
    std::vector<NamedPoint> points;
    for (const std::string &item : split_list(text, ';'))
      {
        const auto         colon = item.find(':');
        NamedPoint         point;
        std::istringstream in(
          colon == std::string::npos ? "" : item.substr(colon + 1));
        std::string rest;
        if (!(in >> point.position[0] >> point.position[1] >>
              point.position[2]) ||
            (in >> rest))
          throw UserError(place + ": \"" + item +
                          "\" is no point; write \"name: x y z\" [m], several "
                          "separated by \";\".");
        point.name = Utilities::trim(item.substr(0, colon));
        for (const NamedPoint &other : points)
          if (other.name == point.name)
            throw UserError(place + " names \"" + point.name +
                            "\" twice; give each point its own name.");
        points.push_back(point);
      }
    return points;
  }


  std::optional<Point<3>>
  unit_place(const Discretization       &discretization,
             const Discretization::Cell &cell,
             const Point<3>             &point)
  {
    constexpr double tolerance = 1e-6;
    if (!cell->bounding_box().point_inside(point, tolerance))
      return {};
    try
      {
        const Point<3> unit =
          discretization.mapping.transform_real_to_unit_cell(
            static_cast<Triangulation<3>::active_cell_iterator>(cell), point);
        if (GeometryInfo<3>::is_inside_unit_cell(unit, tolerance))
          return unit;
      }
    catch (const Mapping<3>::ExcTransformationFailed &)
      {
        // far outside
      }
    return {};
  }


  PointWeights::PointWeights(const Discretization          &discretization,
                             const std::vector<NamedPoint> &points,
                             const std::string             &place)
    : n_points(points.size())
    , communicator(discretization.grid.communicator())
  {
    const auto             &scalar  = discretization.fe.base_element(0);
    constexpr std::uint64_t nowhere = std::numeric_limits<std::uint64_t>::max();
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    const bool         reproducible = discretization.reproducible;

    struct Send
    {
      unsigned int point, part;
      double       weight;
    };
    std::vector<std::pair<types::global_dof_index, Send>> records;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        // the point belongs to the lowest rank that finds it, or to the rank of
        // the lowest cell
        Discretization::Cell found;
        Point<3>             here_unit;
        std::uint64_t        mine = nowhere;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (const std::uint64_t key =
                reproducible ? Grid::global_key(cell) : rank;
              cell->is_locally_owned() && key < mine)
            if (const auto unit =
                  unit_place(discretization, cell, points[p].position))
              {
                found     = cell;
                here_unit = *unit;
                mine      = key;
              }
        // not deal.II's minimum, which is one of MPI_UNSIGNED_LONG: Open MPI
        // 4.1 takes numbers from 2^63 on, such as `nowhere`, for negative
        std::uint64_t first;
        MPI_Allreduce(&mine, &first, 1, MPI_UINT64_T, MPI_MIN, communicator);
        if (first == nowhere)
          {
            std::ostringstream position;
            position << points[p].position;
            throw UserError(place + ": the point \"" + points[p].name +
                            "\" at (" + position.str() +
                            ") m lies outside the mesh; correct its "
                            "coordinates.");
          }
        if (first == mine)
          {
            const auto nodes = discretization.cell_nodes(found);
            for (unsigned int j = 0; j < nodes.size(); ++j)
              for (const auto &carrier : discretization.carriers(nodes[j]))
                records.push_back(
                  {carrier.node,
                   {p,
                    reproducible ? j : 0,
                    carrier.weight * scalar.shape_value(j, here_unit)}});
          }
      }
    if (reproducible)
      n_parts = scalar.n_dofs_per_cell();
    for (const auto &[node, send] : discretization.send_to_owners(records))
      if (std::abs(send.weight) > 1e-12)
        items.push_back({send.point, send.part, node, send.weight});
  }


  std::vector<Tensor<1, 3>>
  PointWeights::share(const Vector &vector) const
  {
    std::vector<Tensor<1, 3>> values(n_parts * n_points);
    for (const Weight &item : items)
      for (unsigned int d = 0; d < 3; ++d)
        values[n_parts * item.point + item.part][d] +=
          item.weight * vector.local_element(3 * item.node + d);
    return values;
  }


  std::vector<Tensor<1, 3>>
  PointWeights::value(const Vector &vector) const
  {
    std::vector<double> parts;
    for (const Tensor<1, 3> &part : share(vector))
      parts.insert(parts.end(), part.begin_raw(), part.end_raw());
    parts = sum_over_ranks(parts, communicator);
    std::vector<Tensor<1, 3>> values(n_points);
    for (unsigned int i = 0; i < parts.size(); ++i)
      values[i / (3 * n_parts)][i % 3] += parts[i];
    return values;
  }
} // namespace Voussoir
