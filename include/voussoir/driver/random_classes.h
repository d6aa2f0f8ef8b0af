#ifndef voussoir_driver_random_classes_h
#define voussoir_driver_random_classes_h

#include <voussoir/base/parameter_file.h>
#include <voussoir/materials/random_field.h>
#include <voussoir/mesh/coarse_mesh.h>

#include <map>

namespace Voussoir
{
  /** A file in which each material with a random field is replaced by its
   *  classes, "concrete 1" and so on, with their own moduli and strengths,
   *  which the rest of the program treats like any other materials. */
  ParameterFile
  with_random_classes(const ParameterFile &file);

  /** The same file with uniform materials, in which a study finds the entries
   *  of a material that it changes. */
  ParameterFile
  without_random_fields(const ParameterFile &file);

  /** The cells of a coarse mesh that belong to the class of a material. */
  class RandomClasses
  {
  public:
    /** @param mesh must live as long as this */
    explicit RandomClasses(const CoarseMesh &mesh);

    bool
    holds(const RandomFieldParameters &parameters, const unsigned int cell);

  private:
    const CoarseMesh &mesh;

    /** Values of a field by cell: the classes of a material share them. */
    struct Values
    {
      RandomField                    field;
      std::map<unsigned int, double> of_cell;
    };

    // by seed and correlation lengths
    std::map<std::pair<unsigned int, std::vector<double>>, Values> fields;
  };
} // namespace Voussoir

#endif
