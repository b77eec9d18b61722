#include "capstan/worlds/world_shard.h"

#include <fmt/format.h>

#include <map>
#include <numeric>

#include "capstan/config/config_reader.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/choice.h"
#include "capstan/worlds/sensor_places.h"

namespace capstan {

namespace {

namespace fs = std::filesystem;

// Of so many sets every one runs in every world, unless a greedy search follows.
constexpr std::size_t few_candidates = 100;

// What shards run: all candidates that a study begins with, in so many worlds.
struct Sharded {
    std::size_t candidates = 0;
    int worlds = 0;
};

Sharded sharded(const StudyPlan& plan) {
    const std::vector<Candidate> candidates = candidates_of(plan, sensor_offers(plan));
    const bool is_few = candidates.size() <= few_candidates && !candidates.back().is_bound;
    return {candidates.size(), is_few ? 2 * plan.repetitions : std::min(fewest_worlds, plan.repetitions)};
}

// How many errors the shard holds when it is done.
std::size_t errors_of(const StudyPlan& plan, const storage::ShardRecord& shard) {
    const Sharded all = sharded(plan);
    const int own = (all.worlds - shard.shard) / shard.shards + (all.worlds >= shard.shard ? 1 : 0);
    return all.candidates * static_cast<std::size_t>(std::max(own, 0));
}

std::int64_t begin_or_find(storage::Database& database, const storage::ShardRecord& shard,
                           const storage::StudyDescription& description) {
    const std::int64_t id = storage::begin_or_find_shard(database, shard, {description}).front();
    const storage::StudyRecord stored = storage::load_study(database, id).study;
    if (stored.config_toml != description.study.config_toml ||
        stored.program_version != description.study.program_version)
        throw storage::Error(database.path().string() +
                             " is a shard of another study, or of another version of the program. Name a new "
                             "file, or remove this one.");
    return id;
}

// The files of a merge, checked.
struct WorldShards {
    std::map<int, fs::path> files;
    storage::StudyDescription study;
    StudyPlan plan;
    std::vector<storage::WorldErrorRecord> errors;
    storage::SameComputation computations;
};

WorldShards read_shards(const std::vector<fs::path>& paths) {
    WorldShards shards;
    std::vector<std::string> problems;
    int count = 0;
    for (const fs::path& path : paths) {
        storage::Database database = storage::Database::open_read_only(path);
        const auto mark = storage::read_shard(database);
        if (!mark || !holds_worlds(database)) {
            problems.push_back(path.string() + " is not the file of a shard of a study over worlds.");
            continue;
        }
        const std::int64_t id = storage::list_studies(database).front().study_id;
        const storage::StudyDescription study = storage::load_study(database, id);
        if (shards.files.empty()) {
            shards.study = study;
            shards.plan = config::parse_config(study.study.config_toml, path.string()).plan;
            count = mark->shards;
        } else if (mark->shards != count || study.study.config_toml != shards.study.study.config_toml ||
                   study.study.program_version != shards.study.study.program_version) {
            problems.push_back(
                fmt::format("{} belongs to another study, version or number of shards than {}.",
                            path.string(), shards.files.begin()->second.string()));
            continue;
        }
        const auto [at, is_new] = shards.files.try_emplace(mark->shard, path);
        if (!is_new) {
            problems.push_back(fmt::format("{} is {}, and so is {}; leave one out.", path.string(),
                                           words_of(*mark), at->second.string()));
            continue;
        }
        if (const std::string other = shards.computations.problem_of(database); !other.empty())
            problems.push_back(fmt::format("{} {}.", path.string(), other));
        for (const std::string& changed : storage::check_hashes(database).problems)
            problems.push_back(
                fmt::format("{} is damaged ({}); run it again, into a new file.", path.string(), changed));
        auto errors = storage::read_world_errors(database, id);
        const std::size_t all = errors_of(shards.plan, *mark);
        if (errors.size() < all)
            problems.push_back(fmt::format(
                "{} is unfinished: {} of its {} trials are done; go on with: capstan study run CONFIG --shard {}/{} "
                "--db {}.",
                path.string(), errors.size(), all, mark->shard, mark->shards, path.string()));
        shards.errors.insert(shards.errors.end(), errors.begin(), errors.end());
    }
    for (int number = 1; number <= count; ++number)
        if (shards.files.count(number) == 0)
            problems.push_back(fmt::format(
                "Shard {} of {} is missing; name its file, or run it: capstan study run CONFIG --shard {}/{} --db "
                "FILE.",
                number, count, number, count));
    if (problems.empty()) {
        shards.computations.require_same_simd_here();
        return shards;
    }
    throw storage::Error(std::accumulate(
        problems.begin(), problems.end(), std::string("These shards cannot be merged; nothing was written."),
        [](const std::string& text, const std::string& problem) { return text + "\n  " + problem; }));
}

}  // namespace

bool holds_worlds(storage::Database& database) {
    const auto studies = storage::list_studies(database);
    return !studies.empty() &&
           !storage::load_study(database, studies.front().study_id).world_candidates.empty();
}

std::optional<WorldShardState> read_world_shard_state(storage::Database& database) {
    const auto mark = storage::read_shard(database);
    if (!mark || !holds_worlds(database)) return std::nullopt;
    const std::int64_t id = storage::list_studies(database).front().study_id;
    const storage::StudyDescription study = storage::load_study(database, id);
    const StudyPlan plan =
        config::parse_config(study.study.config_toml, "the stored configuration of the shard").plan;
    return WorldShardState{storage::read_world_errors(database, id).size(), errors_of(plan, *mark)};
}

void require_worlds_for(const StudyPlan& plan, int shards) {
    const int worlds = sharded(plan).worlds;
    if (shards > worlds)
        throw InvalidInput(
            {fmt::format("there are only {} worlds to deal out, so {} shards would leave some "
                         "without work; use at most {}",
                         worlds, shards, worlds)});
}

void run_world_shard(storage::Database& database, const StudyPlan& plan, const storage::ShardRecord& shard,
                     const std::string& program_version, const TableOptions& options) {
    const storage::StudyDescription description = describe_worlds(plan, program_version);
    require_worlds_for(plan, shard.shards);
    const std::int64_t id = begin_or_find(database, shard, description);
    storage::require_same_simd(database, id);
    fill_worlds(database, id, plan, options, shard.shard - 1, sharded(plan).worlds, shard.shards);
}

void merge_world_shards(const fs::path& merged, const std::vector<fs::path>& paths,
                        const TableOptions& options) {
    storage::write_new_database(merged, [&](storage::Database& database) {
        const WorldShards shards = read_shards(paths);
        const std::int64_t id = storage::begin_study(database, shards.study);
        if (const auto& computation = shards.computations.common())
            storage::write_computation(database, id, *computation);
        run_worlds(database, id, shards.plan, options, shards.errors);
        return true;
    });
}

}  // namespace capstan
