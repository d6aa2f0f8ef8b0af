#ifndef voussoir_output_area_above_h
#define voussoir_output_area_above_h

#include <voussoir/output/face_mesh.h>

namespace Voussoir
{
  /** Areas of faces on which a quantity, linear between the nodes as pictures
   *  show it, exceeds certain levels. */
  class AreaAbove
  {
  public:
    /** @param levels increasing */
    AreaAbove(const FaceMesh &mesh, const std::vector<double> &levels);

    /** Adds the area of this rank to @p sums, one for each set and level
     *  [m2]. */
    void
    add(const std::vector<double> &value_of_node, double *sums) const;

    /** Area of this rank in each set [m2]. */
    std::vector<double>
    total(const unsigned int n_sets) const;

  private:
    double
    part_above(const unsigned int           quadrilateral,
               const std::array<double, 4> &values,
               const double                 middle,
               const double                 level) const;

    // around the quadrilateral
    static constexpr std::array<std::array<unsigned int, 2>, 4> edges{
      {{{0, 1}}, {{1, 3}}, {{3, 2}}, {{2, 0}}}};

    std::vector<FaceMesh::Quadrilateral> quadrilaterals;
    std::vector<double>                  levels;

    // of the four triangles between the edges and the middle, and their sum
    // [m2]
    std::vector<std::array<double, 4>> areas;
    std::vector<double>                whole_areas;
  };
} // namespace Voussoir

#endif
