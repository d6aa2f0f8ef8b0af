// Boundary and materials of a model in the log.

#include <voussoir/driver/model.h>
#include <voussoir/fem/notches.h>

#include <algorithm>
#include <iomanip>

namespace Voussoir
{
  using namespace dealii;

  void
  Model::check_source_point(Log &log) const
  {
    const AbsorbingParameters &absorbing = parameters.boundaries.absorbing;
    if (split_list(absorbing.face_sets).empty() ||
        absorbing.type == AbsorbingType::viscous || absorbing.radius > 0.)
      return;
    const auto &[lower, upper] = boundary.extent();
    Tensor<1, 3> outside;
    for (unsigned int d = 0; d < 3; ++d)
      outside[d] = std::max(
        {0., lower[d] - absorbing.source[d], absorbing.source[d] - upper[d]});
    if (outside.norm() > 3. * upper.distance(lower))
      log.warn(
        "\"Source point\" in section \"Boundaries\" is ",
        outside.norm(),
        " m outside the model, which reaches from (",
        lower,
        ") to (",
        upper,
        ") m; springs at this distance from it have hardly any stiffness");
  }


  namespace
  {
    /** Cells of a material, with cube roots of their volumes [m]. */
    struct Cells
    {
      double smallest = std::numeric_limits<double>::max(), largest = 0.;

      unsigned long long n_at_notches   = 0;
      double             least_strength = 1.; // at notches
    };


    std::vector<Cells>
    cells_of(const Grid &grid, const std::vector<const Material *> &materials)
    {
      const std::vector<Notch> notches = notches_of_cells(grid);
      std::vector<Cells>       found(materials.size());
      for (const auto &cell : grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int material    = grid.material(cell);
            Cells             &of_material = found[material];
            const double       size        = std::cbrt(cell->measure());
            of_material.smallest = std::min(of_material.smallest, size);
            of_material.largest  = std::max(of_material.largest, size);
            const double strength =
              strength_at_notch(*materials[material],
                                notches[grid.owned_cell(cell)],
                                size);
            if (strength < 1.)
              ++of_material.n_at_notches;
            of_material.least_strength =
              std::min(of_material.least_strength, strength);
          }
      const MPI_Comm communicator = grid.communicator();
      for (Cells &of_material : found)
        {
          of_material.smallest =
            Utilities::MPI::min(of_material.smallest, communicator);
          of_material.largest =
            Utilities::MPI::max(of_material.largest, communicator);
          of_material.n_at_notches =
            Utilities::MPI::sum(of_material.n_at_notches, communicator);
          of_material.least_strength =
            Utilities::MPI::min(of_material.least_strength, communicator);
        }
      return found;
    }


    std::string
    remark_on_tips(const Material &material, const Cells &cells)
    {
      // f^-2 = 1 + h / constant
      const double of_1_m = material.tip_strength(1.),
                   halves = 3. / (1. / (of_1_m * of_1_m) - 1.);
      std::ostringstream text;
      text << std::setprecision(3)
           << "at tips of cracks the tensile strength is lowered to "
           << 100. * material.tip_strength(cells.largest)
           << " % in the largest cells, of " << cells.largest << " m, and to "
           << 100. * material.tip_strength(cells.smallest)
           << " % in the smallest, of " << cells.smallest
           << " m; it is below half in cells larger than " << halves << " m.";
      return text.str();
    }


    std::string
    remark_on_notches(const Cells &cells)
    {
      std::ostringstream text;
      text << std::setprecision(3) << "at notches, where outer faces meet at "
           << "more than 200 degrees, " << cells.n_at_notches
           << " cells have a tensile strength lowered to "
           << 100. * cells.least_strength << " % at least.";
      return text.str();
    }
  } // namespace


  std::vector<std::vector<std::string>>
  Model::notes_on_cracks() const
  {
    const auto                           &materials = solid.materials;
    std::vector<std::vector<std::string>> notes(materials.size());
    for (unsigned int m = 0; m < materials.size(); ++m)
      if (materials[m]->n_history() > 0 &&
          materials[m]->tensile_failure().strength > 0. &&
          solid.discretization.points(m).size() == 1 &&
          !materials[m]->cracks_along_planes())
        notes[m].push_back(
          "cells with one integration point keep their stiffness against "
          "bending when they crack, so that a crack whose sides turn against "
          "each other keeps most of its load; with \"Quadrature = one point "
          "where elastic\" they have eight, and with \"Crack growth = along "
          "planes\", where the class has it, a crack takes this stiffness.");
    if (!any_cracks_grow({materials.begin(), materials.end()}))
      return notes;
    const std::vector<Cells> cells = cells_of(grid, materials);
    for (unsigned int m = 0; m < materials.size(); ++m)
      {
        if (materials[m]->cracks_grow() && cells[m].largest > 0.)
          notes[m].push_back(remark_on_tips(*materials[m], cells[m]));
        if (cells[m].n_at_notches > 0)
          notes[m].push_back(remark_on_notches(cells[m]));
      }
    return notes;
  }


  void
  Model::report_materials(Log &log) const
  {
    const std::vector<double> carried = carried_frequencies(),
                              widest  = widest_crack_bands();
    const auto on_cracks              = notes_on_cracks();
    for (unsigned int m = 0; m < solid.materials.size(); ++m)
      {
        const ElasticConstants c = solid.materials[m]->elastic_constants();
        std::ostringstream     text;
        text << std::setprecision(4) << "Material "
             << parameters.materials.objects[m].first << ": mass "
             << solid.mass.total[m] << " kg, P wave " << c.p_wave_speed()
             << " m/s, S wave " << c.s_wave_speed()
             << " m/s; its largest cells carry waves up to "
             << std::setprecision(2) << carried[m]
             << " Hz with 8 nodes per wavelength";
        log.line(text.str());
        if (const std::string remark = solid.materials[m]->remark(widest[m]);
            !remark.empty())
          log.line("  note: ", remark);
        for (const std::string &note : on_cracks[m])
          log.line("  note: ", note);
        if (solid.materials[m]->n_history() > 0 &&
            solid.discretization.degree > 2)
          log.line(
            "  note: fracture energies hold in cells of degree 1 and 2; "
            "in cells of a higher degree the energy of a crack deviates from "
            "them.");
      }
  }
} // namespace Voussoir
