#include "capstan/verification/recomputation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "capstan/placement/stored_study.h"
#include "capstan/placement/unit_run.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/integrity/hashed_rows.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan {

namespace {

constexpr std::size_t max_problems = 20;  // that are named

template <class Unit>
std::vector<Unit> sample_of(std::vector<Unit> units, const Sample& sample) {
    std::mt19937_64 random(sample.seed);
    const auto wanted =
        static_cast<std::size_t>(std::ceil(sample.fraction * static_cast<double>(units.size())));
    std::vector<Unit> chosen;
    std::sample(units.begin(), units.end(), std::back_inserter(chosen), wanted, random);
    return chosen;
}

void require_width_of(storage::Database& database, std::int64_t study_id) {
    if (const auto simd = storage::other_simd(database, study_id))
        throw storage::Error(fmt::format(
            "Study {0} was computed with SIMD {1}, and this is {2}, which gives other last bits. Verify it with --simd "
            "{1}, on a machine that has it.",
            study_id, *simd, storage::this_computation().simd));
}

storage::Database empty_results() {
    storage::Database database = storage::Database::in_memory();
    database.execute(storage::schema_text(), "create the tables");
    return database;
}

std::vector<int> stored_units(storage::Database& database, const storage::StudyDescription& description) {
    const auto pending = storage::pending_units(database, description.study.study_id);
    std::vector<int> units;
    for (int unit = 0; unit < static_cast<int>(description.work_units.size()); ++unit)
        if (!std::binary_search(pending.begin(), pending.end(), unit)) units.push_back(unit);
    return units;
}

std::map<std::string, std::string> digests_of_unit(storage::Database& database, std::int64_t study_id,
                                                   int unit) {
    const storage::StudyIds ids = storage::load_study_ids(database, study_id);
    return storage::digests_of(database, ids, storage::unit_rows(database, ids, unit));
}

void compare_unit(storage::Database& stored, std::int64_t stored_id, storage::Database& computed,
                  std::int64_t computed_id, int unit, std::vector<std::string>& problems) {
    auto was = digests_of_unit(stored, stored_id, unit);
    auto is = digests_of_unit(computed, computed_id, unit);
    for (auto& [table, sha256] : is)
        if (was[table] != sha256 && problems.size() < max_problems)
            problems.push_back(
                fmt::format("unit {}: table {} is not what this program computes", unit, table));
    for (auto& [table, sha256] : was)
        if (is.count(table) == 0 && problems.size() < max_problems)
            problems.push_back(fmt::format("unit {}: this program stores nothing in table {}", unit, table));
}

Recomputation recompute_units(storage::Database& database, const StoredStudy& stored, const Sample& sample,
                              const RunOptions& options) {
    const std::int64_t study_id = stored.description.study.study_id;
    const std::vector<int> units = stored_units(database, stored.description);
    const std::vector<int> chosen = sample_of(units, sample);
    Recomputation result;
    result.units = static_cast<int>(units.size());
    const PreparedStudy study = prepare(stored.plan);
    const auto description = describe(study, stored.description.study.program_version);
    if (const std::string other = difference_between(description, stored.description); !other.empty())
        result.problems.push_back("the description is not what this program computes: " + other);
    storage::Database computed = empty_results();
    const std::int64_t computed_id = storage::begin_study(computed, description);
    StudyTimes times;
    UnitsToRun work{computed_id, {chosen.begin(), chosen.end()}, {}};
    StudyProgress progress{0, static_cast<int>(chosen.size())};
    work.on_stored = [&] {
        ++progress.units_done;
        if (options.on_progress) options.on_progress(progress);
    };
    result.end = run_units(computed, study, std::move(work), options, times);
    if (result.end == RunEnd::stopped) return result;
    for (const int unit : chosen)
        compare_unit(database, study_id, computed, computed_id, unit, result.problems);
    result.compared = static_cast<int>(chosen.size());
    return result;
}

using WorldTask = std::pair<Condition, int>;  // a condition and a world
using StoredErrors = std::map<WorldTask, std::vector<storage::WorldErrorRecord>>;

StoredErrors errors_by_task(storage::Database& database, std::int64_t study_id) {
    StoredErrors tasks;
    for (const storage::WorldErrorRecord& error : storage::read_world_errors(database, study_id))
        if (const auto condition = find_condition(error.condition); condition && error.world >= 0)
            tasks[{*condition, error.world}].push_back(error);
    return tasks;
}

bool is_same(const WorldError& computed, const storage::WorldErrorRecord& stored) {
    return computed.mean_abs_N == stored.mean_abs_error_N && computed.load_end_N == stored.load_end_error_N &&
           computed.worst_place_N == stored.worst_place_error_N &&
           computed.mean_square_N2 == stored.mean_square_error_N2 &&
           computed.covered_fraction == stored.covered_fraction;
}

// With the numbers that the stored study gave to the sets which its search added.
void add_candidates(storage::Database& database, const StoredStudy& stored, const TableOptions& options,
                    ErrorTable& table) {
    if (!table.grows() || stored.description.study.status != "complete") return;
    ErrorTable before = complete_table(database, stored.description.study.study_id, stored.plan, options);
    choose_sensors(before);
    for (const Candidate& candidate : before.candidates()) table.candidate_of(candidate.sensors);
}

Recomputation recompute_worlds(storage::Database& database, const StoredStudy& stored, const Sample& sample,
                               const RunOptions& options) {
    const StoredErrors errors = errors_by_task(database, stored.description.study.study_id);
    std::vector<WorldTask> tasks;
    for (const auto& [task, records] : errors) tasks.push_back(task);
    Recomputation result;
    result.units = static_cast<int>(tasks.size());
    const std::vector<WorldTask> chosen = sample_of(tasks, sample);
    TableOptions of_table;
    of_table.jobs = options.jobs;
    of_table.stop = options.stop;
    try {
        ErrorTable table(stored.plan, of_table);
        add_candidates(database, stored, of_table, table);
        for (const WorldTask& task : chosen) {
            const auto [condition, world] = task;
            const auto known = static_cast<int>(table.candidates().size());
            std::vector<int> candidates;
            for (const auto& record : errors.at(task))
                if (record.candidate_index >= 0 && record.candidate_index < known)
                    candidates.push_back(record.candidate_index);
            if (candidates.empty()) continue;
            table.fill(condition, candidates, world, world + 1, "verification");
            for (const auto& record : errors.at(task))
                if (record.candidate_index >= 0 && record.candidate_index < known &&
                    !is_same(table.at(condition, record.candidate_index, world), record) &&
                    result.problems.size() < max_problems)
                    result.problems.push_back(fmt::format(
                        "world {} under {}, set {}: table world_error is not what this program computes",
                        world, record.condition, record.candidate_index));
            ++result.compared;
            if (options.on_progress) options.on_progress({result.compared, static_cast<int>(chosen.size())});
        }
    } catch (const TableStopped&) {
        result.end = RunEnd::stopped;
    }
    return result;
}

}  // namespace

Recomputation recompute(storage::Database& database, std::int64_t study_id, const Sample& sample,
                        const RunOptions& options) {
    require_width_of(database, study_id);
    const StoredStudy stored = load_stored_study(database, study_id);
    return stored.plan.uncertainty.is_stated ? recompute_worlds(database, stored, sample, options)
                                             : recompute_units(database, stored, sample, options);
}

}  // namespace capstan
