#include "capstan/config/far_end_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

#include "capstan/recording/csv_numbers.h"

namespace capstan::config {

namespace {

// Beyond this a configuration would no longer be a text that is stored with every study.
constexpr std::size_t max_log_samples = 100000;

struct MotionLog {
    std::vector<double> time_s;
    std::vector<double> displacement_m;
};

MotionLog read_log(const std::filesystem::path& path) {
    ProblemList problems;
    const CsvNumbers table = read_csv_numbers(path, problems);
    const auto column = [&](std::string_view name) -> std::vector<double> {
        const auto found = std::find(table.columns.begin(), table.columns.end(), name);
        if (found != table.columns.end())
            return table.values[static_cast<std::size_t>(found - table.columns.begin())];
        problems.add(fmt::format("{}:1", path.string()),
                     fmt::format("has no column {}; the columns time_s and displacement_m are needed", name));
        return {};
    };
    const MotionLog log{column("time_s"), column("displacement_m")};
    for (std::size_t row = 1; row < log.time_s.size(); ++row) {
        if (log.time_s[row] > log.time_s[row - 1]) continue;
        problems.add(fmt::format("{}:{}", path.string(), CsvNumbers::line_of(row)),
                     fmt::format("time_s is {} after {}; the time must rise from line to line",
                                 log.time_s[row], log.time_s[row - 1]));
    }
    problems.throw_if_any();
    return log;
}

// Linear between the log's samples.
std::vector<double> at_rate(const MotionLog& log, double sample_rate_Hz) {
    const double duration_s = log.time_s.back() - log.time_s.front();
    const double count = std::floor(duration_s * sample_rate_Hz + 1e-9) + 1.0;
    std::vector<double> displacement_m;
    std::size_t row = 0;
    for (double k = 0.0; k < std::min(count, max_log_samples + 1.0); ++k) {
        const double time_s = log.time_s.front() + k / sample_rate_Hz;
        while (row + 2 < log.time_s.size() && log.time_s[row + 1] < time_s) ++row;
        const std::size_t next = std::min(row + 1, log.time_s.size() - 1);
        const double span_s = log.time_s[next] - log.time_s[row];
        const double part = span_s > 0.0 ? std::clamp((time_s - log.time_s[row]) / span_s, 0.0, 1.0) : 0.0;
        const double here_m =
            log.displacement_m[row] + part * (log.displacement_m[next] - log.displacement_m[row]);
        displacement_m.push_back(std::round(here_m * 1e9) / 1e9);
    }
    return displacement_m;
}

// 95% of the displacements that the worlds see, each counted from where its stretch begins, are within this.
double range_of(const std::vector<double>& displacement_m, std::size_t samples) {
    constexpr std::size_t max_stretches = 200;
    const std::size_t starts = displacement_m.size() - samples;
    const std::size_t step = std::max<std::size_t>(1, starts / max_stretches);
    std::vector<double> distances_m;
    for (std::size_t start = 0; start < starts; start += step)
        for (std::size_t k = 1; k <= samples; ++k)
            distances_m.push_back(std::abs(displacement_m[start + k] - displacement_m[start]));
    const std::size_t at = distances_m.size() * 95 / 100;
    std::nth_element(distances_m.begin(), distances_m.begin() + static_cast<std::ptrdiff_t>(at),
                     distances_m.end());
    return distances_m[at];
}

// 95% of the power lies below this: Welch's periodogram, pieces under a Hann window.
double bandwidth_of(const std::vector<double>& displacement_m, double sample_rate_Hz) {
    constexpr std::size_t max_piece = 1024;
    const std::size_t piece = std::min(max_piece, displacement_m.size());
    std::vector<double> power(piece / 2 + 1, 0.0);
    std::vector<double> windowed(piece);
    for (std::size_t start = 0; start + piece <= displacement_m.size(); start += piece) {
        double mean_m = 0.0;
        for (std::size_t k = 0; k < piece; ++k)
            mean_m += displacement_m[start + k] / static_cast<double>(piece);
        for (std::size_t k = 0; k < piece; ++k) {
            const double turn =
                2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(piece);
            windowed[k] = (displacement_m[start + k] - mean_m) * 0.5 * (1.0 - std::cos(turn));
        }
        for (std::size_t bin = 1; bin < power.size(); ++bin) {
            const double turn =
                2.0 * std::numbers::pi * static_cast<double>(bin) / static_cast<double>(piece);
            const std::complex<double> rotation = std::polar(1.0, turn);
            std::complex<double> at = 1.0;
            std::complex<double> sum = 0.0;
            for (const double each : windowed) {
                sum += each * at;
                at *= rotation;
            }
            power[bin] += std::norm(sum);
        }
    }
    double total = 0.0;
    for (const double each : power) total += each;
    double below = 0.0;
    std::size_t bin = 0;
    while (bin + 1 < power.size() && below + power[bin] < 0.95 * total) below += power[bin++];
    const double part = power[bin] > 0.0 ? (0.95 * total - below) / power[bin] : 0.0;
    return (static_cast<double>(bin) - 0.5 + part) * sample_rate_Hz / static_cast<double>(piece);
}

}  // namespace

void take_far_end_log(ReadConfig& config, const std::filesystem::path& path) {
    const TrueMotion& motion = config.plan.motion;
    Uncertainty& unknown = config.plan.uncertainty;
    const auto samples = static_cast<std::size_t>(motion.samples);
    const MotionLog log = read_log(path);
    std::vector<double> displacement_m = at_rate(log, motion.sample_rate_Hz);
    ProblemList problems;
    if (displacement_m.size() <= samples)
        problems.add(
            path.string(),
            fmt::format("lasts {:.3g} s, but [motion] lasts {:.3g} s; record longer, or "
                        "lower motion.samples",
                        log.time_s.back() - log.time_s.front(), motion.samples / motion.sample_rate_Hz));
    if (displacement_m.size() > max_log_samples)
        problems.add(path.string(),
                     fmt::format("has more than {} samples at motion.sample_rate_Hz; use a part of it",
                                 max_log_samples));
    const auto [low, high] = std::minmax_element(displacement_m.begin(), displacement_m.end());
    if (!(*high - *low > 0.0))
        problems.add(path.string(),
                     "displacement_m never changes; for a far end at rest use far_end = \"prescribed\"");
    problems.throw_if_any();
    unknown.far_end = FarEndKind::recorded;
    unknown.far_end_log = path.filename().string();
    if (!config.lines.contains("uncertainty.far_end_range_m"))
        unknown.far_end_range_m = range_of(displacement_m, samples);
    if (!config.lines.contains("uncertainty.far_end_bandwidth_Hz"))
        unknown.far_end_bandwidth_Hz = bandwidth_of(displacement_m, motion.sample_rate_Hz);
    unknown.far_end_samples_m = std::move(displacement_m);
}

void take_named_far_end_log(ReadConfig& config) {
    const Uncertainty& unknown = config.plan.uncertainty;
    if (!unknown.is_stated || unknown.far_end_log.empty() || !unknown.far_end_samples_m.empty()) return;
    if (config.plan.motion.samples < 1 || !(config.plan.motion.sample_rate_Hz > 0.0))
        return;  // reported as such
    const std::filesystem::path log = std::filesystem::path(config.file).parent_path() / unknown.far_end_log;
    try {
        take_far_end_log(config, log);
    } catch (const InvalidInput& error) {
        const auto line = config.lines.find("uncertainty.far_end_log");
        throw ConfigError(config.file, {{line == config.lines.end() ? 0 : line->second, 0,
                                         "uncertainty.far_end_log", error.what()}});
    }
}

}  // namespace capstan::config
