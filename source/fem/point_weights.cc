#include <voussoir/base/error.h>
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


  PointWeights::PointWeights(const Discretization          &discretization,
                             const std::vector<NamedPoint> &points,
                             const std::string             &place)
    : n_points(points.size())
  {
    const auto            &scalar       = discretization.fe.base_element(0);
    const MPI_Comm         communicator = discretization.grid.communicator();
    constexpr unsigned int nowhere      = numbers::invalid_unsigned_int;
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);

    struct Send
    {
      unsigned int point;
      double       weight;
    };
    std::vector<std::pair<types::global_dof_index, Send>> records;
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        // the lowest rank that finds the point has it
        Discretization::Cell found;
        Point<3>             unit;
        bool                 here = false;
        for (const auto &cell :
             discretization.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned() && !here &&
              cell->bounding_box().point_inside(points[p].position, 1e-6))
            {
              try
                {
                  unit = discretization.mapping.transform_real_to_unit_cell(
                    static_cast<Triangulation<3>::active_cell_iterator>(cell),
                    points[p].position);
                }
              catch (const Mapping<3>::ExcTransformationFailed &)
                {
                  continue;
                }
              if (GeometryInfo<3>::is_inside_unit_cell(unit, 1e-6))
                {
                  found = cell;
                  here  = true;
                }
            }
        const unsigned int finder =
          Utilities::MPI::min(here ? rank : nowhere, communicator);
        if (finder == nowhere)
          {
            std::ostringstream position;
            position << points[p].position;
            throw UserError(place + ": the point \"" + points[p].name +
                            "\" at (" + position.str() +
                            ") m lies outside the mesh; correct its "
                            "coordinates.");
          }
        if (finder == rank)
          {
            const auto nodes = discretization.cell_nodes(found);
            for (unsigned int j = 0; j < nodes.size(); ++j)
              for (const auto &carrier : discretization.carriers(nodes[j]))
                records.push_back(
                  {carrier.node,
                   {p, carrier.weight * scalar.shape_value(j, unit)}});
          }
      }
    for (const auto &[node, send] : discretization.send_to_owners(records))
      if (std::abs(send.weight) > 1e-12)
        items.push_back({send.point, node, send.weight});
  }


  std::vector<Tensor<1, 3>>
  PointWeights::share(const Vector &vector) const
  {
    std::vector<Tensor<1, 3>> values(n_points);
    for (const Weight &item : items)
      for (unsigned int d = 0; d < 3; ++d)
        values[item.point][d] +=
          item.weight * vector.local_element(3 * item.node + d);
    return values;
  }
} // namespace Voussoir
