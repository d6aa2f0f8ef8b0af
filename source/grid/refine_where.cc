#include <voussoir/base/error.h>
#include <voussoir/grid/grid_parameters.h>
#include <voussoir/grid/refine_where.h>

#include <deal.II/base/function_parser.h>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    constexpr char linear_run[] = "linear run";

    // of a cell and its ring, over the cell
    constexpr double with_ring = 3.;


    BoundingBox<3>
    box_around(const CellFrame &cell, const double factor)
    {
      Tensor<1, 3> half;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int d = 0; d < 3; ++d)
          half[k] += 0.5 * factor * std::abs(cell.edges[k][d]);
      return BoundingBox<3>({cell.centre - half, cell.centre + half});
    }
  } // namespace


  void
  RefineWhereParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Demand of",
      demand_of,
      "Output folder of an earlier run of this model with the observer "
      "envelopes, or \"linear run\" for a linear run on the unrefined mesh, "
      "which the program makes first: cells are refined whose largest "
      "principal stress over the tensile strength exceeded \"Threshold\", or "
      "that left the elastic range, and the ring of cells around them. "
      "Of the entries of this section that are given all must hold.");
    prm.add_parameter("Cell sets",
                      cell_sets,
                      "Cell sets to refine; empty for all cells.");
    prm.add_parameter(
      "Expression",
      expression,
      "Formula in x, y and z [m], such as \"z > 100 && y < 0\", "
      "that is positive at the centres of the cells to refine; "
      "empty for all cells.");
    prm.add_parameter(
      "Threshold",
      threshold,
      "Largest principal stress over the static tensile strength above which a "
      "cell is refined. Below 1, since coarse cells average the stress.",
      Patterns::Double(0.01, 10.));
    prm.add_parameter(
      "Cell length",
      share,
      "Length of the longest edge over E Gf / ft^2 of the material, down to "
      "which cells are refined. Up to 0.99 a crack follows its softening curve; "
      "at 0.75 it runs on at a load that is 7 % too high.",
      Patterns::Double(0.05, 10.));
    prm.add_parameter("Levels",
                      levels,
                      "The largest number of times that a cell is halved.",
                      Patterns::Integer(1, 6));
  }


  bool
  RefineWhereParameters::wanted() const
  {
    return !(demand_of.empty() && cell_sets.empty() && expression.empty());
  }


  bool
  RefineWhereParameters::wants_linear_run() const
  {
    return demand_of == linear_run;
  }


  std::function<bool(const Point<3> &)>
  RefineWhereParameters::place() const
  {
    if (expression.empty())
      return [](const Point<3> &) { return true; };
    const auto function = std::make_shared<FunctionParser<3>>();
    try
      {
        function->initialize("x,y,z", expression, {{"pi", numbers::PI}});
        function->value(Point<3>());
      }
    catch (const std::exception &)
      {
        throw UserError("\"Expression\" in section \"Mesh/Refine where\": \"" +
                        expression +
                        "\" is no formula in x, y and z; write for example "
                        "\"z > 100 && y < 0\".");
      }
    return
      [function](const Point<3> &point) { return function->value(point) > 0.; };
  }


  CellsAndRing::CellsAndRing(const std::vector<CellFrame> &cells)
    : cells(cells)
  {
    std::vector<std::pair<BoundingBox<3>, unsigned int>> items;
    for (unsigned int i = 0; i < cells.size(); ++i)
      items.emplace_back(box_around(cells[i], with_ring), i);
    boxes = pack_rtree(items);
  }


  bool
  CellsAndRing::reach(const CellFrame &cell) const
  {
    namespace bgi   = boost::geometry::index;
    const auto near = [&](const auto &item) {
      const CellFrame &other = cells[item.second];
      return other.holds(cell.centre, with_ring) ||
             cell.holds(other.centre, 1.);
    };
    return boxes.qbegin(bgi::intersects(box_around(cell, 1.)) &&
                        bgi::satisfies(near)) != boxes.qend();
  }
} // namespace Voussoir
