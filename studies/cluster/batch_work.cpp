#include "capstan/cluster/batch_work.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "capstan/cluster/shell_words.h"
#include "capstan/platform/child_process.h"
#include "capstan/storage/integrity/computed_with.h"

namespace capstan::cluster {

using nlohmann::json;
using units::WorkEnd;

namespace {

constexpr int refused = 2;  // exit code: the input is wrong

}  // namespace

units::ResultUnits units_of(const StudyDirectory& directory) {
    const Batch& batch = *directory.batch;
    units::ResultUnits units{fmt::format("\"command\": {}, \"options\": {}, ",
                                         units::quoted_json(batch.command), json(batch.options).dump()),
                             batch.inputs, storage::words_of(storage::this_computation())};
    if (batch.command == "gap-trial") {
        units.inputs.clear();
        for (int number = 1; number <= directory.shards; ++number)
            units.inputs.push_back(fmt::format("{} case {}", batch.inputs.front(), number));
    }
    return units;
}

units::Result run_unit(const StudyDirectory& directory, int unit, const WorkOptions& options,
                       const std::function<bool()>& is_unwanted) {
    std::vector<std::string> words;
    if (!directory.simd.empty()) words = {"env", "CAPSTAN_SIMD=" + directory.simd};
    words.push_back(directory.program.string());
    const auto command = directory.batch->words(unit, directory.processors_per_shard);
    words.insert(words.end(), command.begin(), command.end());
    std::atomic<bool> stop{false};
    CommandOutput done;
    {
        const Watcher watcher(stop, options.run.stop, is_unwanted);
        Patience patience;
        patience.unwanted = &stop;
        done = run_command(words, {}, patience);
    }
    if (stop.load()) return {WorkEnd::stopped};
    if (done.exit_code == refused)
        return {WorkEnd::complete,
                fmt::format("{{\"refused\": {}}}\n", units::quoted_json(without_line_end(done.messages)))};
    if (done.exit_code == 0 && json::accept(done.output)) return {WorkEnd::complete, done.output};
    if (options.say)
        options.say(fmt::format("shard {} failed with exit code {}: {}", unit, done.exit_code,
                                without_line_end(done.messages)));
    return {WorkEnd::failed};
}

}  // namespace capstan::cluster
