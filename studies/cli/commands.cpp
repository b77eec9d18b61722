#include "capstan/cli/commands.h"

#include <algorithm>

namespace capstan::cli {

namespace {

constexpr std::string_view short_time = "Less than 2 s.";

// Measured on a machine with two cores of 2023.
struct CommandTime {
    std::string_view command;
    std::string_view words;
};
constexpr CommandTime times[] = {
    {"study run",
     "quick.toml takes a second, paper.toml some seconds, a sweep minutes to hours: `capstan study plan` estimates it. "
     "Shows progress and the time left."},
    {"study resume", "As long as `study run` for the units that are left. Shows progress and the time left."},
    {"study extend",
     "As long as a study with the new number of repetitions. Shows progress and the time left."},
    {"study replay", "As long as one repetition of the study, mostly less than 2 s."},
    {"study merge", "Some seconds per gigabyte of shards. Shows progress."},
    {"study plan",
     "The --seconds of its pilot, and the true motion of every study of the sweep: 10 s for configs/atlas.toml. Shows "
     "progress and the time left."},
    {"study submit",
     "The pilot takes a second, or longer where `study plan` does; the rest less than 2 s for some hundred shards, 20 s "
     "for 100,000. Shows progress of the pilot and the time left."},
    {"study status", "Less than 2 s for some hundred shards, in proportion to their number."},
    {"study work", "Until no shard is left, so as long as the study or batch. Shows progress."},
    {"batch",
     "Less than 2 s for some hundred inputs; the work itself is the scheduler's or `capstan study work`'s."},
    {"place",
     "10 s for 11 nodes and 1000 repetitions; twice as long for each further node, and in proportion to the "
     "repetitions; a configuration with [uncertainty] takes minutes. Shows progress and the time left."},
    {"budget", "As long as `place` for each of the cables. Shows progress and the time left of each."},
    {"bands",
     "As long as `place` with all sets on all worlds, twice: minutes. Shows progress and the time left."},
    {"sensitivity",
     "20 s for configs/paper.toml: some hundred searches as `place` makes, with few repetitions. Shows progress and "
     "the time left."},
    {"duty", "As long as the recording, divided by about 1000. Shows progress and the time left."},
    {"estimate",
     "A minute of recording at 100 Hz takes about 1 s for each cable, that times the number of sensors with --leave-out each; "
     "a study's configuration takes 15 s. Shows progress and the time left."},
    {"calibrate",
     "Seconds to a minute, in proportion to the length of the recording and to the square of its runs. Shows progress and "
     "the time left."},
    {"diagnose",
     "Seconds to some minutes, by the length of the recording and by what it finds; --cost says how long on this machine. "
     "Shows progress and the time left."},
    {"gap-trial",
     "Seconds to minutes for each case; --generate-only takes seconds. Shows progress and the time left."},
    {"report",
     "Less than 2 s; as PDF and with --figures about half a second for each figure, which the browser takes. Shows "
     "progress and the time left."},
    {"import", "About a second for 10 MB of log. Shows progress."},
    {"export", "About a second for a million rows."},
    {"serve", "Until it is stopped."},
    {"query", "As long as the query, at most --time-limit."},
    {"simulate", "A hundredth of the simulated time, mostly less than 2 s."},
    {"paper solver", "100 times --seconds, 10 s by default. Shows progress and the time left."},
    {"paper estimation",
     "Some ten times as long as the study itself, about a minute. Shows progress and the time left."},
    {"doctor", "About half a minute for a gigabyte of the database. Shows progress and the time left."},
};

}  // namespace

std::string_view time_of(const Command& command) {
    const auto found = std::ranges::find(times, command.name, &CommandTime::command);
    return found == std::end(times) ? short_time : found->words;
}

const std::vector<Command>& commands() {
#define CAPSTAN_CALL(name) name##_command(),
    static const std::vector<Command> all = {CAPSTAN_COMMANDS(CAPSTAN_CALL)};
#undef CAPSTAN_CALL
    return all;
}

std::vector<ExitCodeMeaning> exit_codes_of(const Command& command) {
    const bool uses_database = std::any_of(command.options.begin(), command.options.end(),
                                           [](const Option& option) { return option.name == "db"; });
    std::vector<ExitCodeMeaning> codes;
    for (const ExitCodeMeaning& each : exit_code_meanings) {
        if (each.code == ExitCode::database_problem && !uses_database) continue;
        if (each.code != ExitCode::stopped)
            codes.push_back(each);
        else if (!command.when_stopped.empty())
            codes.push_back({each.code, command.when_stopped});
    }
    return codes;
}

const Command* find_command(std::string_view name) {
    for (const Command& command : commands()) {
        if (command.name == name) return &command;
    }
    return nullptr;
}

}  // namespace capstan::cli
