#ifndef voussoir_output_point_recorder_h
#define voussoir_output_point_recorder_h

#include <voussoir/fem/point_weights.h>
#include <voussoir/output/observer.h>

#include <deque>

namespace Voussoir
{
  /** Displacement, velocity, acceleration of a point, and the mean of the
   *  acceleration over the window before [m, m/s, m/s2]. */
  using PointMotion = std::array<dealii::Tensor<1, 3>, 4>;

  /**
   * Common part of observers of points: the entries that name the points, and
   * one of them as a reference, and the record of their absolute motion.
   * Velocity and acceleration of a step need the half steps before and after
   * it, so they are recorded one step later.
   */
  class PointRecorder
  {
  public:
    /**
     * @param section         of the parameter file
     * @param reference_entry name of the entry that names the reference
     */
    PointRecorder(const std::string &section,
                  const std::string &reference_entry);

    /** Adds the entries "Points" and that of the reference. */
    void
    declare_parameters(dealii::ParameterHandler &prm,
                       const std::string        &help_of_reference);

    /** Refuses points outside the mesh and a reference that is not among the
     *  points.
     *  @return number of points */
    std::size_t
    check(const ObservedModel &model) const;

    /**
     * Starts a new record.
     *
     * @param interval between two records [s]; 0: of each step
     * @param window   of the mean acceleration [s]
     */
    void
    prepare(const ObservedRun &run,
            const double       interval,
            const double       window = 0.);

    /** The velocities of the window for a checkpoint; all ranks must call this
     *  together. */
    nlohmann::json
    save() const;

    void
    load(const nlohmann::json &saved);

    /** The points in the order of the entry. */
    const std::vector<NamedPoint> &
    points() const;

    /** Number of the reference point; -1 for none. */
    int
    reference() const;

    /** Displacements of the points, on all ranks, which must call this
     *  together. */
    std::vector<dealii::Tensor<1, 3>>
    displacement(const Vector &displacement) const;

    /** To be called for the initial state and after each step. */
    void
    observe(const State &state);

    /** Number of lines recorded since the last call of `take`. */
    std::size_t
    n_waiting() const;

    struct Line
    {
      unsigned long long       step;
      double                   time;   // [s]
      std::vector<PointMotion> points; // absolute
    };

    /** The lines recorded since the last call, on all ranks, which must call
     *  this together. */
    std::vector<Line>
    take();

  private:
    /** The points as the entries have them, and the number of the reference. */
    std::pair<std::vector<NamedPoint>, int>
    parse() const;

    const std::string place, reference_entry, reference_place;
    std::string       points_text, reference_name;

    /** A record from its beginning. */
    struct Record
    {
      std::unique_ptr<const ObservedRun>  run;
      std::unique_ptr<const PointWeights> weights;
      Schedule                            schedule;
      std::vector<NamedPoint>             points;
      int                                 reference = -1; // none

      bool                              has_last = false;
      std::vector<dealii::Tensor<1, 3>> last_displacement;
      std::vector<double>               shares;
      std::vector<unsigned long long>   steps;

      // of the half steps of the window and the one before, the latest last;
      // at rest before the first
      std::size_t                                   window = 1; // [steps]
      std::deque<std::vector<dealii::Tensor<1, 3>>> velocities;
    };
    Record record;
  };
} // namespace Voussoir

#endif
