#include "capstan/import/stretch_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/import/log_files.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::imports {

namespace {

// A median deviation of a sample's time by more than this part of the period is resampled.
constexpr double largest_jitter = 0.05;
// Two rates are the same, and one is a multiple of another, within this.
constexpr double rate_tolerance = 0.01;

/// Notes the findings of one run.
class Notes {
  public:
    Notes(const LogRun& run, std::size_t index, std::vector<Finding>& findings)
        : run_(static_cast<int>(index) + 1), findings_(&findings) {
        where_ = fmt::format("run {} ({})", run_, file_names(run.files));
    }

    void add(FindingKind kind, bool repaired, const std::string& channel, std::size_t count, double amount,
             const std::string& words) {
        findings_->push_back({kind, repaired, run_, channel, count, amount, 0.0, where_ + ": " + words});
    }

  private:
    int run_;
    std::string where_;
    std::vector<Finding>* findings_;
};

void note_rows(const ChannelSurvey& survey, const Source& source, bool first_of_clock, Notes& notes) {
    const std::string& channel = source.mapping->name;
    if (survey.missing > 0)
        notes.add(FindingKind::missing_readings, true, channel, survey.missing, 0.0,
                  fmt::format("{} rows have no number for {}; they are left out for this channel",
                              survey.missing, channel));
    if (!first_of_clock) return;
    if (survey.repeated > 0)
        notes.add(
            FindingKind::repeated_samples, true, "", survey.repeated, 0.0,
            fmt::format("{} rows repeat the time of the row before; they are dropped", survey.repeated));
    if (survey.backward > 0)
        notes.add(FindingKind::unordered_times, true, "", survey.backward, 0.0,
                  fmt::format("{} rows have an earlier time than the row before; they are dropped",
                              survey.backward));
    if (survey.bridged > 0)
        notes.add(FindingKind::missing_readings, true, "", survey.bridged, 0.0,
                  fmt::format("at {} places one to three samples are missing; straight lines bridge them",
                              survey.bridged));
}

void note_saturation(const ChannelSurvey& survey, const Source& source, Notes& notes) {
    const std::string& channel = source.mapping->name;
    if (survey.saturated == 0 || channel.ends_with("_angle")) return;
    notes.add(FindingKind::saturated, false, channel, survey.saturated, 0.0,
              fmt::format(
                  "{} stays at exactly its largest or smallest reading for {} samples, first at {:.4g} s; a "
                  "saturated sensor? The readings are kept; cut the log with from_s and to_s",
                  channel, survey.saturated, survey.saturated_at_s - survey.first_s));
}

void unwrap(ChannelSurvey& survey, Source& source, RowRange rows, Notes& notes) {
    if (source.wraps_at > 0.0) return;  // stated, or found before
    const double range = wrap_range(survey, source);
    if (range == 0.0) return;
    source.wraps_at = range;
    survey = survey_channel(source, rows);
    notes.add(FindingKind::wrapped_counter, true, source.mapping->name, 1, range,
              fmt::format("{} jumps by the range of its counter, {:g} {}; it is unwound",
                          source.mapping->name, range, source.mapping->unit));
}

bool same_clock(const Source& a, const Source& b) {
    return a.clock.is(b.clock) && a.clock_offset_s == b.clock_offset_s;
}

std::vector<TimeGap> merged(std::vector<TimeGap> gaps) {
    std::sort(gaps.begin(), gaps.end(),
              [](const TimeGap& a, const TimeGap& b) { return a.from_s < b.from_s; });
    std::vector<TimeGap> joined;
    for (const TimeGap& gap : gaps) {
        if (!joined.empty() && gap.from_s <= joined.back().to_s) {
            joined.back().to_s = std::max(joined.back().to_s, gap.to_s);
        } else {
            joined.push_back(gap);
        }
    }
    return joined;
}

double rounded_rate(double period_s) {
    // Five digits: the median of printed times is not better.
    const double rate = 1.0 / period_s;
    const double digit = std::pow(10.0, std::floor(std::log10(rate)) - 4.0);
    return std::round(rate / digit) * digit;
}

void set_times(StretchPlan& plan, const LogRun& run, const Mapping& mapping, Piece& common, Notes& notes) {
    const ChannelSurvey& first = plan.surveys.front();
    bool one_clock = true;
    bool all_read = true;
    double jitter = 0.0;
    std::size_t bridged = 0;
    double fastest_s = first.period_s;
    for (std::size_t k = 0; k < plan.surveys.size(); ++k) {
        one_clock &= same_clock(run.sources[k], run.sources.front());
        all_read &= plan.surveys[k].missing == 0;
        jitter = std::max(jitter, plan.surveys[k].jitter);
        bridged += plan.surveys[k].bridged;
        fastest_s = std::min(fastest_s, plan.surveys[k].period_s);
    }
    const double log_Hz = rounded_rate(fastest_s);
    const double wanted_Hz = mapping.sample_rate_Hz.value_or(log_Hz);
    const double ratio = log_Hz / wanted_Hz;
    const int every = std::max(1, static_cast<int>(std::lround(ratio)));
    const bool integer_ratio = std::abs(ratio - every) < rate_tolerance * every;
    common.thinning = mapping.thinning;
    common.thinned_by = every;
    plan.sample_rate_Hz = wanted_Hz;
    if (one_clock && all_read && jitter <= largest_jitter && bridged == 0 && integer_ratio) {
        plan.sample_rate_Hz = mapping.sample_rate_Hz ? wanted_Hz : log_Hz;
        return;  // the log's own samples
    }
    common.grid_Hz = wanted_Hz * every;
    std::string why = !one_clock ? "its channels have different clocks"
                      : jitter > largest_jitter
                          ? fmt::format("its sample times vary by {:.0f}% of the period", 100.0 * jitter)
                      : !integer_ratio ? "its rate is not a multiple of the one asked for"
                                       : "readings are missing in it";
    notes.add(FindingKind::jitter, true, "", 0, jitter,
              fmt::format("resampled at {:g} Hz by straight lines, as {}", common.grid_Hz, why));
}

}  // namespace

StretchPlan plan_stretch(LogRun& run, std::size_t index, const Mapping& mapping,
                         std::vector<Finding>& findings) {
    StretchPlan plan;
    Notes notes(run, index, findings);
    std::vector<const Source*> clocks;
    for (Source& source : run.sources) {
        ChannelSurvey survey = survey_channel(source, run.rows);
        if (survey.readings < min_run_samples) {
            notes.add(FindingKind::short_stretch, true, source.mapping->name, survey.readings, 0.0,
                      fmt::format("{} has {} readings, fewer than {}; the run is left out",
                                  source.mapping->name, survey.readings, min_run_samples));
            return {};
        }
        unwrap(survey, source, run.rows, notes);
        const bool first_of_clock = std::none_of(
            clocks.begin(), clocks.end(), [&](const Source* other) { return same_clock(*other, source); });
        clocks.push_back(&source);
        note_rows(survey, source, first_of_clock, notes);
        note_saturation(survey, source, notes);
        plan.surveys.push_back(std::move(survey));
    }
    Piece common{
        .log_run = index, .from_s = plan.surveys.front().first_s, .to_s = plan.surveys.front().last_s};
    std::vector<TimeGap> gaps;
    for (const ChannelSurvey& survey : plan.surveys) {
        common.from_s = std::max(common.from_s, survey.first_s);
        common.to_s = std::min(common.to_s, survey.last_s);
        gaps.insert(gaps.end(), survey.gaps.begin(), survey.gaps.end());
    }
    if (run.mapping != nullptr) {
        const double start_s = common.from_s;
        if (run.mapping->from_s) common.from_s = std::max(common.from_s, start_s + *run.mapping->from_s);
        if (run.mapping->to_s) common.to_s = std::min(common.to_s, start_s + *run.mapping->to_s);
    }
    set_times(plan, run, mapping, common, notes);
    gaps = merged(gaps);
    std::size_t inside = 0;
    double longest_s = 0.0;
    double from_s = common.from_s;
    const auto keep = [&](double to_s) {
        const double samples = (to_s - from_s) * plan.sample_rate_Hz + 1.0;
        if (samples + 1e-6 >= static_cast<double>(min_run_samples)) {
            Piece piece = common;
            piece.from_s = from_s;
            piece.to_s = to_s;
            plan.pieces.push_back(piece);
        } else {
            notes.add(
                FindingKind::short_stretch, true, "", static_cast<std::size_t>(std::max(samples, 0.0)), 0.0,
                fmt::format("the stretch from {:.4g} s to {:.4g} s has fewer than {} samples; it is left out",
                            from_s - common.from_s, to_s - common.from_s, min_run_samples));
        }
    };
    for (const TimeGap& gap : gaps) {
        if (gap.to_s <= common.from_s || gap.from_s >= common.to_s) continue;
        ++inside;
        longest_s = std::max(longest_s, gap.to_s - gap.from_s);
        keep(std::min(gap.from_s, common.to_s));
        from_s = gap.to_s;
    }
    if (from_s <= common.to_s) keep(common.to_s);
    if (inside > 0)
        notes.add(
            FindingKind::gap, true, "", inside, longest_s,
            fmt::format(
                "{} gap{} of up to {:.4g} s; friction remembers what happened there, so the run is split "
                "at each",
                inside, inside == 1 ? "" : "s", longest_s));
    return plan;
}

}  // namespace capstan::imports
