#include <filesystem>

#include "capstan/cli/command.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/help_text.h"
#include "capstan/cli/output.h"

namespace capstan::cli {

namespace {

void write_all(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write_file(folder / "capstan.1", program_man_page());
    for (const Command& command : commands()) write_file(folder / man_page_name(command), man_page(command));
}

ExitCode run_man(const Invocation& invocation) {
    if (invocation.has("directory")) {
        write_all(invocation.text("directory"));
        return ExitCode::success;
    }
    if (!invocation.has_argument("COMMAND")) {
        deliver(invocation, program_man_page());
        return ExitCode::success;
    }
    const std::string& name = invocation.argument("COMMAND");
    const Command* command = find_command(name);
    if (command == nullptr)
        throw UsageError("capstan man: there is no command '" + name + "'; `capstan --help` lists them");
    deliver(invocation, man_page(*command));
    return ExitCode::success;
}

}  // namespace

Command man_command() {
    return {
        .name = "man",
        .summary = "Print a manual page.",
        .description =
            "Prints the manual page of capstan or of one command in the format of man(1); --directory "
            "writes all pages. An installed capstan already includes them: `man capstan-study-run`.",
        .arguments = {{"COMMAND", "The command, for example \"study run\"; a name of two words needs quotes.",
                       ArgumentNeed::optional}},
        .options = {{.name = "directory",
                     .kind = OptionKind::string,
                     .value = "FOLDER",
                     .meaning = "Write every page into FOLDER instead."},
                    output_option,
                    help_option},
        .examples = {"capstan man | man -l -", "capstan man \"study run\" -o capstan-study-run.1"},
        .run = run_man};
}

}  // namespace capstan::cli
