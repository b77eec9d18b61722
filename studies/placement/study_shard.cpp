#include "capstan/placement/study_shard.h"

#include "capstan/cable/invalid_input.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/stored_study.h"
#include "capstan/placement/unit_run.h"
#include "capstan/platform/clocks.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

std::vector<storage::StudyDescription> descriptions_of(std::span<const PreparedStudy> studies,
                                                       const std::string& program_version) {
    std::vector<storage::StudyDescription> descriptions;
    for (const PreparedStudy& study : studies) descriptions.push_back(describe(study, program_version));
    return descriptions;
}

// The file is new, or was begun as this very shard.
std::vector<std::int64_t> begin_or_find(storage::Database& database, const Shard& shard,
                                        const std::vector<storage::StudyDescription>& descriptions) {
    const std::string file = database.path().string();
    const std::string try_this = " Name a new file, or remove this one.";
    auto ids = storage::begin_or_find_shard(database, {shard.number, shard.count}, descriptions);
    if (ids.size() != descriptions.size()) {
        throw storage::Error(file + " is a shard of " + std::to_string(ids.size()) +
                             " studies, but the configuration has " + std::to_string(descriptions.size()) +
                             "." + try_this);
    }
    for (std::size_t k = 0; k < ids.size(); ++k) {
        const auto other = difference_between(storage::load_study(database, ids[k]), descriptions[k]);
        if (!other.empty())
            throw storage::Error(file + " is a shard of another study: " + other + "." + try_this);
    }
    return ids;
}

// All units of the shard's parts in one study, done or not.
std::set<int> units_of(const Shard& shard, const Deal& deal, std::size_t index, const PreparedStudy& study) {
    std::set<int> units;
    for (int noise = 0; noise < static_cast<int>(study.plan.noise_levels.size()); ++noise) {
        for (int s = 0; s < static_cast<int>(study.scenarios.size()); ++s) {
            if (deal.owner(index, noise, s) != shard.number) continue;
            units.insert(single_sensor_unit(study, noise, s));
            units.insert(fusion_unit(study, noise, s));
        }
    }
    return units;
}

struct StudyOfShard {
    UnitsToRun to_run;
    int units = 0;
};

}  // namespace

StudySize size_of(const StudyPlan& plan) {
    std::size_t instants = 0;
    for (const RegimeInstants& regime : plan.regimes) instants += regime.samples.size();
    return {static_cast<int>(plan.noise_levels.size()), static_cast<int>(instants)};
}

Deal::Deal(const std::vector<StudySize>& studies, int shards) : shards_(shards), studies_(studies) {
    int noise_levels = 0;
    int parts = 0;
    for (const StudySize& study : studies) {
        noise_levels_before_.push_back(noise_levels);
        parts_before_.push_back(parts);
        noise_levels += study.noise_levels;
        parts += study.noise_levels * study.instants;
    }
    keeps_noise_levels_together_ = shards <= noise_levels;
}

int Deal::owner(std::size_t study, int noise_index, int scenario_index) const {
    const int card = keeps_noise_levels_together_
                         ? noise_levels_before_[study] + noise_index
                         : parts_before_[study] + noise_index * studies_[study].instants + scenario_index;
    return card % shards_ + 1;
}

Deal deal_out(std::span<const StudyPlan> plans, int shards) {
    std::vector<StudySize> sizes;
    for (const StudyPlan& plan : plans) sizes.push_back(size_of(plan));
    return {sizes, shards};
}

int parts_of(std::span<const StudyPlan> plans) {
    int parts = 0;
    for (const StudyPlan& plan : plans) parts += size_of(plan).noise_levels * size_of(plan).instants;
    return parts;
}

void require_useful(std::span<const StudyPlan> plans, const Shard& shard) {
    const int parts = parts_of(plans);
    if (shard.count <= parts) return;
    throw InvalidInput({"there are only " + std::to_string(parts) +
                        " parts (instants x noise levels) to deal out, so " + std::to_string(shard.count) +
                        " shards would leave some without work; use at most " + std::to_string(parts)});
}

std::string words_of(const Shard& shard) {
    return storage::words_of({shard.number, shard.count});
}

ShardOutcome run_shard(storage::Database& database, std::span<const StudyPlan> plans, const Shard& shard,
                       const std::string& program_version, const RunOptions& options) {
    const double start_wall_s = wall_time_s();
    ShardOutcome outcome;
    require_useful(plans, shard);
    const double start_s = thread_processor_time_s();
    std::vector<PreparedStudy> studies;
    for (const StudyPlan& plan : plans) studies.push_back(prepare(plan));
    outcome.times.prepare_s = thread_processor_time_s() - start_s;
    const auto ids = begin_or_find(database, shard, descriptions_of(studies, program_version));

    std::vector<StudyOfShard> work;
    StudyProgress progress;
    const Deal deal = deal_out(plans, shard.count);
    for (std::size_t k = 0; k < studies.size(); ++k) {
        const std::set<int> owned = units_of(shard, deal, k, studies[k]);
        work.push_back({{ids[k], {}, {}, true}, static_cast<int>(owned.size())});
        for (const int unit : storage::pending_units(database, ids[k])) {
            if (owned.count(unit) != 0) work[k].to_run.units.insert(unit);
        }
        if (!work[k].to_run.units.empty()) {
            storage::require_same_simd(database, ids[k]);
            storage::write_computation(database, ids[k]);
        }
        progress.units += work[k].units;
        progress.units_done += work[k].units - static_cast<int>(work[k].to_run.units.size());
    }
    const auto report = [&] {
        if (options.on_progress) options.on_progress(progress);
    };
    report();
    for (std::size_t k = 0; k < studies.size() && outcome.end == RunEnd::complete; ++k) {
        work[k].to_run.on_stored = [&] {
            ++progress.units_done;
            report();
        };
        outcome.end = run_units(database, studies[k], std::move(work[k].to_run), options, outcome.times);
    }
    outcome.times.wall_s = wall_time_s() - start_wall_s;
    return outcome;
}

}  // namespace capstan
