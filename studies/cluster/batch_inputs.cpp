#include "capstan/cluster/batch_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "capstan/cable/invalid_input.h"

namespace capstan::cluster {

namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& named) {
    return fs::weakly_canonical(fs::absolute(named)).string();
}

// The recordings or configurations in a folder, or the file itself.
std::vector<std::string> inputs_in(const std::string& named, const std::string& command) {
    const fs::path path = absolute(named);
    if (!fs::exists(path)) throw InvalidInput({named + " does not exist"});
    if (!fs::is_directory(path)) return {path.string()};
    std::vector<std::string> inputs;
    for (const auto& entry : fs::directory_iterator(path)) {
        fs::path sidecar = entry.path();
        sidecar.replace_extension(".json");
        const bool is_recording = entry.path().extension() == ".csv" && fs::exists(sidecar);
        const bool is_config = entry.path().extension() == ".toml";
        if (command == "diagnose" ? is_recording : is_config) inputs.push_back(entry.path().string());
    }
    if (inputs.empty())
        throw InvalidInput(
            {fmt::format("{} holds no {}", named,
                         command == "diagnose" ? "recording (NAME.csv with NAME.json beside it)"
                                               : "configuration (.toml)")});
    std::sort(inputs.begin(), inputs.end());
    return inputs;
}

}  // namespace

std::vector<std::string> batch_inputs(const std::string& command, const std::vector<std::string>& named) {
    if (command == "gap-trial") {
        if (named.size() != 1) throw InvalidInput({"a batch of gap-trial has one trial's folder"});
        return {absolute(named.front())};
    }
    std::vector<std::string> inputs;
    for (const std::string& each : named)
        for (std::string& input : inputs_in(each, command)) inputs.push_back(std::move(input));
    return inputs;
}

int shards_of(const Batch& batch) {
    if (batch.command != "gap-trial") return static_cast<int>(batch.inputs.size());
    const fs::path trial = batch.inputs.front();
    if (!fs::exists(trial / "labels.sha256"))
        throw InvalidInput(
            {fmt::format("{0} holds no trial with sealed labels; `capstan gap-trial --keep {0} "
                         "--generate-only` makes one",
                         trial.string())});
    return static_cast<int>(
        std::count_if(fs::directory_iterator(trial), fs::directory_iterator(),
                      [](const auto& entry) { return entry.path().extension() == ".csv"; }));
}

}  // namespace capstan::cluster
