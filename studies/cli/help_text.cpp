#include "capstan/cli/help_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

#include "capstan/cli/commands.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

constexpr std::size_t help_width = 100;

// Terms in the first column, meanings in the second.
struct Entry {
    std::string term;
    std::string meaning;
};

std::string two_columns(const std::vector<Entry>& entries) {
    std::size_t column = 0;
    for (const Entry& entry : entries) column = std::max(column, entry.term.size() + 4);
    const std::string indent(column, ' ');
    std::string text;
    for (const Entry& entry : entries) {
        text += wrapped(entry.meaning, help_width, fmt::format("  {:<{}}", entry.term, column - 2), indent) +
                "\n";
    }
    return text;
}

std::string exit_codes(std::span<const ExitCodeMeaning> meanings = exit_code_meanings) {
    std::vector<Entry> entries;
    for (const ExitCodeMeaning& each : meanings) {
        entries.push_back({std::to_string(static_cast<int>(each.code)), std::string(each.meaning)});
    }
    return "Exit codes:\n" + two_columns(entries);
}

std::string usage_line(const Command& command) {
    std::string line = fmt::format("capstan {}", command.name);
    for (const Argument& argument : command.arguments) {
        switch (argument.need) {
            case ArgumentNeed::required:
                line += fmt::format(" {}", argument.name);
                break;
            case ArgumentNeed::optional:
                line += fmt::format(" [{}]", argument.name);
                break;
            case ArgumentNeed::one_or_more:
                line += fmt::format(" {}...", argument.name);
                break;
        }
    }
    return line + " [options]";
}

Entry option_entry(const Option& option) {
    std::string term = option.letter == '\0' ? "    " : fmt::format("-{}, ", option.letter);
    term += fmt::format("--{}", option.name);
    if (!option.is_flag()) term += " " + value_of(option);
    return {std::move(term), meaning_of(option)};
}

std::string with_default(std::string_view meaning, std::string_view default_value) {
    std::string text(meaning);
    if (!default_value.empty() && default_value != "-") text += fmt::format(" Default: {}.", default_value);
    return text;
}

std::vector<Entry> summaries(std::string_view group) {
    std::vector<Entry> entries;
    for (const Command& command : commands()) {
        const bool belongs = group.empty() || command.name.starts_with(std::string(group) + " ");
        if (belongs) entries.push_back({std::string(command.name), std::string(command.summary)});
    }
    return entries;
}

}  // namespace

std::string value_of(const Option& option) {
    return option.value.empty() ? fmt::format("{}", fmt::join(option.choices, "|"))
                                : std::string(option.value);
}

std::string meaning_of(const Option& option) {
    return with_default(option.meaning, option.default_value);
}

std::string meaning_of(const Argument& argument) {
    return with_default(argument.meaning, argument.default_value);
}

std::string where_to_begin() {
    return "capstan finds where to put tension sensors in a cable-conduit (Bowden) transmission.\n\n"
           "Begin with one of these:\n"
           "  capstan config default -o my.toml        every setting, explained\n"
           "  capstan study run configs/quick.toml     a study, in under a second\n"
           "  capstan recommend                        which sensors, where, how many\n"
           "  capstan report -o report.html            the figures behind it\n\n"
           "capstan --help lists all commands.\n";
}

std::string program_help() {
    std::vector<Entry> entries = summaries("");
    entries.push_back({"help COMMAND", "Explain a command, as does capstan COMMAND --help."});
    entries.push_back({"help --book", "Print where the book is; open it in a browser."});
    entries.push_back(
        {"help TERM", "Explain a term, layout, method or effect; `capstan help terms` lists them."});
    entries.push_back({"--version", "Print the version."});
    return "Usage: capstan COMMAND [options]\n\n"
           "Finds where to put tension sensors in a cable-conduit (Bowden) transmission: simulates the cable,\n"
           "draws noisy readings, estimates the tension everywhere, and compares sensor layouts.\n\n"
           "Commands:\n" +
           two_columns(entries) +
           "\nAnswers go to standard output, progress and messages to standard error.\n\n"
           "Environment:\n"
           "  CAPSTAN_SIMD  Widest vector instructions to use, so that different processors give the same last\n"
           "                bits; `capstan doctor` prints those in use. Default: the widest of the processor.\n\n" +
           exit_codes();
}

std::string command_help(const Command& command) {
    std::string text = fmt::format("Usage: {}\n\n{}\n", usage_line(command),
                                   wrapped(command.description, help_width, "", ""));
    std::vector<Entry> arguments;
    for (const Argument& argument : command.arguments)
        arguments.push_back({std::string(argument.name), meaning_of(argument)});
    if (!arguments.empty()) text += "\nArguments:\n" + two_columns(arguments);
    std::vector<Entry> options;
    for (const Option& option : command.options) options.push_back(option_entry(option));
    text += "\nOptions:\n" + two_columns(options);
    text += "\nTime:\n" + wrapped(command.time, help_width, "  ", "  ") + "\n";
    if (!command.examples.empty()) text += "\nExamples:\n";
    for (const auto example : command.examples) text += fmt::format("  {}\n", example);
    return text + "\n" + exit_codes(exit_codes_of(command));
}

std::string group_help(std::string_view group) {
    const std::vector<Entry> entries = summaries(group);
    if (entries.empty()) return "";
    return fmt::format("Usage: capstan {} COMMAND [options]\n\nCommands:\n{}\n", group,
                       two_columns(entries)) +
           exit_codes();
}

}  // namespace capstan::cli
