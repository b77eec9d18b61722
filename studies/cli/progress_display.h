#pragma once

#include <chrono>
#include <string>

#include "capstan/placement/study_run.h"

namespace capstan::cli {

enum class ProgressMode { automatic, json, none };

ProgressMode progress_mode(const std::string& name);  ///< of --progress

/// Shows on standard error how far a study is: a bar with the time left on a terminal, a line now and then
/// elsewhere, or one JSON object a line.
class ProgressDisplay {
  public:
    ProgressDisplay(ProgressMode mode, std::string study);

    void show(const StudyProgress& progress);
    /// Ends the bar's line, so that messages begin on their own.
    void end_line();
    ProgressMode mode() const { return mode_; }

  private:
    using Clock = std::chrono::steady_clock;

    double seconds_left(const StudyProgress& progress, double elapsed_s) const;
    void show_bar(const StudyProgress& progress, double left_s);
    void show_line(const StudyProgress& progress, double left_s);
    void show_json(const StudyProgress& progress, double elapsed_s, double left_s) const;

    ProgressMode mode_;
    std::string study_;
    bool is_terminal_;
    bool line_is_open_ = false;
    Clock::time_point start_;
    Clock::time_point last_shown_;
    int units_at_start_ = -1;  ///< stored before this run; -1: not known yet
};

}  // namespace capstan::cli
