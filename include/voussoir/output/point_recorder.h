#ifndef voussoir_output_point_recorder_h
#define voussoir_output_point_recorder_h

#include <voussoir/fem/point_weights.h>
#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** Number of the point of this name; -1 for no name. @p place says where it
   *  was read, for the message when there is no such point. */
  int
  find_point(const std::string             &name,
             const std::vector<NamedPoint> &points,
             const std::string             &place);

  /** Displacement, velocity and acceleration of a point [m, m/s, m/s2]. */
  using PointMotion = std::array<dealii::Tensor<1, 3>, 3>;

  /**
   * Records the absolute motion of points. Velocity and acceleration of a step
   * need the half steps before and after it, so they come one step late.
   */
  class PointRecorder
  {
  public:
    /** Refuses points outside the mesh; @p place names the entry. */
    PointRecorder(const ObservedModel           &model,
                  const std::vector<NamedPoint> &points,
                  const std::string             &place,
                  const double                   interval);

    /** To be called after each step. */
    void
    observe(const State &state);

    /** Lines recorded and not taken yet. */
    std::size_t
    n_waiting() const;

    struct Line
    {
      double                   time; // [s]
      std::vector<PointMotion> points;
    };

    /** The lines recorded since the last call, on all ranks, which must call
     *  this together. */
    std::vector<Line>
    take();

  private:
    const ObservedModel model;
    const unsigned int  n_points;
    const PointWeights  values;
    const Schedule      schedule;

    bool                              has_last = false;
    std::vector<dealii::Tensor<1, 3>> last_displacement, last_velocity;
    std::vector<double>               shares, times;
  };
} // namespace Voussoir

#endif
