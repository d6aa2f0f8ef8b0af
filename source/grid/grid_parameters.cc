#include <voussoir/base/error.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/base/parse_numbers.h>
#include <voussoir/grid/grid_parameters.h>

#include <limits>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  void
  GridParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter(
      "Global refinement",
      global_refinement,
      "How many times each cell is cut into eight. The new nodes of an arch "
      "dam without wedges lie on its true faces, joints and canyon; other "
      "meshes are refined at the middles of their edges. Every rank stores the "
      "whole mesh before refinement, and only its part afterwards; so give "
      "large meshes in coarse cells.",
      Patterns::Integer(0, 6));
    prm.add_parameter(
      "Local refinement",
      local_refinement,
      "Local refinement, items separated by \";\": "
      "\"set: levels\" for a cell set, or \"box x0 y0 z0 x1 y1 z1: levels\" "
      "[m] for the cells whose centre lies in the box. Hanging nodes result.");
    prm.add_parameter(
      "Nodes per wavelength",
      nodes_per_wavelength,
      "Cells are refined, material by material, until the S waves of "
      "\"Highest frequency\" have this number of nodes per wavelength; 8 "
      "suffice for amplitudes, 0 leaves the mesh unchanged. Hanging nodes "
      "result, so that far rock may be given in cells as large as these waves "
      "allow.",
      Patterns::Double(0., 100.));
    prm.add_parameter("Highest frequency",
                      highest_frequency,
                      "Frequency for \"Nodes per wavelength\" [Hz].",
                      Patterns::Double(0.01, 1000.));
    add_option(
      prm,
      "Partition",
      partition,
      "How the cells are distributed to the ranks; the results are the same. "
      "With p4est every rank stores the mesh before refinement; a mesh that is "
      "not refined is made by one rank of each machine, which sends the others "
      "their parts along a Hilbert curve. With METIS one rank of each machine "
      "makes the refined mesh and sends the others their parts, which takes "
      "less memory for a fine mesh from a file.");
    prm.add_parameter(
      "Count partitions",
      counted_ranks,
      "Numbers of ranks, separated by commas, for which the log describes the "
      "partition: balance, neighbours of a rank, nodes that it exchanges with "
      "them and the part of its cells without these; summary.json has them "
      "rank by rank. The run itself may have another number of ranks.",
      Patterns::List(Patterns::Integer(1, 1000000)));
    prm.enter_subsection("Refine where");
    refine_where.declare(prm);
    prm.leave_subsection();
  }


  bool
  GridParameters::divided_along_curve() const
  {
    return partition == Partition::p4est && global_refinement == 0 &&
           local_refinement.empty() && nodes_per_wavelength == 0. &&
           !refine_where.wanted();
  }


  double
  GridParameters::longest_edge(const double       s_wave_speed,
                               const unsigned int degree) const
  {
    return nodes_per_wavelength > 0. ?
             s_wave_speed * degree /
               (nodes_per_wavelength * highest_frequency) :
             std::numeric_limits<double>::infinity();
  }


  std::vector<LocalRefinement>
  GridParameters::local_refinements() const
  {
    std::vector<LocalRefinement> items;
    for (const std::string &item : split_list(local_refinement, ';'))
      {
        const auto        colon = item.rfind(':');
        const std::string place = "\"Local refinement\" in section \"Mesh\"";
        if (colon == std::string::npos)
          throw UserError(place + ": \"" + item +
                          "\" has no \": levels\"; write for example "
                          "\"dam: 1\" or \"box 0 0 0 10 10 10: 1\".");
        LocalRefinement    result;
        std::istringstream levels(item.substr(colon + 1));
        std::string        rest;
        if (!(levels >> result.levels) || result.levels > 4 || (levels >> rest))
          throw UserError(place + ": \"" + item +
                          "\" must end in a number of levels from 0 to 4.");
        result.set = Utilities::trim(item.substr(0, colon));
        if (result.set.rfind("box ", 0) == 0)
          {
            const auto corners = parse_numbers(result.set.substr(4));
            if (!corners || corners->size() != 6)
              throw UserError(place + ": \"" + item +
                              "\" needs six coordinates [m] after \"box\".");
            for (unsigned int d = 0; d < 3; ++d)
              {
                result.lower[d] = (*corners)[d];
                result.upper[d] = (*corners)[3 + d];
                if (result.lower[d] >= result.upper[d])
                  throw UserError(place + ": in \"" + item +
                                  "\" the second corner must lie above the "
                                  "first in " +
                                  "xyz"[d] + "; exchange the two.");
              }
            result.set.clear();
          }
        items.push_back(result);
      }
    return items;
  }
} // namespace Voussoir
