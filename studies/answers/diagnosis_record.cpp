#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/recording_answers.h"
#include "capstan/blind_trial/sealed_labels.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/gap/gap_map.h"
#include "capstan/platform/files.h"
#include "capstan/reports/page_frame.h"
#include "capstan/rig/channel_names.h"

namespace capstan::answers {

namespace {

using reports::Data;

std::optional<double> if_number(double value) {
    return std::isnan(value) ? std::nullopt : std::optional(value);
}

// Empty where the log cannot be read again, as from a pipe.
std::string hash_of(const std::filesystem::path& log) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(log, none)) return "";
    return gap_trial::sha256(read_file(log));
}

std::vector<storage::DiagnosisNumberRecord> number_records(const std::vector<gap::FittedNumber>& numbers) {
    std::vector<storage::DiagnosisNumberRecord> records;
    for (const gap::FittedNumber& number : numbers)
        records.push_back({number.name, number.value, number.unit,
                           number.interval ? std::optional(number.interval->low) : std::nullopt,
                           number.interval ? std::optional(number.interval->high) : std::nullopt});
    std::sort(records.begin(), records.end(),  // as they come back
              [](const auto& a, const auto& b) { return a.name < b.name; });
    return records;
}

storage::DiagnosisCauseRecord cause_record(const gap::FittedCause& cause) {
    return {cause.effect, cause.variant,    cause.component,
            cause.end,    cause.position_m, number_records(cause.numbers)};
}

// The causes of a verdict with the numbers that the model has now, and every other effect of its cable.
std::vector<storage::DiagnosisCauseRecord> cause_records(const bench_model::BenchModel& model) {
    std::vector<storage::DiagnosisCauseRecord> records;
    for (const bench_model::ModelCause& cause : model.causes)
        records.push_back({cause.effect, cause.variant, cause.component, cause.end, {}, {}});
    for (const bench_model::ModelEffect& effect : model.effects) {
        const auto named = std::find_if(records.begin(), records.end(), [&](const auto& each) {
            return each.effect == effect.name && each.variant == effect.variant;
        });
        if (named != records.end()) {
            named->numbers = number_records(effect.numbers);
            continue;
        }
        for (const Effect& each : effect_catalogue())
            if (each.changes_the_cable && each.name == effect.name && each.variant == effect.variant)
                records.push_back({effect.name,
                                   effect.variant,
                                   each.component,
                                   each.end,
                                   {},
                                   number_records(effect.numbers)});
    }
    return records;
}

storage::DiagnosisChannelRecord channel_record(const gap::ChannelGap& channel) {
    return {channel.channel,
            channel.unit,
            channel.noise,
            channel.before_rms,
            channel.after_rms,
            channel.held_out_rms,
            channel.runner_up_rms,
            if_number(channel.closed),
            if_number(channel.closed_low),
            if_number(channel.closed_high)};
}

std::string verdict_name(const gap::Diagnosis& diagnosis) {
    const std::string& first = diagnosis.ranked.front().effect;
    if (first == "none" || first == "unknown" || diagnosis.causes.empty()) return first;
    std::vector<std::string> effects;
    for (const gap::FittedCause& cause : diagnosis.causes) {
        if (std::find(effects.begin(), effects.end(), cause.effect) == effects.end())
            effects.push_back(cause.effect);
    }
    return fmt::format("{}", fmt::join(effects, " + "));
}

std::string words_of(const gap::FittedCause& cause) {
    return cause_words(cause.effect, cause.variant);
}

double present_probability(const gap::Diagnosis& diagnosis, const std::string& effect) {
    for (const gap::RankedEffect& each : diagnosis.ranked) {
        if (each.effect == effect) return each.present;
    }
    return 0.0;
}

// Which numbers stand at the bound of their search; empty: none.
std::string bounds_sentence(const gap::Diagnosis& diagnosis) {
    std::vector<std::string> at_bounds;
    for (const gap::FittedCause& cause : diagnosis.causes) {
        for (const gap::FittedNumber& number : cause.numbers) {
            if (number.is_at_bound)
                at_bounds.push_back(fmt::format("{} of {} ({:.4g}{}{})", channel_words(number.name),
                                                words_of(cause), number.value, number.unit.empty() ? "" : " ",
                                                number.unit));
        }
    }
    for (const std::string& ratio : diagnosis.at_bounds) at_bounds.push_back(ratio + " of the bench");
    for (const gap::FittedNumber& number : diagnosis.bench)
        if (number.is_at_bound) at_bounds.push_back(number.name);
    if (at_bounds.empty()) return "";
    return fmt::format(" At the bound of the search, so that the true number may lie beyond it: {}.",
                       fmt::join(at_bounds, ", "));
}

}  // namespace

std::string verdict_sentence(const gap::Diagnosis& diagnosis) {
    constexpr double likely = 0.5;
    const gap::RankedEffect& first = diagnosis.ranked.front();
    if (first.effect == "none")
        return fmt::format(
            "There is no gap beyond noise and the floor of the model (probability {:.2f}{}).",
            first.probability,
            diagnosis.bench.empty()
                ? ""
                : "; a cause that is too faint to show beside the bench's own numbers may act");
    if (first.effect == "unknown") {
        std::vector<std::string> beside;
        for (const gap::FittedCause& cause : diagnosis.causes) {
            const double present = present_probability(diagnosis, cause.effect);
            if (present > likely) beside.push_back(fmt::format("{} ({:.2f})", words_of(cause), present));
        }
        const std::string part =
            beside.empty() ? "" : fmt::format(" A part of it is probably {}.", fmt::join(beside, " and "));
        return fmt::format(
            "There is a gap that no known effect explains{} (probability {:.2f}).{} The numbers below are "
            "those of the best known effect.{}",
            beside.empty() ? "" : " completely", first.present, part, bounds_sentence(diagnosis));
    }
    std::vector<std::string> causes;
    for (const gap::FittedCause& cause : diagnosis.causes) causes.push_back(words_of(cause));
    // Several explanations may share the effect that leads, none of which is the most probable one by itself.
    if (causes.empty())
        return fmt::format(
            "The most probable cause is {} (probability {:.2f}). The numbers below are those of "
            "the bench without a cause.",
            cause_words(first.effect, ""), first.present);
    const double unknown = present_probability(diagnosis, "unknown");
    std::string text =
        diagnosis.candidates.front().is_only_the_bench && unknown < likely
            ? fmt::format(
                  "The bench's own numbers explain the gap: {}. Nothing else is visible; a cause that is too "
                  "faint to show may act beside them.",
                  fmt::join(causes, ", "))
        : causes.size() == 1
            ? fmt::format("The cause is {} (probability {:.2f}).", causes.front(), first.present)
            : fmt::format("{} causes act together: {} and {}.", causes.size(),
                          fmt::join(causes.begin(), causes.end() - 1, ", "), causes.back());
    if (unknown > likely)
        text += fmt::format(" {} a part that no known effect explains (probability {:.2f}).",
                            causes.size() == 1 ? "It leaves" : "They leave", unknown);
    return text + bounds_sentence(diagnosis);
}

storage::DiagnosisRecord diagnosis_record(const Recording& recording, const gap::Diagnosis& diagnosis,
                                          const std::filesystem::path& log) {
    storage::DiagnosisRecord record;
    record.recording = recording.name;
    record.log_file = log.string();
    if (!log.empty()) record.log_sha256 = hash_of(log);
    record.program_version = reports::program_version();
    std::vector<int> runs;
    for (const RecordedRun& run : recording.runs) runs.push_back(run.number);
    record.runs = json_line(Data(runs));
    record.verdict = verdict_name(diagnosis);
    record.confidence_fraction = diagnosis.ranked.front().probability;
    record.component = diagnosis.component;
    record.cable_end = diagnosis.end;
    record.position_m = diagnosis.position_m;
    record.worst_run = diagnosis.gap.worst_run;
    record.worst_channel = diagnosis.gap.worst_channel;
    record.friction_ratio = diagnosis.friction_ratio;
    record.stiffness_ratio = diagnosis.stiffness_ratio;
    record.pretension_ratio = diagnosis.pretension_ratio;
    record.friction_low_ratio = diagnosis.friction_interval.low;
    record.friction_high_ratio = diagnosis.friction_interval.high;
    record.stiffness_low_ratio = diagnosis.stiffness_interval.low;
    record.stiffness_high_ratio = diagnosis.stiffness_interval.high;
    record.pretension_low_ratio = diagnosis.pretension_interval.low;
    record.pretension_high_ratio = diagnosis.pretension_interval.high;
    record.misfit_before_ratio = diagnosis.misfit_before;
    record.misfit_after_ratio = diagnosis.misfit_after;
    record.independent_samples_count = diagnosis.independent_samples;
    record.sentence = verdict_sentence(diagnosis);
    record.gap_sentence = gap::gap_sentence(diagnosis.gap.map);
    for (const gap::RankedEffect& each : diagnosis.ranked)
        record.effects.push_back({each.effect, each.probability, each.present, each.varies});
    for (const gap::FittedCause& each : diagnosis.causes) record.causes.push_back(cause_record(each));
    for (const gap::CandidateScore& each : diagnosis.candidates) {
        record.candidates.push_back({json_line(Data(each.effects)), json_line(Data(each.variants)),
                                     static_cast<int>(each.open_numbers), each.misfit, each.nominal_penalty,
                                     json_line(Data(each.visibility)), each.evidence});
    }
    for (const gap::ChannelGap& each : diagnosis.gap.channels)
        record.channels.push_back(channel_record(each));
    for (const gap::GapFraction& each : diagnosis.gap.map)
        record.gap.push_back({each.by, each.name, each.fraction, each.low, each.high, each.of_samples});
    return record;
}

storage::DiagnosisRecord diagnosis_record(const bench_model::BenchModel& model) {
    storage::DiagnosisRecord record;
    record.recording = model.origin.recording;
    record.program_version = model.origin.program_version;
    record.sentence = model.origin.verdict;
    const auto take = [](const gap::FittedNumber& ratio, double& value, std::optional<double>& low,
                         std::optional<double>& high) {
        value = ratio.value;
        if (!ratio.interval) return;
        low = ratio.interval->low;
        high = ratio.interval->high;
    };
    take(model.friction_ratio, record.friction_ratio, record.friction_low_ratio, record.friction_high_ratio);
    take(model.stiffness_ratio, record.stiffness_ratio, record.stiffness_low_ratio,
         record.stiffness_high_ratio);
    take(model.pretension_ratio, record.pretension_ratio, record.pretension_low_ratio,
         record.pretension_high_ratio);
    for (const gap::RankedEffect& each : model.ranked)
        record.effects.push_back({each.effect, each.probability, each.present, each.varies});
    if (!model.ranked.empty()) record.confidence_fraction = model.ranked.front().probability;
    record.causes = cause_records(model);
    return record;
}

}  // namespace capstan::answers
