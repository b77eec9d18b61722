#include "capstan/worlds/stored_worlds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "capstan/config/config_writer.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/sensor_places.h"

namespace capstan {

namespace {

std::string sensors_json(const Candidate& candidate, const std::vector<SensorOffer>& offers) {
    std::vector<std::string> sensors;
    for (const int sensor : candidate.sensors) {
        const SensorOffer& offer = offers[static_cast<std::size_t>(sensor)];
        const std::string_view cable = !has_two_cables(offers) || offer.kind != SensorKind::tension ? ""
                                       : offer.cable == 0 ? R"(,"cable":"A")"
                                                          : R"(,"cable":"B")";
        sensors.push_back(
            fmt::format(R"({{"kind":"{}","place_m":{}{}}})", name_of(offer.kind), offer.place_m, cable));
    }
    return fmt::format("[{}]", fmt::join(sensors, ","));
}

storage::WorldCandidateRecord record_of(const Candidate& candidate, const std::vector<SensorOffer>& offers) {
    return {sensors_json(candidate, offers), words_of(candidate, offers),
            fmt::format("{}", fmt::join(candidate.names, " ")), candidate.count(), candidate.price};
}

storage::WorldErrorRecord record_of(const TableEntry& entry) {
    const WorldError& error = entry.error;
    return {entry.candidate,      std::string(name_of(entry.condition)),
            entry.world,          error.mean_abs_N,
            error.load_end_N,     error.worst_place_N,
            error.mean_square_N2, error.covered_fraction};
}

std::optional<TableEntry> entry_of(const storage::WorldErrorRecord& record) {
    const std::optional<Condition> condition = find_condition(record.condition);
    if (!condition) return std::nullopt;
    return TableEntry{*condition,
                      record.candidate_index,
                      record.world,
                      {record.mean_abs_error_N, record.load_end_error_N, record.worst_place_error_N,
                       record.mean_square_error_N2, record.covered_fraction}};
}

storage::WorldRecommendationRecord recommendation_record(const StudyPlan& plan, const WorldAnswer& answer) {
    const Expected& expected = answer.recommended ? answer.best().expected : answer.no_sensor;
    return {std::string(name_of(plan.placement.objective)),
            expected.candidate,
            "ensemble_filter",
            expected.objective.value_N,
            expected.error_95_N,
            expected.objective.low_N,
            expected.objective.high_N,
            answer.no_sensor.objective.value_N,
            answer.recommended ? 1 : 0,
            sentence_of(plan, answer)};
}

std::string_view error_words(PlacementObjective objective) {
    switch (objective) {
        case PlacementObjective::all_nodes:
            return "The tension error, averaged over the cable and the motion,";
        case PlacementObjective::load_end:
            return "The tension error at the load end, averaged over the motion,";
        case PlacementObjective::worst_node:
            return "The tension error at the worst place of the cable, averaged over the motion,";
        case PlacementObjective::quantile_95:
            return "The tension error, averaged over the cable and the motion,";
    }
    return {};
}

std::string expectation(PlacementObjective objective, const Expected& expected) {
    const Estimated& error = expected.objective;
    const std::string interval =
        fmt::format("Monte-Carlo interval {:.3f} to {:.3f} N", error.low_N, error.high_N);
    if (objective == PlacementObjective::quantile_95)
        return fmt::format("{} is below {:.3f} N in 95% of the worlds ({}).", error_words(objective),
                           error.value_N, interval);
    return fmt::format("{} is expected to be {:.3f} N ({}), and below {:.3f} N in 95% of the worlds.",
                       error_words(objective), error.value_N, interval, expected.error_95_N);
}

std::string_view thing_known(Condition condition) {
    switch (condition) {
        case Condition::friction_known:
            return "the friction";
        case Condition::wrap_known:
            return "the bends";
        case Condition::stiffness_known:
            return "the stiffness";
        case Condition::pretension_known:
            return "the pretension";
        case Condition::sensors_known:
            return "the sensors";
        default:
            return name_of(condition);
    }
}

// Where else the recommended sensors would do as well.
std::string pieces_words(const WorldAnswer& answer) {
    std::vector<std::string> pieces;
    for (const int sensor : answer.set(answer.best().expected.candidate).sensors) {
        const StraightPiece& piece = answer.pieces[static_cast<std::size_t>(sensor)];
        if (!(piece.from_m < piece.to_m)) continue;
        const std::string words = fmt::format("from {:.3g} to {:.3g} m", piece.from_m, piece.to_m);
        if (pieces.empty() || pieces.back() != words) pieces.push_back(words);
    }
    if (pieces.empty()) return {};
    return fmt::format(" A sensor reads the same anywhere in its straight piece of conduit: {}.",
                       fmt::join(pieces, ", "));
}

std::string bound_words(const WorldAnswer& answer) {
    if (!answer.bound) return {};
    const Estimated& gap = answer.bound->gap;
    return fmt::format(
        " No allowed set is better by more than {:.3f} N{} (Monte-Carlo interval {:.3f} to {:.3f} N).",
        gap.value_N, answer.bound->is_of_rms ? " in its root mean square error" : "", gap.low_N, gap.high_N);
}

}  // namespace

std::string sentence_of(const StudyPlan& plan, const WorldAnswer& answer) {
    const PlacementObjective objective = plan.placement.objective;
    if (!answer.recommended) {
        return fmt::format(
            "No set of sensors is better than none: {} The cheapest set, {}, changes it by {:.3f} N "
            "({:.3f} to {:.3f} N).{}",
            expectation(objective, answer.no_sensor), answer.words(answer.best().expected.candidate),
            -answer.gain_over_none.value_N, -answer.gain_over_none.high_N, -answer.gain_over_none.low_N,
            bound_words(answer));
    }
    std::string text = fmt::format(
        "Use {}. {} Without any sensor it is {:.3f} N.", answer.words(answer.best().expected.candidate),
        expectation(objective, answer.best().expected), answer.no_sensor.objective.value_N);
    text += pieces_words(answer);
    text += bound_words(answer);
    if (answer.further)
        text +=
            fmt::format(" A further sensor gains {:.3f} N ({:.3f} to {:.3f} N).", answer.further_gain.value_N,
                        answer.further_gain.low_N, answer.further_gain.high_N);
    const auto most = std::max_element(
        answer.knowledge.begin(), answer.knowledge.end(),
        [](const KnowledgeGain& a, const KnowledgeGain& b) { return a.gain.value_N < b.gain.value_N; });
    if (most != answer.knowledge.end())
        text += fmt::format(
            " Calibrating {} exactly gains {:.3f} N ({:.3f} to {:.3f} N), the most of all calibrations.",
            thing_known(most->condition), most->gain.value_N, most->gain.low_N, most->gain.high_N);
    return text;
}

storage::StudyDescription describe_worlds(const StudyPlan& plan, const std::string& program_version) {
    if (const auto problems = problems_of(plan); !problems.empty()) throw InvalidInput(problems);
    storage::StudyDescription description;
    description.study = {0,
                         plan.name,
                         config::config_text(plan, config::Comments::none),
                         program_version,
                         plan.seed,
                         plan.repetitions,
                         plan.transmission.cable.segments};
    const Cable cable(plan.transmission.cable);
    for (int i = 0; i < cable.segments(); ++i) {
        const double wrap_rad = cable.wrap_angle_rad()[i];
        storage::CableSegmentRecord record{
            i + 1, cable.node_position_m(i), cable.segment_length_m(i), {}, wrap_rad};
        if (wrap_rad > 0.0) record.bend_radius_m = cable.segment_length_m(i) / wrap_rad;
        description.cable_segments.push_back(record);
    }
    const std::vector<SensorOffer> offers = sensor_offers(plan);
    for (const Candidate& candidate : candidates_of(plan, offers))
        description.world_candidates.push_back(record_of(candidate, offers));
    return description;
}

std::int64_t begin_worlds(storage::Database& database, const StudyPlan& plan,
                          const std::string& program_version) {
    return storage::begin_study(database, describe_worlds(plan, program_version));
}

namespace {

// The study's table with what is stored of it; it stores what it computes, unless the study is complete.
ErrorTable stored_table(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                        TableOptions options, bool is_complete) {
    if (!is_complete) {
        storage::write_computation(database, study_id);
        const auto stored = static_cast<int>(storage::load_study(database, study_id).world_candidates.size());
        options.keep_candidate = [&database, study_id, stored, offers = sensor_offers(plan)](
                                     int number, const Candidate& candidate) {
            if (number >= stored)
                storage::add_world_candidate(database, study_id, number, record_of(candidate, offers));
        };
        options.keep = [&database, study_id](std::span<const TableEntry> entries) {
            std::vector<storage::WorldErrorRecord> records;
            for (const TableEntry& entry : entries) records.push_back(record_of(entry));
            storage::write_world_errors(database, study_id, records);
        };
    }
    ErrorTable table(plan, std::move(options));
    for (const storage::WorldErrorRecord& record : storage::read_world_errors(database, study_id))
        if (const auto entry = entry_of(record)) table.take(*entry);
    return table;
}

}  // namespace

WorldAnswer run_worlds(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                       const TableOptions& options, std::span<const storage::WorldErrorRecord> computed) {
    const bool is_complete = storage::read_world_recommendation(database, study_id).has_value();
    ErrorTable table = stored_table(database, study_id, plan, options, is_complete);
    for (const storage::WorldErrorRecord& record : computed)
        if (const auto entry = entry_of(record)) table.offer(*entry);
    WorldAnswer answer = choose_sensors(table);
    if (!is_complete) storage::finish_world_study(database, study_id, recommendation_record(plan, answer));
    return answer;
}

ErrorTable complete_table(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                          const TableOptions& options) {
    return stored_table(database, study_id, plan, options, true);
}

void fill_worlds(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                 const TableOptions& options, int first, int last, int stride) {
    ErrorTable table = stored_table(database, study_id, plan, options, false);
    std::vector<int> all(table.candidates().size());
    std::iota(all.begin(), all.end(), 0);
    table.fill(Condition::as_stated, all, first, last, "its share of the worlds", stride);
}

WorldAnswer run_worlds(const StudyPlan& plan, const TableOptions& options) {
    if (const auto problems = problems_of(plan); !problems.empty()) throw InvalidInput(problems);
    ErrorTable table(plan, options);
    return choose_sensors(table);
}

}  // namespace capstan
