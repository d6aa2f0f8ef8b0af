#ifndef voussoir_output_picture_series_h
#define voussoir_output_picture_series_h

#include <voussoir/output/observer.h>

namespace Voussoir
{
  /** Times of the pictures of an observer, and their list for ParaView. */
  class PictureSeries
  {
  public:
    /**
     * @param name    of the folder of the pictures and of the list
     * @param section of the parameter file
     */
    PictureSeries(const std::string &name, const std::string &section);

    /** Adds the entries "Interval" and "Times". */
    void
    declare_parameters(dealii::ParameterHandler &prm);

    /** Reports times after the end of the run. */
    void
    check(const ObservedModel &model) const;

    /** Begins a new list; a run that continues keeps the pictures of the
     *  interrupted run. */
    void
    prepare(const ObservedRun &run);

    bool
    due(const State &state) const;

    /** Name for the picture of this state, without extension. */
    std::string
    next_name(const State &state) const;

    /** Adds a picture to the list, unless the name of its file is empty. */
    void
    add(const double time, const std::string &file);

    std::size_t
    size() const;

  private:
    const std::string   name, section;
    double              interval = 0.;
    std::vector<double> times;

    std::string                                 folder;
    double                                      time_step = 1.;
    Log                                        *log       = nullptr;
    std::vector<std::pair<double, std::string>> pictures;
    std::shared_ptr<GrowingFile> list; // of them, to continue from
  };
} // namespace Voussoir

#endif
