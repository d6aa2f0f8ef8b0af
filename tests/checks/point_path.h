#ifndef voussoir_tests_point_path_h
#define voussoir_tests_point_path_h

#include <voussoir/materials/point_test.h>

#include <functional>

#include "check.h"

namespace Voussoir
{
  /** A check of the first material of a case, at points by itself. */
  class MaterialCheck : public Check
  {
  public:
    void
    run(const ParameterFile &file, Verdicts &verdicts, const MPI_Comm) override
    {
      const auto parameters = make_case(file);
      evaluate(*parameters->material_list().at(0), verdicts);
    }

  private:
    virtual void
    evaluate(const Material &material, Verdicts &verdicts) const = 0;
  };

  /** Given components of xx, yy, zz. */
  using NormalControls = std::array<PointTest::Control, 3>;

  /** Proceeds to strains or stresses in equal steps, without shear stress; @p
   *  callback is called after each. */
  inline void
  advance(
    PointTest                   &test,
    const NormalControls        &target,
    const unsigned int           steps,
    const std::function<void()> &callback = [] {})
  {
    const auto strain = test.strain, stress = test.stress;
    for (unsigned int i = 1; i <= steps; ++i)
      {
        const double        share = double(i) / steps;
        PointTest::Controls controls;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double start =
              target[d].is_strain ? strain[d][d] : stress[d][d];
            controls[d] = {target[d].is_strain,
                           start + share * (target[d].value - start)};
          }
        test.advance(controls);
        callback();
      }
  }

  /** Calls @p callback with a point in cells of several sizes [m], and a text
   *  with the size. */
  inline void
  for_each_cell_size(
    const Material                                        &material,
    const std::function<void(PointTest &,
                             const double       size,
                             const std::string &in_cell)> &callback)
  {
    for (const double size : {0.25, 0.5, 1., 2.})
      {
        PointTest          test(material, size, 1e-3);
        std::ostringstream in_cell;
        in_cell << " in a cell of " << size << " m";
        callback(test, size, in_cell.str());
      }
  }
} // namespace Voussoir

#endif
