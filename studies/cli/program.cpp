#include "capstan/cli/program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string_view>

#include "capstan/answers/glossary.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/cli/command.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/help_text.h"
#include "capstan/cli/output.h"
#include "capstan/cluster/shell_words.h"
#include "capstan/config/config_problem.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/platform/simd_width.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/reports/page_frame.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

bool asks_for_help(const std::string& word) {
    return word == "--help" || word == "-h";
}

// A command's name has one word or two.
struct FoundCommand {
    const Command* command = nullptr;
    std::size_t words = 0;
};

FoundCommand find_command_in(const std::vector<std::string>& words) {
    if (words.size() >= 2) {
        if (const Command* command = find_command(words[0] + " " + words[1])) return {command, 2};
    }
    if (const Command* command = find_command(words[0])) return {command, 1};
    return {};
}

enum class Wanted { command, explanation };

[[noreturn]] void refuse_unknown(const std::vector<std::string>& words, Wanted wanted = Wanted::command) {
    const bool grouped = !group_help(words[0]).empty();
    const bool second = grouped && words.size() >= 2;
    if (grouped && !second)
        throw UsageError(
            fmt::format("capstan {}: the command is not complete\n\n{}", words[0], group_help(words[0])));
    const std::string given = second ? words[0] + " " + words[1] : words[0];
    std::vector<std::string> known;
    for (const Command& command : commands()) {
        const std::string name(command.name);
        known.push_back(name);
        if (!second && name.find(' ') != std::string::npos) known.push_back(name.substr(0, name.find(' ')));
    }
    if (!second) known.insert(known.end(), {"help", "--help", "--version"});
    if (!second && wanted == Wanted::explanation) {
        for (const answers::GlossaryTerm& term : answers::glossary()) known.push_back(term.name);
    }
    const auto nearest = nearest_name(given, known);
    const bool is_option = given.starts_with("-");
    throw UsageError(fmt::format("capstan: unknown {} '{}'{}\nTry `capstan --help`.",
                                 is_option ? "option" : "command", given,
                                 nearest ? "; did you mean '" + *nearest + "'?" : ""));
}

// Of an installed program, or of a build folder.
ExitCode show_book() {
    const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    for (const char* place : {"../share/doc/capstan/book/index.html", "book/html/index.html"}) {
        if (const auto page = (here / place).lexically_normal(); std::filesystem::exists(page)) {
            write_standard_output(page.string() + "\n");
            return ExitCode::success;
        }
    }
    throw std::runtime_error(
        "the book is not installed; in a build folder `ninja book` builds it, and the Debian package capstan-doc "
        "contains it");
}

// "capstan help posterior_mean", "capstan help viscous friction"; empty for any other term.
std::string explained_terms(const std::vector<std::string>& words) {
    std::string name;
    for (const std::string& word : words) name += (name.empty() ? "" : " ") + word;
    if (name == "terms") return reports::answer_text(answers::glossary_answer());
    std::string text;
    for (const answers::GlossaryTerm& term : answers::terms_named(name)) {
        const std::string also = term.also.empty() ? "" : ", " + term.also;
        text += fmt::format("{}{}{} ({})\n{}\n", text.empty() ? "" : "\n", term.name, also, term.kind,
                            wrapped(term.meaning, 96, "  ", "  "));
    }
    return text;
}

ExitCode show_help(const std::vector<std::string>& words) {
    std::string text;
    if (words == std::vector<std::string>{"--book"}) return show_book();
    if (words.empty()) {
        text = program_help();
    } else if (const FoundCommand found = find_command_in(words); found.command != nullptr) {
        text = command_help(*found.command);
    } else if (words.size() == 1) {
        text = group_help(words[0]);
    }
    if (text.empty()) text = explained_terms(words);
    if (text.empty()) refuse_unknown(words, Wanted::explanation);
    write_standard_output(text);
    return ExitCode::success;
}

ExitCode dispatch(const std::vector<std::string>& words) {
    if (words.empty()) {
        write_standard_output(where_to_begin());
        return ExitCode::success;
    }
    if (words[0] == "--version") {
        write_standard_output("capstan " + program_version() + "\n");
        return ExitCode::success;
    }
    if (words[0] == "help") return show_help({words.begin() + 1, words.end()});
    const auto options_end = std::find(words.begin(), words.end(), "--");
    if (std::any_of(words.begin(), options_end, asks_for_help)) {
        std::vector<std::string> named(words.begin(),
                                       std::find_if(words.begin(), options_end, asks_for_help));
        named.resize(std::min<std::size_t>(named.size(), 2));
        if (!named.empty() && group_help(named[0]).empty()) named.resize(1);
        return show_help(named);
    }
    const FoundCommand found = find_command_in(words);
    if (found.command == nullptr) refuse_unknown(words);
    storage::set_command("capstan " + cluster::as_typed(words));
    const auto rest = words.begin() + static_cast<std::ptrdiff_t>(found.words);
    const Invocation invocation = parse_command_line(*found.command, {rest, words.end()});
    for (const Option& option : found.command->options) {
        if (option.check != nullptr && invocation.has(option.name)) option.check(invocation, option);
    }
    return found.command->run(invocation);
}

}  // namespace

std::string program_version() {
    return reports::program_version();
}

ExitCode run_program(const std::vector<std::string>& words) {
    try {
        limit_simd_from_environment();
        return dispatch(words);
    } catch (const UsageError& error) {
        say(error.what());
        return ExitCode::wrong_input;
    } catch (const InvalidInput& error) {
        for (const std::string& problem : error.problems()) say("capstan: " + problem);
        return ExitCode::wrong_input;
    } catch (const storage::Error& error) {
        say(std::string("capstan: ") + error.what());
        return ExitCode::database_problem;
    } catch (const std::bad_alloc&) {
        say("capstan: out of memory; try fewer repetitions or fewer samples");
        return ExitCode::failure;
    } catch (const std::exception& error) {
        say(std::string("capstan: ") + error.what());
        return ExitCode::failure;
    }
}

void limit_simd(std::string_view wanted, std::string_view origin) {
    if (limit_simd_width(wanted)) return;
    throw UsageError(fmt::format("{}{}: this program on this processor has {}", origin, wanted,
                                 fmt::join(simd_widths(), ", ")));
}

bool simd_is_limited() {
    const char* const wanted = std::getenv("CAPSTAN_SIMD");
    return wanted != nullptr && !std::string_view(wanted).empty();
}

void limit_simd_from_environment() {
    if (simd_is_limited()) limit_simd(std::getenv("CAPSTAN_SIMD"), "CAPSTAN_SIMD=");
}

}  // namespace capstan::cli
