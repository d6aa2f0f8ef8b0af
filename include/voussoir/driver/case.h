#ifndef voussoir_driver_case_h
#define voussoir_driver_case_h

#include <voussoir/analysis/modes.h>
#include <voussoir/analysis/static_state.h>
#include <voussoir/base/option.h>
#include <voussoir/base/parameter_file.h>
#include <voussoir/constraints/interface_parameters.h>
#include <voussoir/constraints/projection.h>
#include <voussoir/driver/acceptance.h>
#include <voussoir/driver/material_test.h>
#include <voussoir/driver/study_parameters.h>
#include <voussoir/fem/damping.h>
#include <voussoir/fem/discretization.h>
#include <voussoir/loads/boundary_parameters.h>
#include <voussoir/loads/ground_motion.h>
#include <voussoir/loads/load.h>
#include <voussoir/loads/reservoir_parameters.h>
#include <voussoir/loads/wave_field.h>
#include <voussoir/materials/material.h>
#include <voussoir/mesh_sources/generator.h>
#include <voussoir/mesh_sources/reader.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /**
   * The objects of one kind that a case names: `set Names = concrete, rock`
   * and, in a section of each name, the class of the object and the entries of
   * that class. The objects have the values of the file and do not change;
   * objects that change with a model or a run are made anew.
   */
  template <typename Base>
  class NamedObjects
  {
  public:
    using List = std::vector<std::pair<std::string, std::unique_ptr<Base>>>;

    /**
     * Declares the objects that the entry "Names" of a section lists.
     *
     * @param section       section of the list
     * @param what          noun for an object, for the description
     * @param default_class class of an object that names none
     * @param can_rest      whether an object can be inactive
     */
    void
    declare(dealii::ParameterHandler &prm,
            const ParameterFile      &file,
            const std::string        &section,
            const std::string        &what,
            const std::string        &default_class,
            const bool                can_rest);

    /** Declares an object, in the section @p place that @p prm has entered. */
    void
    declare_one(dealii::ParameterHandler &prm,
                const std::string        &name,
                const std::string        &place,
                const std::string        &class_name,
                const std::string        &place_of_class,
                const bool                active = true);

    /** Calls @p visit for each object, while the case is being read. */
    void
    for_each(
      const std::function<void(const std::string &place, Base &)> &visit);

    /** New objects with the entries of the file, free to change. */
    List
    make(const ParameterFile &file) const;

    std::vector<std::pair<std::string, const Base *>> objects;

    /** Objects with `set Active = false`; their entries are checked all the
     *  same. */
    std::vector<std::pair<std::string, const Base *>> inactive;

  private:
    struct Origin
    {
      std::string           place, class_name;
      std::unique_ptr<Base> object;
    };
    std::vector<Origin> origins, origins_of_inactive;
  };

  enum class TimeScheme
  {
    central_difference,
    paper
  };

  inline OptionNames<TimeScheme>
  option_names(const TimeScheme)
  {
    return {{TimeScheme::central_difference, "central difference"},
            {TimeScheme::paper, "paper"}};
  }


  /** The entries of the section "Time". */
  struct TimeParameters
  {
    double     end_time      = 10.;
    double     time_step     = 0.;
    double     safety_factor = 0.95;
    TimeScheme scheme        = TimeScheme::central_difference;

    void
    declare(dealii::ParameterHandler &prm);
  };

  /** The entries of the section "Output" itself. */
  struct OutputParameters
  {
    std::string folder;
    std::string observers           = "histories, envelopes, fields";
    double      energy_interval     = 0.;
    double      energy_limit        = 0.1;
    double      checkpoint_interval = 10.;
    double      checkpoint_time     = 0.;

    bool for_verdict = true;

    bool
    has_checkpoints() const
    {
      return checkpoint_interval > 0. || checkpoint_time > 0.;
    }

    void
    declare(dealii::ParameterHandler &prm);
  };

  /** All entries of a parameter file, checked as far as that is possible
   *  without the mesh. */
  class Case
  {
  public:
    /** All entries at their defaults, for the manual. */
    Case();

    /** Declares, parses and checks; @p declare_more adds sections that the
     *  caller reads. */
    explicit Case(
      const ParameterFile                                   &file,
      const std::function<void(dealii::ParameterHandler &)> &declare_more = {});

    ~Case();

    ParameterFile            file;
    dealii::ParameterHandler prm;

    std::string                    title;
    std::string                    mesh_type = "box";
    GridParameters                 grid;
    std::unique_ptr<MeshGenerator> generator; // null for an imported mesh
    MeshReader                     reader;
    InterfacesParameters           interfaces;
    DiscretizationParameters       discretization;
    NamedObjects<Material>         materials;
    NamedObjects<Load>             loads;
    ReservoirParameters            reservoir;
    StaticParameters               static_state;
    ModeParameters                 modes;
    MaterialTestParameters         material_test;
    NamedObjects<Projection>       projections;
    BoundaryParameters             boundaries;
    GroundMotion                   ground_motion;
    WaveParameters                 wave;
    DampingParameters              damping;
    TimeParameters                 time;
    AcceptanceParameters           acceptance;
    OutputParameters               output;
    StudyParameters                study;
    NamedObjects<Observer>         observers;

    /** Observers that the file does not name, but for which it gives strengths:
     *  over-stress and through cracks. An observer that does not fit the mesh
     *  is left out. */
    std::vector<std::string> added_observers;

    /** For the log: values outside their usual range, and unused sections. */
    std::vector<std::string> warnings, notes;

    /** The mesh that the case asks for, checked; a report goes to @p log. */
    CoarseMesh
    make_mesh(std::ostream &log) const;

    /**
     * Number of the material of each coarse cell; refuses unknown sets, cells
     * without material and cells with two.
     */
    std::vector<unsigned int>
    material_of_coarse_cells(const CoarseMesh &mesh) const;

    std::vector<const Material *>
    material_list() const;

    std::vector<std::string>
    material_names() const;

    /** Whether there is an earthquake, a constraint, or a load outside the
     *  static stages: without them a model stays at rest. */
    bool
    moves() const;

  private:
    void
    declare();

    /** Adds the observers that "Observers" names. */
    void
    add_observers();

    /** Reads sections of observers that "Observers" does not name, for example
     *  because "--set" leaves one out: their entries are checked, and the log
     *  notes that the section is not used. */
    void
    declare_unused_observers(const std::vector<std::string> &used);

    /** Makes the uplift of interfaces act from the first load of water on,
     *  where the file does not name a load. */
    void
    find_water_of_uplift();

    /** Refuses cases whose sums cannot be reproducible. */
    void
    check_reproducible() const;

    void
    check();
  };
} // namespace Voussoir

#endif
