#ifndef voussoir_driver_study_h
#define voussoir_driver_study_h

#include <voussoir/base/error.h>
#include <voussoir/driver/result_folder.h>
#include <voussoir/driver/run_summary.h>
#include <voussoir/driver/sensitivity.h>
#include <voussoir/driver/study_parameters.h>

#include <deal.II/lac/vector.h>

namespace Voussoir
{
  /** Exit code of a study in which some runs reached their end, and others were
   *  stopped or failed. */
  constexpr int exit_code_incomplete = 2;

  /** A study that ends with exit_code_incomplete. */
  class IncompleteStudy : public UserError
  {
  public:
    using UserError::UserError;
  };

  /**
   * Many runs of one parameter file: with some entries varied, to find the
   * value of an entry at which a criterion is met, to fit entries to measured
   * numbers, or with each number moved by a small share. Each run has a folder
   * in that of the study; a study that is started again does only the missing
   * runs.
   */
  class Study
  {
  public:
    /** Throws UserError for a mistake in any run, before the first one. */
    Study(const ParameterFile &file,
          const RunOptions    &options,
          const MPI_Comm       communicator);

    ~Study();

    /** All runs, then study.csv and study.json. A run that fails is reported,
     *  and the others continue; at the end throws IncompleteStudy, or UserError
     *  if no run reached its end. Throws UserError, too, if another study is in
     *  progress in the folder. */
    void
    run();

    /** Parameter files of the runs; of a search for a limit those of both ends
     *  of the bracket. */
    std::vector<ParameterFile>
    planned_runs() const;

  private:
    /** A run that is finished or failed. */
    struct Outcome
    {
      Outcome(const StudyValues &values,
              const std::string &folder,
              const RunSummary  &summary);

      StudyValues    values;
      std::string    folder;
      RunSummary     summary;
      nlohmann::json numbers; // of the summary, by their paths
    };

    /** Result of a search: the criterion is met at `meets`, not at
     *  `fails`. */
    struct Limit
    {
      StudyValues values;
      double      fails = 0., meets = 0.;
    };

    /** One run with the values of the file, and one for each moved number that
     *  the program does not refuse. */
    void
    plan_moves(const Case &whole);

    /** This file with the values of a run and without the study. */
    ParameterFile
    file_of(const StudyValues &values) const;

    std::string
    folder_of(const StudyValues &values) const;

    /** The values of a run as tables and messages have them. */
    StudyValues
    shown(const StudyValues &values) const;

    /** Reports the number of runs, and what is left out. */
    void
    introduce() const;

    /** Makes the folder and claims it for this study. */
    void
    claim_folder();

    /** Reports how many runs reached their end, and throws if not all did. */
    void
    conclude() const;

    /** Does a run, or reads its results if they exist. */
    const Outcome &
    outcome_of(const StudyValues &values);

    /** @param may_go_on whether from a checkpoint in the folder */
    RunSummary
    do_run(const Case        &parameters,
           const std::string &folder,
           const bool         may_go_on) const;

    /** Whether the criterion is met in the run with this value. */
    bool
    is_met(StudyValues values, const double value);

    void
    seek_limit(const StudyValues &values);

    /** A combination, with the fitted entries moved from their values in the
     *  file. */
    StudyValues
    fitted_values(StudyValues                   values,
                  const dealii::Vector<double> &logarithms) const;

    /** Logarithms of computed over measured numbers in a run. */
    dealii::Vector<double>
    misfit(const StudyValues &values);

    /** Finds the values of the fitted entries that fit the measured numbers
     *  best. */
    void
    calibrate(const StudyValues &values);

    void
    report(const std::string &text) const;

    /** Collects the outcomes of all groups on each rank. */
    void
    gather();

    /** Writes study.csv, study.json and the tables of the evaluations. */
    void
    write_tables() const;

    std::string
    table() const;

    std::string
    statistics() const;

    /** Lines of a table, each with the same columns. */
    using Table = std::vector<nlohmann::ordered_json>;

    Table
    convergence() const;

    Table
    fragility() const;

    Table
    sensitivities() const;

    nlohmann::json
    all_results() const;

    /** Approximate number of runs of this group in the whole study. */
    std::size_t
    n_expected() const;

    const ParameterFile file;
    const RunOptions    options;
    const MPI_Comm      communicator; // of the study
    MPI_Comm            group;        // of one run
    unsigned int        n_groups = 1, my_group = 0;
    StudyParameters     parameters;
    std::string         folder;
    FileLock            lock; // of the first rank

    /** Strengths that the strength reduction leaves, "Entry = value". */
    std::vector<std::string> strengths_kept;

    std::vector<StudyValues> combinations; // of the runs, or searches

    // numbers each of which is moved in one run, and those that are refused
    std::vector<MovedNumber> moves;
    std::vector<std::string> refused_moves;

    std::vector<Outcome> outcomes;
    std::vector<Limit>   limits;
    Table                calibrations;
    unsigned int         n_done          = 0; // runs that were computed now
    double               seconds_of_runs = 0.;
  };
} // namespace Voussoir

#endif
