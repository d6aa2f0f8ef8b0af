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
    struct Range
    {
      double smallest = std::numeric_limits<double>::max(), largest = 0.;
    };


    /** Cube roots of the volumes of the cells of each material [m]. */
    std::vector<Range>
    cell_sizes(const Grid &grid, const unsigned int n_materials)
    {
      std::vector<Range> sizes(n_materials);
      for (const auto &cell : grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            Range       &of_material = sizes[grid.material(cell)];
            const double size        = std::cbrt(cell->measure());
            of_material.smallest     = std::min(of_material.smallest, size);
            of_material.largest      = std::max(of_material.largest, size);
          }
      for (Range &of_material : sizes)
        {
          of_material.smallest =
            Utilities::MPI::min(of_material.smallest, grid.communicator());
          of_material.largest =
            Utilities::MPI::max(of_material.largest, grid.communicator());
        }
      return sizes;
    }


    std::string
    remark_on_tips(const Material &material, const Range &sizes)
    {
      // f^-2 = 1 + h / constant
      const double of_1_m = material.tip_strength(1.),
                   halves = 3. / (1. / (of_1_m * of_1_m) - 1.);
      std::ostringstream text;
      text << std::setprecision(3)
           << "at tips of cracks the tensile strength is lowered to "
           << 100. * material.tip_strength(sizes.largest)
           << " % in the largest cells, of " << sizes.largest << " m, and to "
           << 100. * material.tip_strength(sizes.smallest)
           << " % in the smallest, of " << sizes.smallest
           << " m; it is below half in cells larger than " << halves << " m.";
      return text.str();
    }


    struct CellsAtNotches
    {
      unsigned long long number   = 0;
      double             strength = 1.; // the lowest, over that of the material
    };


    /** Of each material. */
    std::vector<CellsAtNotches>
    cells_at_notches(const Grid                          &grid,
                     const std::vector<const Material *> &materials)
    {
      const std::vector<double> strength =
        strength_at_notches(grid, {materials.begin(), materials.end()});
      std::vector<CellsAtNotches> found(materials.size());
      for (const auto &cell : grid.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          if (const double factor = strength[grid.owned_cell(cell)];
              factor < 1.)
            {
              CellsAtNotches &of_material = found[grid.material(cell)];
              ++of_material.number;
              of_material.strength = std::min(of_material.strength, factor);
            }
      for (CellsAtNotches &of_material : found)
        {
          of_material.number =
            Utilities::MPI::sum(of_material.number, grid.communicator());
          of_material.strength =
            Utilities::MPI::min(of_material.strength, grid.communicator());
        }
      return found;
    }


    std::string
    remark_on_notches(const CellsAtNotches &cells)
    {
      std::ostringstream text;
      text << std::setprecision(3) << "at notches, where outer faces meet at "
           << "more than 200 degrees, " << cells.number
           << " cells have a tensile strength lowered to "
           << 100. * cells.strength << " % at least.";
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
    const auto grows = [](const auto &material) {
      return material->tip_strength(1.) < 1.;
    };
    if (std::none_of(materials.begin(), materials.end(), grows))
      return notes;
    const std::vector<Range> sizes      = cell_sizes(grid, materials.size());
    const auto               at_notches = cells_at_notches(grid, materials);
    for (unsigned int m = 0; m < materials.size(); ++m)
      {
        if (grows(materials[m]) && sizes[m].largest > 0.)
          notes[m].push_back(remark_on_tips(*materials[m], sizes[m]));
        if (at_notches[m].number > 0)
          notes[m].push_back(remark_on_notches(at_notches[m]));
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
