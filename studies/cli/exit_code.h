#pragma once

#include <span>
#include <string_view>

namespace capstan::cli {

enum class ExitCode : int {
    success = 0,
    failure = 1,
    wrong_input = 2,
    database_problem = 3,
    stopped = 130,
};

struct ExitCodeMeaning {
    ExitCode code;
    std::string_view meaning;
};

inline constexpr ExitCodeMeaning exit_code_meanings[] = {
    {ExitCode::success, "done"},
    {ExitCode::failure, "failed while running, for example because an output file cannot be written"},
    {ExitCode::wrong_input, "wrong usage, configuration or query; nothing was done"},
    {ExitCode::database_problem, "the results database cannot be used, or has no such study"},
    {ExitCode::stopped, "stopped by Ctrl-C or a request to terminate; capstan study resume continues"},
};

}  // namespace capstan::cli
