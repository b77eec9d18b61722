#include "capstan/cli/progress_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace capstan::cli {

namespace {

constexpr std::chrono::milliseconds bar_interval{100};
constexpr std::chrono::seconds line_interval{5};

std::string time_words(double seconds) {
    const long whole = std::lround(std::ceil(seconds));
    if (whole < 90) return fmt::format("{} s", whole);
    if (whole < 5400) return fmt::format("{} min", (whole + 30) / 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace

ProgressMode progress_mode(const std::string& name) {
    if (name == "json") return ProgressMode::json;
    return name == "none" ? ProgressMode::none : ProgressMode::automatic;
}

ProgressDisplay::ProgressDisplay(ProgressMode mode, std::string study)
    : mode_(mode),
      study_(std::move(study)),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(Clock::now()) {}

void ProgressDisplay::show(const StudyProgress& progress) {
    const auto now = Clock::now();
    const bool first = units_at_start_ < 0;
    if (first) units_at_start_ = progress.units_done;
    const bool last = progress.units_done == progress.units;
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    const double left_s = seconds_left(progress, elapsed_s);
    if (mode_ == ProgressMode::none) return;
    if (mode_ == ProgressMode::json) return show_json(progress, elapsed_s, left_s);
    const auto interval = is_terminal_ ? std::chrono::duration_cast<Clock::duration>(bar_interval)
                                       : std::chrono::duration_cast<Clock::duration>(line_interval);
    if (!first && !last && now - last_shown_ < interval) return;
    last_shown_ = now;
    is_terminal_ ? show_bar(progress, left_s) : show_line(progress, left_s);
}

void ProgressDisplay::end_line() {
    if (line_is_open_) std::fputc('\n', stderr);
    line_is_open_ = false;
}

// As long per unit as so far in this run; negative: not known yet.
double ProgressDisplay::seconds_left(const StudyProgress& progress, double elapsed_s) const {
    const int done_here = progress.units_done - units_at_start_;
    if (progress.units_done == progress.units) return 0.0;
    return done_here == 0 ? -1.0 : elapsed_s / done_here * (progress.units - progress.units_done);
}

void ProgressDisplay::show_bar(const StudyProgress& progress, double left_s) {
    constexpr int width = 30;
    const int full = progress.units == 0 ? width : width * progress.units_done / progress.units;
    const std::string left = left_s > 0.0 ? ", about " + time_words(left_s) + " left" : "";
    fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {}/{} units{}\x1b[K", study_, "", full, "", width - full,
               progress.units_done, progress.units, left);
    std::fflush(stderr);
    line_is_open_ = true;
}

void ProgressDisplay::show_line(const StudyProgress& progress, double left_s) {
    const std::string left = left_s > 0.0 ? ", about " + time_words(left_s) + " left" : "";
    fmt::print(stderr, "{}: {} of {} units{}\n", study_, progress.units_done, progress.units, left);
}

void ProgressDisplay::show_json(const StudyProgress& progress, double elapsed_s, double left_s) const {
    nlohmann::ordered_json event = {{"event", "progress"},
                                    {"study", study_},
                                    {"units_done", progress.units_done},
                                    {"units", progress.units},
                                    {"elapsed_s", elapsed_s}};
    event["left_s"] = left_s < 0.0 ? nlohmann::ordered_json() : nlohmann::ordered_json(left_s);
    fmt::print(stderr, "{}\n", event.dump());
}

}  // namespace capstan::cli
