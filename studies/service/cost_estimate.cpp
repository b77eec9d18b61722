#include "capstan/service/cost_estimate.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include "capstan/platform/child_process.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/files.h"
#include "capstan/platform/progress.h"
#include "capstan/service/import_folder.h"
#include "capstan/service/job_results.h"

namespace capstan::service {

namespace {

constexpr std::chrono::seconds plan_limit{60};
constexpr std::chrono::seconds pilot_limit{6};
constexpr std::size_t max_output = 1 << 20;
constexpr int pilot_nice_increment = 5;

constexpr int wrong_input = 2;  // the exit code of a command

// A command that ended without an answer. Of a wrong input the start says what is wrong. Any other one was
// too slow or was killed: the work may be long.
ordered_json unknown_cost(const CommandOutput& ended) {
    if (ended.exit_code == wrong_input) return {{"known", false}};
    return {{"known", false}, {"may_be_long", true}};
}

int threads_of(const JobCommands& commands) {
    return std::max(
        1, static_cast<int>(commands.threads > 0 ? commands.threads : std::thread::hardware_concurrency()));
}

struct TimeLeft {
    std::optional<double> seconds;
    bool of_one_part = false;  // the work has several parts, whose progress begins anew: others follow
};

// By the progress that a command told. The end of a part says nothing of the next one.
TimeLeft time_left(const std::string& messages) {
    TimeLeft left;
    double fraction = 0.0;
    std::istringstream lines(messages);
    for (std::string line; std::getline(lines, line);) {
        const auto event = read_progress_json(line);
        if (!event) continue;
        left.of_one_part |= event->fraction < fraction;
        fraction = event->fraction;
        if (event->seconds_left && event->fraction < 1.0) left.seconds = event->seconds_left;
    }
    return left;
}

}  // namespace

ordered_json cost_of_command(const JobCommands& commands, const std::vector<std::string>& words) {
    std::vector<std::string> all{commands.program};
    all.insert(all.end(), words.begin(), words.end());
    const std::string threads = std::to_string(commands.threads);
    for (const char* word : {"--json", "-o", "/dev/null", "--progress", "json", "--jobs", threads.c_str()})
        all.emplace_back(word);
    const double begin_s = wall_time_s();
    const CommandOutput ended = run_command(all, {.nice_increment = pilot_nice_increment},
                                            {pilot_limit, max_output, commands.ending});
    const double took_s = wall_time_s() - begin_s;
    if (!ended.is_late)
        return ended.exit_code == 0 ? ordered_json{{"known", true}, {"seconds", took_s}, {"studies", 1}}
                                    : unknown_cost(ended);
    const TimeLeft left = time_left(ended.messages);
    ordered_json cost = {{"known", true}, {"seconds", took_s + left.seconds.value_or(0.0)}, {"studies", 1}};
    if (left.of_one_part || !left.seconds) cost["is_at_least"] = true;
    return cost;
}

ordered_json cost_of_studies(const JobCommands& commands, const std::string& toml, bool is_over_worlds) {
    const PrivateFolder folder("capstan-cost");
    const std::string file = (folder.path() / "study.toml").string();
    write_file(file, toml);
    if (is_over_worlds) return cost_of_command(commands, {"place", file});
    const CommandOutput ended =
        run_command({commands.program, "study", "plan", file, "--json", "--seconds", "1"},
                    {.nice_increment = pilot_nice_increment, .processor_s = 60},
                    {plan_limit, max_output, commands.ending});
    const auto plan = nlohmann::json::parse(ended.output, nullptr, false);
    if (ended.exit_code != 0 || !plan.is_object()) return unknown_cost(ended);
    const double processor_s = 3600.0 * plan.value("one_run_core_hours", 0.0);
    return {{"known", true},
            {"studies", plan.value("studies", 1)},
            {"processor_s", processor_s},
            {"seconds", processor_s / threads_of(commands)}};
}

ordered_json cost_of_diagnosis(const JobCommands& commands, const std::string& log) {
    const CommandOutput ended =
        run_command({commands.program, "diagnose", log, "--cost", "--json", "--progress", "none", "--jobs",
                     std::to_string(commands.threads)},
                    {.nice_increment = pilot_nice_increment, .processor_s = 60},
                    {plan_limit, max_output, commands.ending});
    if (ended.exit_code == wrong_input)
        return {
            {"known", false},
            {"problems", plain_messages(ended.messages, std::filesystem::path(log).parent_path().string())}};
    const auto cost = nlohmann::json::parse(ended.output, nullptr, false);
    if (ended.exit_code != 0 || !cost.is_object()) return unknown_cost(ended);
    return {{"known", true},
            {"studies", 1},
            {"min_seconds", cost.value("min_seconds", 0.0)},
            {"seconds", cost.value("max_seconds", 0.0)}};
}

ordered_json cost_of_diagnosis(const JobCommands& commands, const UploadedRecording& recording) {
    const PrivateFolder folder("capstan-cost");
    std::filesystem::path file = folder.path() / safe_file_name(recording.title);
    file.replace_extension(".csv");
    write_file(file, recording.log);
    write_file(std::filesystem::path(file).replace_extension(".json"), recording.sidecar);
    return cost_of_diagnosis(commands, file.string());
}

}  // namespace capstan::service
