#include <voussoir/base/error.h>
#include <voussoir/base/text.h>
#include <voussoir/mesh/mesh_check.h>
#include <voussoir/mesh/mesh_geometry.h>
#include <voussoir/mesh_sources/arch_dam_mesh.h>
#include <voussoir/mesh_sources/generator.h>
#include <voussoir/mesh_sources/grading.h>
#include <voussoir/mesh_sources/lift_joints.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <sstream>

namespace Voussoir
{
  using namespace dealii;

  namespace
  {
    // Least number of columns between the abutments for the shape of a dam.
    constexpr double least_columns = 8.;


    /** An arch dam in its canyon. */
    class ArchDam : public MeshGenerator
    {
    public:
      void
      declare_parameters(ParameterHandler &prm) override
      {
        prm.add_parameter("Shape",
                          shape_name,
                          "A built-in dam, or \"custom\" for the dam of "
                          "section \"Custom shape\", which is ignored "
                          "otherwise.",
                          Patterns::Selection(
                            join(ArchDamShape::preset_names(), "|") +
                            "|custom"));
        prm.add_parameter(
          "Joints",
          n_joints,
          "Number of contraction joints, at equal distances "
          "along the crest; beside a wedge the joints of its bank are moved a "
          "little.",
          Patterns::Integer(0, 99));
        prm.add_parameter("Cell size",
                          cell_size,
                          "Length of the dam's cells along the crest [m]; "
                          "rounded so that cells fill the blocks.",
                          Patterns::Double(1e-3));
        prm.add_parameter(
          "Row height",
          row_height,
          "Height of the dam's cells [m], rounded so that rows fill the "
          "height of the dam; 0: the larger of their length along the crest "
          "and the rise of the steeper bank over that length. Where a bank "
          "is steeper, cells become shorter along the crest.",
          Patterns::Double(0.));
        prm.add_parameter("Cells through thickness",
                          n_thickness,
                          "Number of cells from the downstream to the upstream "
                          "face.",
                          Patterns::Integer(1, 200));
        LiftJoints::declare(prm, lift_height);
        prm.add_parameter("Rock extent",
                          rock_extent,
                          "Extent of the rock below and on all sides of the "
                          "dam, over the height of the dam [-].",
                          Patterns::Double(1., 20.));
        prm.add_parameter("Growth",
                          growth,
                          "Size ratio of successive layers of rock away from "
                          "the dam [-].",
                          Patterns::Double(1., 2.));
        prm.add_parameter(
          "Largest rock cell",
          largest_cell,
          "Largest size of the rock's cells [m]; waves need about eight "
          "cells per wavelength, so 60 m of rock with S waves of 2000 m/s "
          "carry 4 Hz.",
          Patterns::Double(1.));
        prm.add_parameter(
          "Reservoir level",
          water_level,
          "Level of the reservoir, moved to the nearest row of cells [m "
          "above the base]; its cells are the set \"reservoir\". 0: no water.",
          Patterns::Double(0.));
        prm.add_parameter(
          "Reservoir length",
          relative_water_length,
          "Length of the reservoir from the crown upstream over the dam's "
          "height, rounded to whole cells [-]; 0: to the end of the rock.",
          Patterns::Double(0., 20.));
        for (const int bank : {0, 1})
          {
            prm.enter_subsection(wedge_section(bank));
            wedges[bank].declare(prm);
            prm.leave_subsection();
          }
        prm.enter_subsection("Custom shape");
        custom_shape.declare(prm);
        prm.leave_subsection();
      }

      void
      check() const override
      {
        if (water_level > shape().height)
          {
            std::ostringstream text;
            text << "\"Reservoir level\" in section \"Mesh/arch dam\" is "
                 << water_level << " m, but the dam is only " << shape().height
                 << " m high; choose a lower level.";
            throw UserError(text.str());
          }
        if (water_level > 0. && relative_water_length > rock_extent)
          throw UserError("\"Reservoir length\" in section \"Mesh/arch dam\" "
                          "is more than the \"Rock extent\"; shorten the "
                          "reservoir or add rock.");
      }

      CoarseMesh
      generate() const override;

      std::string
      describe(const CoarseMesh &mesh) const override;

    private:
      ArchDamShape
      shape() const
      {
        return shape_name == "custom" ?
                 custom_shape.checked("Mesh/arch dam/Custom shape") :
                 ArchDamShape::preset(shape_name);
      }

      unsigned int
      columns_per_block(const ArchDamSections &sections) const;

      /** Rise of the contour over one of so many columns [m]. */
      static double
      largest_rise(const ArchDamSections &sections,
                   const unsigned int     n_columns);

      /** Sets the chart with the true surfaces of the dam and its canyon. */
      void
      add_surfaces(const std::shared_ptr<const ArchDamSections> &sections,
                   const std::shared_ptr<const ArchDamSweep>    &sweep,
                   CoarseMesh::Chart                            &chart) const;

      /** Refuses meshes with many more cells than fit into memory. */
      void
      check_cells(const ArchDamSections &sections, const double height) const;

      /** Dimensions of a wedge beside the given ones, and its volume. */
      std::string
      describe_wedge(const AbutmentWedge       &wedge,
                     const ArchDamSweep        &sweep,
                     const ArchDamCrossSection &section,
                     const CoarseMesh          &mesh) const;

      /** The wedges of the case; lines of the section are straightened for
       *  them. */
      std::vector<AbutmentWedge>
      make_wedges(const ArchDamSweep        &sweep,
                  const ArchDamCrossSection &section) const;

      static std::string
      wedge_section(const int bank)
      {
        return bank == 0 ? "Right wedge" : "Left wedge";
      }

      std::string  shape_name            = "Baihetan-like";
      unsigned int n_joints              = 9;
      double       cell_size             = 16.;
      double       row_height            = 0.;
      unsigned int n_thickness           = 2;
      double       lift_height           = 0.;
      double       rock_extent           = 2.;
      double       growth                = 1.4;
      double       largest_cell          = 60.;
      double       water_level           = 0.;
      double       relative_water_length = 0.;
      ArchDamShape custom_shape;

      std::array<AbutmentWedgeParameters, 2> wedges; // right and left bank
    };


    std::vector<AbutmentWedge>
    ArchDam::make_wedges(const ArchDamSweep        &sweep,
                         const ArchDamCrossSection &section) const
    {
      const AbutmentWedge::Layers layers{sweep.first_in_dam,
                                         sweep.first_in_dam + n_thickness,
                                         sweep.n_layers,
                                         [&](const double length) {
                                           return sweep.layers_along(length);
                                         }};
      std::vector<AbutmentWedge>  result;
      for (const unsigned int bank : {0, 1})
        if (wedges[bank].elevation > 0.)
          result.emplace_back(wedges[bank],
                              bank,
                              layers,
                              section,
                              "Mesh/arch dam/" + wedge_section(bank));
      return result;
    }


    std::string
    ArchDam::describe_wedge(const AbutmentWedge       &wedge,
                            const ArchDamSweep        &sweep,
                            const ArchDamCrossSection &section,
                            const CoarseMesh          &mesh) const
    {
      const AbutmentWedgeParameters &wanted = wedges[wedge.bank];
      double                         volume = 0.;
      for (const unsigned int cell : mesh.cell_sets.at(wedge.name()))
        volume += cell_volume(mesh, cell);
      std::ostringstream text;
      text << std::setprecision(4) << wedge_section(wedge.bank) << ": "
           << section.ledges[wedge.bank].laid << " m into the bank ("
           << wanted.width << " m asked for), "
           << sweep.length_downstream(wedge.layers_before_dam(),
                                      section.middle_line(wedge.bank).foot,
                                      wanted.elevation)
           << " m downstream of the dam (" << wanted.length
           << " m asked for), volume " << volume << " m3";
      return text.str();
    }


    unsigned int
    ArchDam::columns_per_block(const ArchDamSections &sections) const
    {
      // columns and rows are halved in the cross-section
      const double crest    = sections.left_end - sections.right_end;
      double       columns  = std::max(least_columns, crest / (2. * cell_size));
      const auto   in_block = [&] {
        // larger numbers are refused later
        return std::clamp(std::round(columns / (n_joints + 1.)), 1., 1e9);
      };
      constexpr double many = 1e5;
      while (row_height > 0. && columns < many)
        {
          columns           = in_block() * (n_joints + 1.);
          const double rise = largest_rise(sections, columns);
          if (rise <= 2. * row_height)
            break;
          columns = std::max(columns + n_joints + 1.,
                             0.9 * columns * rise / (2. * row_height));
        }
      return in_block();
    }


    double
    ArchDam::largest_rise(const ArchDamSections &sections,
                          const unsigned int     n_columns)
    {
      const double crest  = sections.left_end - sections.right_end;
      const auto   height = [&](const unsigned int column) {
        return sections.contour(sections.right_end +
                                column * crest / n_columns);
      };
      double rise = 0.;
      for (unsigned int i = 0; i < n_columns; ++i)
        rise = std::max(rise, std::abs(height(i + 1) - height(i)));
      return rise;
    }


    // By default rows of the section's grid are as high as the columns are
    // wide, or as high as the steeper bank rises over one column.
    void
    ArchDam::check_cells(const ArchDamSections &sections,
                         const double           height) const
    {
      const double crest     = sections.left_end - sections.right_end;
      const double n_columns = (n_joints + 1.) * columns_per_block(sections);
      constexpr unsigned int n_samples = 100;
      const double           slope =
        std::max(1., largest_rise(sections, n_samples) * n_samples / crest);
      const double n_rows = row_height > 0. ?
                              height / (2. * row_height) :
                              n_columns * height / (slope * crest);
      const double n_layers =
        n_thickness +
        2. *
          graded_points(rock_extent * height, cell_size, growth, largest_cell)
            .size();
      // half of the section is air
      check_size(0.5 * 4. * n_columns * n_rows * n_layers,
                 1,
                 "Section \"Mesh/arch dam\"");
    }


    CoarseMesh
    ArchDam::generate() const
    {
      const ArchDamShape shape    = this->shape();
      const auto         sections = std::make_shared<ArchDamSections>(shape);
      check_cells(*sections, shape.height);
      std::array<ArchDamCrossSection::Ledge, 2> ledges;
      for (const unsigned int bank : {0, 1})
        {
          ledges[bank]       = wedges[bank].ledge(bank);
          ledges[bank].place = "Mesh/arch dam/" + wedge_section(bank);
        }
      const RockGrading         rock{rock_extent, growth, largest_cell};
      const ArchDamCrossSection section(*sections,
                                        shape.height,
                                        n_joints + 1,
                                        columns_per_block(*sections),
                                        2. * row_height,
                                        rock,
                                        water_level,
                                        ledges);
      const auto                sweep = std::make_shared<ArchDamSweep>(
        section, *sections, shape.height, rock, n_thickness, cell_size);
      const unsigned int water_end =
        relative_water_length > 0. ?
          sweep->first_in_dam + n_thickness +
            sweep->layers_along(relative_water_length * shape.height) :
          sweep->n_layers;
      const std::vector<AbutmentWedge> wedges = make_wedges(*sweep, section);

      const LiftJoints   lift_joints(lift_height, section.elevations());
      CoarseMesh         mesh = make_arch_dam_mesh(section,
                                           *sweep,
                                           wedges,
                                           columns_per_block(*sections),
                                           lift_joints,
                                           water_end);
      std::ostringstream cells;
      cells << std::setprecision(3)
            << "Cells of the dam: " << section.height_and_length().second
            << " m along the crest, " << section.height_and_length().first
            << " m high";
      mesh.remarks.push_back(cells.str());
      lift_joints.add_remark(mesh);
      for (const AbutmentWedge &wedge : wedges)
        mesh.remarks.push_back(describe_wedge(wedge, *sweep, section, mesh));
      add_surfaces(sections, sweep, mesh.chart);
      return mesh;
    }


    void
    ArchDam::add_surfaces(
      const std::shared_ptr<const ArchDamSections> &sections,
      const std::shared_ptr<const ArchDamSweep>    &sweep,
      CoarseMesh::Chart                            &chart) const
    {
      // the sweep refers to the sections
      chart.positions = [sections,
                         sweep](const CoarseMesh::Chart::Points &coordinates) {
        return sweep->positions(coordinates);
      };
      // the dam's faces, joints and ends of the rock are planes of the chart,
      // the bases of wedges are planes in space
      chart.surfaces[0].onto = [sections](const Point<3> &at) {
        return Point<3>(at[0], at[1], sections->contour(at[0]));
      };
      chart.surfaces[1].onto = [sections, sweep](const Point<3> &at) {
        return sweep->onto_ledge(at);
      };
      chart.onto_edge = [sections, sweep](const Point<3> &at) {
        return sweep->onto_foot(at);
      };
    }


    std::string
    ArchDam::describe(const CoarseMesh &mesh) const
    {
      const ArchDamShape shape        = this->shape();
      const auto         length_along = [&](const double z) {
        const double left  = shape.half_width(1., z),
                     right = shape.half_width(-1., z);
        return shape.arc_length(left, z) - shape.arc_length(-right, z);
      };
      double volume = 0., middle_area = 0.;
      for (const unsigned int cell : mesh.cell_sets.at("dam"))
        volume += cell_volume(mesh, cell);
      const QMidpoint<1> midpoint;
      const QIterated<1> over_height(midpoint, 200);
      for (unsigned int q = 0; q < over_height.size(); ++q)
        middle_area += over_height.weight(q) * shape.height *
                       length_along(over_height.point(q)[0] * shape.height);

      std::ostringstream text;
      text << std::setprecision(4) << "Dam: " << shape.height
           << " m high, crest " << length_along(shape.height)
           << " m long; at the crown " << shape.crown_thickness(shape.height)
           << " to " << shape.crown_thickness(0.) << " m thick; volume "
           << volume << " m3; slenderness " << std::setprecision(3)
           << middle_area * middle_area / (volume * shape.height)
           << " (Lombardi: area of the middle surface, " << middle_area
           << " m2, squared, over volume and height)\n";
      return text.str();
    }

    const Registry<MeshGenerator>::Add<ArchDam>
      registered_arch_dam("arch dam", "An arch dam in its canyon.");
  } // namespace
} // namespace Voussoir
