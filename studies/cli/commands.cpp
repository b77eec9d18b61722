#include "capstan/cli/commands.h"

#include <algorithm>

namespace capstan::cli {

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
