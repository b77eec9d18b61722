#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/help_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"

namespace capstan::cli {

namespace {

std::string title_of(const Command& command) {
    std::string title = fmt::format("capstan-{}", command.name);
    std::replace(title.begin(), title.end(), ' ', '-');
    return title;
}

// No text becomes a request or an escape; a hyphen stays one that can be copied.
std::string roff(std::string_view text) {
    std::string safe;
    for (const char letter : text) {
        const bool begins = safe.empty() || safe.back() == '\n';
        if (begins && (letter == '.' || letter == '\'')) safe += "\\&";
        if (letter == '\\') {
            safe += "\\e";
        } else if (letter == '-') {
            safe += "\\-";
        } else {
            safe += letter;
        }
    }
    return safe;
}

std::string head(const std::string& title, std::string_view summary) {
    std::string upper = title;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    std::string bare(summary);
    if (bare.ends_with('.')) bare.pop_back();
    return fmt::format(".TH {} 1 \"\" \"capstan {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(upper),
                       roff(program_version()), roff(title), roff(bare));
}

std::string paragraph(const std::string& term, const std::string& meaning) {
    return fmt::format(".TP\n{}\n{}\n", term, roff(meaning));
}

std::string exit_status(std::span<const ExitCodeMeaning> meanings = exit_code_meanings) {
    std::string text = ".SH EXIT STATUS\n";
    for (const ExitCodeMeaning& each : meanings)
        text += paragraph(fmt::format("\\fB{}\\fR", static_cast<int>(each.code)), std::string(each.meaning));
    return text;
}

std::string option_paragraph(const Option& option) {
    std::string term = option.letter == '\0' ? "" : fmt::format("\\fB\\-{}\\fR, ", option.letter);
    term += fmt::format("\\fB\\-\\-{}\\fR", roff(option.name));
    if (!option.is_flag()) term += fmt::format(" \\fI{}\\fR", roff(value_of(option)));
    return paragraph(term, meaning_of(option));
}

std::string synopsis(const Command& command) {
    std::string text = fmt::format(".SH SYNOPSIS\n\\fBcapstan {}\\fR", roff(command.name));
    for (const Argument& argument : command.arguments) {
        const bool optional = argument.need == ArgumentNeed::optional;
        text += fmt::format(" {}\\fI{}\\fR{}{}", optional ? "[" : "", roff(argument.name),
                            optional ? "]" : "", argument.need == ArgumentNeed::one_or_more ? "..." : "");
    }
    return text + " [\\fIoptions\\fR]\n";
}

std::string man_page_name(const Command& command) {
    return title_of(command) + ".1";
}

std::string man_page(const Command& command) {
    std::string text = head(title_of(command), command.summary) + synopsis(command) + ".SH DESCRIPTION\n" +
                       roff(command.description) + "\n";
    if (!command.arguments.empty()) text += ".SH ARGUMENTS\n";
    for (const Argument& argument : command.arguments)
        text += paragraph(fmt::format("\\fI{}\\fR", roff(argument.name)), meaning_of(argument));
    text += ".SH OPTIONS\n";
    for (const Option& option : command.options) text += option_paragraph(option);
    if (!command.examples.empty()) text += ".SH EXAMPLES\n.nf\n";
    for (const auto example : command.examples) text += roff(example) + "\n";
    if (!command.examples.empty()) text += ".fi\n";
    return text + exit_status(exit_codes_of(command)) + ".SH SEE ALSO\n\\fBcapstan\\fR(1)\n";
}

std::string program_man_page() {
    std::string text =
        head("capstan",
             "where to put tension sensors in a cable-conduit transmission, and why a bench disagrees "
             "with its model") +
        ".SH SYNOPSIS\n\\fBcapstan\\fR \\fICOMMAND\\fR [\\fIoptions\\fR]\n.SH DESCRIPTION\n"
        "Simulates the cable, draws noisy readings, estimates the tension everywhere, compares sensor layouts, and "
        "diagnoses recordings. Answers go to standard output, progress and messages to standard error.\n"
        ".SH COMMANDS\n";
    for (const Command& command : commands())
        text += paragraph(fmt::format("\\fB{}\\fR", roff(command.name)), std::string(command.summary));
    text += exit_status() + ".SH SEE ALSO\n";
    for (const Command& command : commands()) {
        const bool last = &command == &commands().back();
        text += fmt::format("\\fB{}\\fR(1){}\n", roff(title_of(command)), last ? "" : ",");
    }
    return text;
}

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
                     .value = "FOLDER",
                     .meaning = "Write every page into FOLDER instead."},
                    output_option,
                    help_option},
        .examples = {"capstan man | man -l -", "capstan man \"study run\" -o capstan-study-run.1"},
        .run = run_man};
}

}  // namespace capstan::cli
