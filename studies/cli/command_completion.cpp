#include "capstan/cli/command.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/help_text.h"
#include "capstan/cli/output.h"

namespace capstan::cli {

namespace {

ExitCode run_completion(const Invocation& invocation) {
    const std::string& shell = invocation.argument("SHELL");
    if (shell != "bash" && shell != "zsh")
        throw UsageError("capstan completion: SHELL is '" + shell + "', but must be bash or zsh");
    deliver(invocation, shell == "bash" ? bash_completion() : zsh_completion());
    return ExitCode::success;
}

}  // namespace

Command completion_command() {
    return {.name = "completion",
            .summary = "Print a script that completes commands and options in bash or zsh.",
            .description =
                "Prints a completion script for a shell, generated from the same table as this help. An "
                "installed capstan already includes it; from a build folder, load it as shown below.",
            .arguments = {{"SHELL", "bash or zsh."}},
            .options = {output_option, help_option},
            .examples = {"source <(capstan completion bash)", "capstan completion zsh -o ~/.zfunc/_capstan"},
            .run = run_completion};
}

}  // namespace capstan::cli
