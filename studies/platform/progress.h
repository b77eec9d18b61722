#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace capstan {

/// How far a piece of work is.
struct ProgressEvent {
    std::string activity;   ///< what is being done, as "study quick" or "fitting viscous friction"
    double fraction = 0.0;  ///< of the work that is done
    int done = 0;           ///< the same as a count of `items`
    int total = 0;          ///< 0: the work cannot be counted
    std::string items{};    ///< "units", "cases"
    std::optional<double> seconds_left{};
    std::optional<double> max_seconds_left{};  ///< where the time left is known as a range
    bool is_steady = true;                     ///< the time left may be told from the time taken so far

    bool operator==(const ProgressEvent&) const = default;
};

ProgressEvent counted_progress(std::string activity, int done, int total, std::string items);

/// {"event":"progress","activity":...,"fraction":...,"done":...,"total":...,"items":...,"seconds_left":...},
/// one line. What is not known is null; "max_seconds_left" is there where the time left is a range.
std::string progress_json(const ProgressEvent& event);

/// The event in a line of such JSON; nothing if the line is anything else.
std::optional<ProgressEvent> read_progress_json(const std::string& line);

/// "12 s", "3 min", "2 h 5 min", rounded up to seconds.
std::string duration_words(double seconds);

/// "3 s to 2 min"; "at most 2 min" from nothing on.
std::string duration_range_words(double min_seconds, double max_seconds);

/// "4 of 40 units, about 3 s left", or "10%, about 3 s to 2 min left".
std::string progress_words(const ProgressEvent& event);

enum class ProgressMode { automatic, json, none };

ProgressMode progress_mode(const std::string& name);  ///< of the option --progress

/// Shows progress on standard error: a bar on a terminal, a line every few seconds elsewhere, or JSON. The
/// time left follows from the time taken so far, where the event does not give it and the work is steady.
class ProgressDisplay {
  public:
    /// Work that takes less than `quiet_for` shows nothing, but as JSON.
    explicit ProgressDisplay(ProgressMode mode, std::chrono::milliseconds quiet_for = {});
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void show(ProgressEvent event);
    /// Ends the line of the bar, so that a message begins on a line of its own.
    void end_line();
    ProgressMode mode() const { return mode_; }

  private:
    using Clock = std::chrono::steady_clock;

    ProgressMode mode_;
    std::chrono::milliseconds quiet_for_;
    bool is_terminal_;
    bool line_is_open_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point start_;  ///< of the first event, or of the last one that went back
    Clock::time_point last_shown_;
    double fraction_at_start_ = 0.0;
    double last_fraction_ = 2.0;  ///< above 1: nothing shown yet
};

}  // namespace capstan
