#include "capstan/platform/progress.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "capstan/platform/standard_streams.h"

namespace capstan {

namespace {

constexpr std::chrono::milliseconds bar_interval{100};
constexpr std::chrono::seconds line_interval{5};

std::string bar(double fraction) {
    constexpr int width = 30;
    const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
    return "[" + std::string(static_cast<std::size_t>(full), '#') +
           std::string(static_cast<std::size_t>(width - full), '.') + "]";
}

}  // namespace

ProgressEvent counted_progress(std::string activity, int done, int total, std::string items) {
    const double fraction = total == 0 ? 1.0 : static_cast<double>(done) / total;
    return {std::move(activity), fraction, done, total, std::move(items), std::nullopt, std::nullopt, true};
}

std::string progress_json(const ProgressEvent& event) {
    using Json = nlohmann::ordered_json;
    const bool is_counted = !event.items.empty();
    Json json{{"event", "progress"},
              {"activity", event.activity},
              {"fraction", event.fraction},
              {"done", is_counted ? Json(event.done) : Json()},
              {"total", is_counted ? Json(event.total) : Json()},
              {"items", is_counted ? Json(event.items) : Json()},
              {"seconds_left", event.seconds_left ? Json(*event.seconds_left) : Json()}};
    if (event.max_seconds_left) json["max_seconds_left"] = *event.max_seconds_left;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<ProgressEvent> read_progress_json(const std::string& line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    try {
        if (json.at("event") != "progress") return std::nullopt;
        ProgressEvent event;
        event.activity = json.at("activity").get<std::string>();
        event.fraction = json.at("fraction").get<double>();
        if (!json.at("items").is_null()) {
            event.done = json.at("done").get<int>();
            event.total = json.at("total").get<int>();
            event.items = json.at("items").get<std::string>();
        }
        if (!json.at("seconds_left").is_null()) event.seconds_left = json.at("seconds_left").get<double>();
        if (json.contains("max_seconds_left"))
            event.max_seconds_left = json["max_seconds_left"].get<double>();
        return event;
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

std::string duration_words(double seconds) {
    const long rounded = std::lround(std::ceil(seconds));
    if (rounded < 90) return std::to_string(rounded) + " s";
    if (rounded < 5400) return std::to_string((rounded + 30) / 60) + " min";
    return std::to_string(rounded / 3600) + " h " + std::to_string(rounded % 3600 / 60) + " min";
}

std::string duration_range_words(double min_seconds, double max_seconds) {
    const std::string min = duration_words(min_seconds), max = duration_words(max_seconds);
    if (min == max) return "about " + max;
    return min_seconds > 0.0 ? "about " + min + " to " + max : "at most " + max;
}

std::string progress_words(const ProgressEvent& event) {
    std::string words = event.items.empty() ? std::to_string(std::lround(1e2 * event.fraction)) + "%"
                                            : std::to_string(event.done) + " of " +
                                                  std::to_string(event.total) + " " + event.items;
    const double max_left = event.max_seconds_left.value_or(event.seconds_left.value_or(0.0));
    if (max_left > 0.0)
        words += ", " + duration_range_words(event.seconds_left.value_or(max_left), max_left) + " left";
    return words;
}

ProgressMode progress_mode(const std::string& name) {
    if (name == "json") return ProgressMode::json;
    return name == "none" ? ProgressMode::none : ProgressMode::automatic;
}

ProgressDisplay::ProgressDisplay(ProgressMode mode, std::chrono::milliseconds quiet_for)
    : mode_(mode), quiet_for_(quiet_for), is_terminal_(standard_error_is_terminal()) {}

ProgressDisplay::~ProgressDisplay() {
    end_line();
}

void ProgressDisplay::show(ProgressEvent event) {
    const auto now = Clock::now();
    const bool is_first = event.fraction < last_fraction_;
    const bool is_last = event.fraction >= 1.0;
    if (is_first) {
        start_ = now;
        fraction_at_start_ = event.fraction;
    }
    last_fraction_ = event.fraction;
    const double done_here = event.fraction - fraction_at_start_;
    if (!event.seconds_left && is_last) event.seconds_left = 0.0;
    if (!event.seconds_left && event.is_steady && done_here > 0.0)
        event.seconds_left =
            std::chrono::duration<double>(now - start_).count() * (1.0 - event.fraction) / done_here;
    if (mode_ == ProgressMode::none) return;
    if (mode_ == ProgressMode::json) return say(progress_json(event));
    if (now - begin_ < quiet_for_) return;
    const auto interval = is_terminal_ ? Clock::duration(bar_interval) : Clock::duration(line_interval);
    if (!is_first && !is_last && now - last_shown_ < interval) return;
    last_shown_ = now;
    if (!is_terminal_) return say(event.activity + ": " + progress_words(event));
    write_standard_error("\r" + printable(event.activity) + " " + bar(event.fraction) + " " +
                         progress_words(event) + "\x1b[K");
    line_is_open_ = true;
}

void ProgressDisplay::end_line() {
    if (line_is_open_) write_standard_error("\n");
    line_is_open_ = false;
}

}  // namespace capstan
