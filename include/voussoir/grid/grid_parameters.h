#ifndef voussoir_grid_grid_parameters_h
#define voussoir_grid_grid_parameters_h

#include <voussoir/base/option.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <functional>
#include <string>
#include <vector>

namespace Voussoir
{
  enum class Partition
  {
    p4est,
    metis
  };

  inline OptionNames<Partition>
  option_names(const Partition)
  {
    return {{Partition::p4est, "p4est"}, {Partition::metis, "METIS"}};
  }


  /** An item of the entry "Local refinement". */
  struct LocalRefinement
  {
    std::string      set; // empty: a box
    dealii::Point<3> lower, upper;
    unsigned int     levels;
  };


  /** The entries of the section "Mesh/Refine where". */
  struct RefineWhereParameters
  {
    std::string  demand_of, cell_sets, expression;
    double       threshold = 0.8, share = 0.75;
    unsigned int levels = 3;

    void
    declare(dealii::ParameterHandler &prm);

    bool
    wanted() const;

    /** Whether the demand is that of a linear run which the program makes
     *  itself. */
    bool
    wants_linear_run() const;

    /** Whether a point is one that "Expression" names; any is, if there is
     *  none. Throws UserError if the expression is no formula. */
    std::function<bool(const dealii::Point<3> &)>
    place() const;
  };


  /** The entries of the section "Mesh" that do not depend on the source of the
   *  mesh. */
  struct GridParameters
  {
    unsigned int global_refinement = 0;
    std::string  local_refinement;
    Partition    partition = Partition::p4est;

    RefineWhereParameters refine_where;

    /** Nodes per length of the S waves of this frequency [Hz], down to which
     *  cells are refined; zero: no refinement. */
    double nodes_per_wavelength = 0., highest_frequency = 10.;

    /** Numbers of ranks for which a partition is counted, see
     *  PartitionCounts. */
    std::vector<unsigned int> counted_ranks;

    void
    declare(dealii::ParameterHandler &prm);

    /** Whether the mesh is not refined, and divided along a Hilbert curve
     *  instead of by p4est; see order_along_curve(). */
    bool
    divided_along_curve() const;

    /** The items of `local_refinement`; throws UserError for other text. */
    std::vector<LocalRefinement>
    local_refinements() const;

    /** Longest edge that cells of this degree may have where S waves have this
     *  speed [m/s] [m]. */
    double
    longest_edge(const double s_wave_speed, const unsigned int degree) const;
  };
} // namespace Voussoir

#endif
