#include "capstan/placement/study_merge.h"

#include <map>
#include <memory>
#include <set>

#include "capstan/config/config_reader.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/error.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

namespace fs = std::filesystem;
using storage::Database;
using storage::StudyDescription;

std::vector<StudyDescription> descriptions_in(Database& database) {
    std::vector<StudyDescription> descriptions;
    for (const storage::StudySummary& study : storage::list_studies(database)) {
        descriptions.push_back(storage::load_study(database, study.study_id));
    }
    return descriptions;
}

Deal deal_out(const std::vector<StudyDescription>& studies, int shards) {
    std::vector<StudySize> sizes;
    for (const StudyDescription& study : studies) {
        sizes.push_back(
            {static_cast<int>(study.noise_levels.size()), static_cast<int>(study.scenarios.size())});
    }
    return {sizes, shards};
}

ShardState state_of(Database& database, const storage::ShardRecord& mark,
                    const std::vector<StudyDescription>& studies) {
    ShardState state{{mark.shard, mark.shards}, 0, 0};
    const Deal deal = deal_out(studies, mark.shards);
    for (std::size_t k = 0; k < studies.size(); ++k) {
        const auto pending = storage::pending_units(database, studies[k].study.study_id);
        const std::set<int> left(pending.begin(), pending.end());
        int unit_index = 0;
        for (const storage::WorkUnitRecord& unit : studies[k].work_units) {
            const bool is_done = left.count(unit_index++) == 0;
            if (deal.owner(k, unit.noise_index, unit.scenario_index) != mark.shard) continue;
            ++state.units;
            if (is_done) ++state.units_done;
        }
    }
    return state;
}

// Of thousands of shards: a process may have about a thousand files open.
constexpr int max_open_files = 16;

struct ShardFile {
    fs::path path;
    std::unique_ptr<Database> database;  // null: closed
    ShardState state;
};

// Looks at every file and refuses the set with all that is wrong with it.
class ShardSet {
  public:
    explicit ShardSet(const std::vector<fs::path>& paths) {
        for (const fs::path& path : paths) take(path);
        name_missing();
        if (problems_.empty()) {
            computations_.require_same_simd_here();
            return;
        }
        std::string text = "These shards cannot be merged; nothing was written.";
        for (const std::string& problem : problems_) text += "\n  " + problem;
        throw storage::Error(text);
    }

    const std::vector<StudyDescription>& studies() const { return studies_; }
    const storage::SameComputation& computations() const { return computations_; }

    int count() const { return count_; }
    Database& file_of(int number) {
        ShardFile& file = files_.at(number);
        if (!file.database) {
            if (open_ == max_open_files) close_all();
            file.database = std::make_unique<Database>(Database::open_read_only(file.path));
            ++open_;
        }
        return *file.database;
    }

  private:
    void take(const fs::path& path) {
        ShardFile file{path, nullptr, {}};
        try {
            file.database = std::make_unique<Database>(Database::open_read_only(path));
            const auto mark = storage::read_shard(*file.database);
            if (!mark)
                return problem(path, "is not the file of a shard; `capstan study run --shard` writes one");
            auto studies = descriptions_in(*file.database);
            file.state = state_of(*file.database, *mark, studies);
            if (const std::string other = computations_.problem_of(*file.database); !other.empty())
                problem(path, other);
            for (const std::string& changed : storage::check_hashes(*file.database).problems)
                problem(path, "is damaged (" + changed + "); run it again, into a new file");
            if (open_ == max_open_files) close_all();
            ++open_;
            compare(path, file, std::move(studies));
        } catch (const storage::Error& error) {
            problems_.push_back(error.what());
        }
    }

    void close_all() {
        for (auto& [number, file] : files_) file.database.reset();
        open_ = 0;
    }

    void compare(const fs::path& path, ShardFile& file, std::vector<StudyDescription> studies) {
        const std::string words = words_of(file.state.shard);
        if (files_.empty()) {
            studies_ = std::move(studies);
            count_ = file.state.shard.count;
            first_ = path;
        } else if (file.state.shard.count != count_) {
            return problem(
                path, "is " + words + ", but " + first_.string() + " is one of " + std::to_string(count_));
        } else if (const std::string other = difference_from_first(studies); !other.empty()) {
            return problem(path, "belongs to another study than " + first_.string() + ": " + other);
        }
        if (!file.state.is_done()) {
            problem(path, "is unfinished: " + std::to_string(file.state.units_done) + " of its " +
                              std::to_string(file.state.units) +
                              " units are done; go on with: " + how_to_run(file.state.shard.number, path));
        }
        const auto [at, is_new] = files_.try_emplace(file.state.shard.number, std::move(file));
        if (!is_new)
            problem(path, "is " + words + ", and so is " + at->second.path.string() + "; leave one out");
    }

    std::string difference_from_first(const std::vector<StudyDescription>& studies) const {
        if (studies.size() != studies_.size()) {
            return "it has " + std::to_string(studies.size()) + " studies, not " +
                   std::to_string(studies_.size());
        }
        for (std::size_t k = 0; k < studies.size(); ++k) {
            if (std::string other = difference_between(studies[k], studies_[k]); !other.empty()) return other;
        }
        return {};
    }

    void name_missing() {
        for (int number = 1; number <= count_; ++number) {
            if (files_.count(number) != 0) continue;
            problems_.push_back(words_of({number, count_}) +
                                " is missing; name its file, or run it: " + how_to_run(number, "FILE"));
        }
    }

    std::string how_to_run(int number, const fs::path& path) const {
        return "capstan study run CONFIG --shard " + std::to_string(number) + "/" + std::to_string(count_) +
               " --db " + path.string();
    }

    void problem(const fs::path& path, const std::string& what) {
        problems_.push_back(path.string() + " " + what + ".");
    }

    std::vector<StudyDescription> studies_;
    std::map<int, ShardFile> files_;  // by shard number
    int count_ = 0, open_ = 0;
    fs::path first_;
    storage::SameComputation computations_;
    std::vector<std::string> problems_;
};

void copy_unit(Database& from, Database& to, std::int64_t from_id, std::int64_t to_id, int unit_index,
               const storage::WorkUnitRecord& unit) {
    const int s = unit.scenario_index;
    const int noise = unit.noise_index;
    if (unit.stage == "single_sensor") {
        storage::write_single_sensor(to, to_id, unit_index,
                                     {s, noise, storage::read_single_sensor(from, from_id, s, noise)});
    } else {
        storage::write_fusion(to, to_id, unit_index, storage::read_fusion(from, from_id, s, noise));
    }
}

RunEnd write_merged(ShardSet& shards, Database& merged, const RunOptions& options) {
    StudyProgress progress;
    for (const StudyDescription& study : shards.studies()) {
        progress.units += static_cast<int>(study.work_units.size());
    }
    std::vector<std::int64_t> ids;
    for (const StudyDescription& study : shards.studies()) ids.push_back(storage::begin_study(merged, study));
    StudyTimes times;
    const Deal deal = deal_out(shards.studies(), shards.count());
    for (std::size_t k = 0; k < ids.size(); ++k) {
        const StudyDescription& study = shards.studies()[k];
        if (const auto& computation = shards.computations().common())
            storage::write_computation(merged, ids[k], *computation);
        for (std::size_t unit = 0; unit < study.work_units.size(); ++unit) {
            if (options.stop != nullptr && options.stop->load()) return RunEnd::stopped;
            const storage::WorkUnitRecord& record = study.work_units[unit];
            const int owner = deal.owner(k, record.noise_index, record.scenario_index);
            copy_unit(shards.file_of(owner), merged, study.study.study_id, ids[k], static_cast<int>(unit),
                      record);
            ++progress.units_done;
            if (options.on_progress) options.on_progress(progress);
        }
        conclude_study(
            merged, ids[k],
            config::parse_config(study.study.config_toml, "the stored configuration of the shards").plan,
            options, times);
    }
    return RunEnd::complete;
}

}  // namespace

std::optional<ShardState> read_shard_state(Database& database) {
    const auto mark = storage::read_shard(database);
    if (!mark) return std::nullopt;
    return state_of(database, *mark, descriptions_in(database));
}

RunEnd merge_shards(const fs::path& merged, const std::vector<fs::path>& paths, const RunOptions& options) {
    RunEnd end = RunEnd::stopped;
    storage::write_new_database(merged, [&](Database& database) {
        ShardSet shards(paths);
        end = write_merged(shards, database, options);
        return end == RunEnd::complete;
    });
    return end;
}

}  // namespace capstan
