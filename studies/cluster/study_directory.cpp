#include "capstan/cluster/study_directory.h"

#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "capstan/cluster/shard_record.h"
#include "capstan/placement/study_merge.h"
#include "capstan/placement/study_shard.h"
#include "capstan/platform/files.h"
#include "capstan/storage/error.h"
#include "capstan/worlds/world_shard.h"

namespace capstan::cluster {

namespace fs = std::filesystem;

fs::path StudyDirectory::result_file(int number, const std::string& before_ending) const {
    return path / ("shard-" + std::to_string(number) + "-of-" + std::to_string(shards) + before_ending +
                   (batch ? ".json" : ".db"));
}

fs::path StudyDirectory::shard_file(int number) const {
    return result_file(number, "");
}

fs::path StudyDirectory::second_file(int number, const std::string& worker) const {
    return result_file(number, "-by-" + worker);
}

fs::path StudyDirectory::shard_log(int number) const {
    return path / ("logs/shard-" + std::to_string(number) + ".log");
}

// From the folder, so that two studies never share a name: the 32-bit FNV-1a hash of its path.
std::string StudyDirectory::job_name() const {
    std::uint32_t hash = 2166136261u;
    for (const char c : path.string()) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    char text[32];
    std::snprintf(text, sizeof text, "capstan-%08x", static_cast<unsigned>(hash));
    return text;
}

std::vector<std::string> Batch::words(int number, int processors) const {
    std::vector<std::string> words = {command};
    if (command == "gap-trial")
        words.insert(words.end(), {"--keep", inputs.front(), "--case", std::to_string(number)});
    else
        words.push_back(inputs.at(static_cast<std::size_t>(number - 1)));
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--jobs", std::to_string(processors), "--json", "--progress", "none"});
    return words;
}

std::string submission_text(const StudyDirectory& directory) {
    nlohmann::ordered_json json = {{"name", directory.name},
                                   {"shards", directory.shards},
                                   {"processors_per_shard", directory.processors_per_shard},
                                   {"program", directory.program.string()},
                                   {"scheduler", directory.scheduler},
                                   {"simd", directory.simd}};
    if (directory.batch)
        json["batch"] = {{"command", directory.batch->command},
                         {"options", directory.batch->options},
                         {"inputs", directory.batch->inputs}};
    return json.dump(2) + "\n";
}

StudyDirectory read_directory(const fs::path& path) {
    StudyDirectory directory;
    directory.path = fs::absolute(path).lexically_normal();
    if (!directory.path.has_filename()) directory.path = directory.path.parent_path();
    if (!fs::exists(directory.submission_file())) {
        throw std::runtime_error(path.string() +
                                 " holds no submitted study; `capstan study submit CONFIG --directory " +
                                 path.string() + "` makes one");
    }
    try {
        const auto json = nlohmann::json::parse(read_file(directory.submission_file()));
        directory.name = json.at("name");
        directory.shards = json.at("shards");
        directory.processors_per_shard = json.at("processors_per_shard");
        directory.program = json.at("program").get<std::string>();
        directory.scheduler = json.value("scheduler", directory.scheduler);
        directory.simd = json.value("simd", "");
        if (json.contains("batch")) {
            const auto& batch = json.at("batch");
            directory.batch = Batch{batch.at("command"), batch.at("options"), batch.at("inputs")};
        }
    } catch (const nlohmann::json::exception& error) {
        throw std::runtime_error(directory.submission_file().string() +
                                 " is damaged; submit the study into a new folder. (" + error.what() + ")");
    }
    return directory;
}

ShardProgress progress_of(const StudyDirectory& directory, int number) {
    ShardProgress progress;
    const fs::path file = file_of_shard(directory, number);
    progress.was_begun = fs::exists(file) || fs::exists(directory.shard_log(number));
    if (directory.batch) {
        units::DiskFolder leases = directory.leases();
        progress.units = 1;
        progress.units_done = units::read_unit_record(leases, number) ? 1 : 0;
        return progress;
    }
    if (!fs::exists(file) || fs::file_size(file) == 0) return progress;
    try {
        storage::Database database = storage::Database::open_read_only(file);
        if (const auto worlds = read_world_shard_state(database)) {
            progress.units_done = static_cast<int>(worlds->trials_done);
            progress.units = static_cast<int>(worlds->trials);
        } else if (const auto state = read_shard_state(database)) {
            progress.units_done = state->units_done;
            progress.units = state->units;
        }
    } catch (const storage::Error& error) {
        progress.problem = error.what();
    }
    return progress;
}

}  // namespace capstan::cluster
