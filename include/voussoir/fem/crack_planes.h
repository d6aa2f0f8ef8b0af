#ifndef voussoir_fem_crack_planes_h
#define voussoir_fem_crack_planes_h

#include <voussoir/fem/internal_force.h>
#include <voussoir/fem/state.h>

namespace Voussoir
{
  /**
   * Cracks that go on as planes from cell to cell, in trilinear cells with one
   * point. A crack band alone follows the rows of cells, and locks where it
   * steps from one row to the next.
   *
   * - A cell that cracks has a plane, which enters the neighbours whose common
   *   face it cuts, through the middle of the cut. Its normal there is the mean
   *   of its own normal and of the principal direction of the tensile part of
   *   the elastic stress around the cell, and is found anew until the cell
   *   cracks. A first crack begins in the centre of its cell, and keeps the
   *   normal and the band that it has in the law.
   * - With the sum g of the mean gradients of the corners beyond the plane, of
   *   normal n, the law has a crack with the fixed normal g/|g| in a band of
   *   the width l = 1/(g . n), at most 3 h. If these corners part by a jump w
   *   the mean strain is sym(w g), an open crack without stress, and V g . n of
   *   the cells of a straight crack sum up to its area.
   * - A cell of size h that a plane enters has the strength at the tip of a
   *   crack in a cell of the size h (l/h)^1.5.
   * - Other cells whose centre is within 1.6 h of a cracked cell have twice the
   *   strength of the material, so that the band stays one cell wide.
   * - The stabilisation is released: by a tenth at each update ahead of a
   *   crack, down to 1/200, and in first cracks, down to their stiffness, both
   *   at once in the static state; in other cracks with their stiffness. The
   *   energy that it has stored is lost to the crack. In the earthquake, where
   *   a crack is pressed together, and ahead of a crack where the pressure on
   *   the plane exceeds the tensile strength, the released share acts again on
   *   what the cell bends from then on: in a crack with stresses up to the
   *   pressure, beyond which its faces part at one side. What is lost in this
   *   counts as lost by closing.
   *
   * doc/damage.md has the trials behind these rules. Cracks do not propagate
   * across joints, whose two sides are no neighbours in the mesh. All that
   * changes with time is in the PointHistory.
   */
  class CrackPlanes
  {
  public:
    /** @param kernels of each material
     *  @param at_rest whether they are those of the static state
     *  Arguments must live as long as this. */
    CrackPlanes(const Discretization                  &discretization,
                const std::vector<const CellKernel *> &kernels,
                const InternalForce                   &internal_force,
                const Damping                         &damping,
                const bool                             at_rest = false);

    /** After every fourth step, of this length [s]: finds new cracks, extends
     *  them, and releases stabilisation. */
    void
    update(const double time_step, State &state);

    /** The same at once; returns whether an own cell has a new plane or less
     *  stabilisation. Called on all ranks. */
    bool
    find(const double time_step, State &state);

  private:
    using Cell = Discretization::Cell;

    struct Plane
    {
      dealii::Point<3>     point;
      dealii::Tensor<1, 3> normal;
    };

    struct Crack
    {
      Cell  cell;
      Plane plane;
    };

    /** Own cells that need an update. */
    struct Found
    {
      std::vector<Cell> first;     // have cracked without a plane
      std::vector<Cell> next;      // have cracked in the plane of another crack
      std::vector<Cell> tips;      // have a plane and have not cracked
      std::vector<Cell> releasing; // stabilisation
      std::vector<Cell> switching; // whether the released share acts again
      std::vector<Cell> bearing;   // closed, where this share acts

      bool
      changes() const
      {
        return !releasing.empty() || !switching.empty() || !bearing.empty();
      }
    };

    /** Tension around a cell and in it. */
    struct Tension
    {
      dealii::Tensor<1, 3>          direction; // zero where there is none
      dealii::SymmetricTensor<2, 3> own;       // stress [Pa]
    };

    /** A cell and the cells that share a vertex with it, in an order that does
     *  not depend on the partition. */
    struct Surroundings
    {
      std::vector<Cell>                   cells;
      std::array<dealii::Tensor<1, 3>, 8> gradients; // means of grad N_a [1/m]
    };

    bool
    follows_planes(const Cell &cell) const;

    PointHistory &
    history_of(const Cell &cell, MaterialMemory &memory) const;

    bool
    is_cracked(const Cell &cell, MaterialMemory &memory) const;

    /** Share of the stabilisation that a cell with a plane should have, if it
     *  is so far below the present one that an update is worth it; else the
     *  present one. */
    double
    stabilisation_due(const Cell &cell, MaterialMemory &memory) const;

    /** Whether a crack is pressed together. */
    bool
    is_pressed(const Cell &cell, MaterialMemory &memory) const;

    /** Adds a cell with a plane to those whose stabilisation may change.
     *  @param closes whether its crack is or should be closed */
    void
    find_change(const Cell     &cell,
                const bool      closes,
                MaterialMemory &memory,
                Found          &found) const;

    Found
    cells_to_update(MaterialMemory &memory) const;

    const Surroundings &
    around(const Cell &cell);

    /** Whether other ranks know an own cell. */
    bool
    is_shared(const Cell &cell) const;

    /** Tension around own cells.
     *  @param are_shared whether any rank may need stresses of others */
    std::vector<Tension>
    tension(const std::vector<Cell> &cells,
            const bool               are_shared,
            const Vector            &displacement,
            const MaterialMemory    &memory);

    Plane
    plane_of(const Cell &cell, MaterialMemory &memory) const;

    /** Sets the plane of an own cell, with opening and width. */
    void
    set_plane(const Cell &cell, const Plane &plane, MaterialMemory &memory);

    /** Gives an own cell whose plane is set the strength of a tip. */
    void
    set_tip_strength(const Cell &cell, MaterialMemory &memory) const;

    /** Planes of first cracks. */
    void
    begin(const std::vector<Cell> &first,
          const Vector            &displacement,
          MaterialMemory          &memory);

    /** New cracks of own cells and of ghost cells, in an order that does not
     *  depend on the partition. */
    std::vector<Crack>
    new_cracks(const Found &found, MaterialMemory &memory) const;

    /** Extends a crack into the own neighbours that its plane enters, which are
     *  added to @p tips. */
    void
    propagate(const Crack       &crack,
              MaterialMemory    &memory,
              std::vector<Cell> &tips);

    /** Strengthens the own cells beside a crack. */
    void
    strengthen(const Crack &crack, MaterialMemory &memory);

    /** Turns the planes of tips to the direction of tension, and adds tips
     *  whose stabilisation changes. */
    void
    turn(Found          &found,
         const bool      are_shared,
         const Vector   &displacement,
         MaterialMemory &memory);

    /** Changes the stabilisation of cells, and adds the energy lost. */
    void
    change_stabilisation(const Found &found,
                         const double time_step,
                         State       &state) const;

    const Discretization           &discretization;
    std::vector<const CellKernel *> kernels;
    const InternalForce            &internal_force;
    const Damping                  &damping;
    const bool                      at_rest;

    // of each vertex of cells that can have planes: cells of this rank and its
    // ghost cells
    std::vector<std::vector<Cell>> at_vertex;
    std::vector<bool>              shared_vertices; // with ghost cells
    std::map<Cell, Surroundings>   surroundings;    // as far as needed
  };
} // namespace Voussoir

#endif
