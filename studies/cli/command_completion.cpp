#include <fmt/format.h>

#include <algorithm>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"

namespace capstan::cli {

namespace {

bool is_in(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string first_word(const Command& command) {
    return std::string(command.name.substr(0, command.name.find(' ')));
}

std::vector<std::string> first_words() {
    std::vector<std::string> words;
    for (const Command& command : commands()) {
        if (!is_in(words, first_word(command))) words.push_back(first_word(command));
    }
    words.insert(words.end(), {"help", "--help", "--version"});
    return words;
}

// 'study' -> run, resume, ...; empty for a command of one word.
std::vector<std::string> second_words(const std::string& group) {
    std::vector<std::string> words;
    for (const Command& command : commands()) {
        if (command.name.starts_with(group + " ")) words.emplace_back(command.name.substr(group.size() + 1));
    }
    return words;
}

std::vector<std::string> option_words(const Command& command) {
    std::vector<std::string> words;
    for (const Option& option : command.options) {
        words.push_back(fmt::format("--{}", option.name));
        if (option.letter != '\0') words.push_back(fmt::format("-{}", option.letter));
    }
    return words;
}

// Lines of a case statement. `pattern` takes what is typed before and the words that may follow.
std::string cases(std::string_view pattern, const std::string& before,
                  const std::vector<std::string>& words) {
    return fmt::format(fmt::runtime(pattern), before, fmt::join(words, " "));
}

std::string group_cases(std::string_view pattern) {
    std::string text;
    for (const std::string& word : first_words()) {
        const auto seconds = second_words(word);
        if (!seconds.empty()) text += cases(pattern, word, seconds);
    }
    return text + cases(pattern, "help", first_words());
}

std::string option_cases(std::string_view pattern) {
    std::string text;
    for (const Command& command : commands())
        text += cases(pattern, std::string(command.name), option_words(command));
    return text;
}

std::string choice_cases(std::string_view pattern) {
    std::string text;
    for (const Command& command : commands()) {
        for (const Option& option : command.options)
            if (!option.choices.empty())
                text += cases(pattern, fmt::format("{} --{}", command.name, option.name), option.choices);
    }
    return text;
}

// Commands of two words.
std::string command_cases() {
    std::string text;
    for (const Command& command : commands()) {
        if (command.name.find(' ') != std::string_view::npos)
            text += fmt::format("        '{0}') command='{0}' ;;\n", command.name);
    }
    return text;
}

std::string bash_completion() {
    std::string text =
        "# bash completion for capstan, written by `capstan completion bash`. Where nothing is known, files.\n"
        "_capstan() {\n"
        "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
        "    local command=${COMP_WORDS[1]} words= options=\n"
        "    COMPREPLY=()\n";
    text += fmt::format(
        "    if [[ $COMP_CWORD -eq 1 ]]; then\n"
        "        COMPREPLY=($(compgen -W '{}' -- \"$current\"))\n"
        "        return\n"
        "    fi\n",
        fmt::join(first_words(), " "));
    text +=
        "    if [[ $COMP_CWORD -eq 2 ]]; then\n"
        "        case $command in\n" +
        group_cases("            {}) words='{}' ;;\n") +
        "        esac\n"
        "        if [[ -n $words ]]; then\n"
        "            COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
        "            return\n"
        "        fi\n"
        "    fi\n"
        "    case \"$command ${COMP_WORDS[2]}\" in\n" +
        command_cases() +
        "    esac\n"
        "    case \"$command $before\" in\n" +
        choice_cases("        '{}') words='{}' ;;\n") +
        "    esac\n"
        "    if [[ -n $words ]]; then\n"
        "        COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
        "        return\n"
        "    fi\n"
        "    [[ $current == -* ]] || return 0\n"
        "    case $command in\n" +
        option_cases("        '{}') options='{}' ;;\n") +
        "    esac\n"
        "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
        "}\n"
        "complete -o default -F _capstan capstan\n";
    return text;
}

std::string zsh_completion() {
    std::string text =
        "#compdef capstan\n"
        "# zsh completion for capstan, written by `capstan completion zsh`. Where nothing is known, files.\n"
        "_capstan() {\n"
        "    local command=${words[2]} before=${words[CURRENT-1]} given=${words[CURRENT]} second=${words[3]}\n"
        "    local -a known\n";
    text += fmt::format("    if (( CURRENT == 2 )); then\n        compadd -- {}\n        return\n    fi\n",
                        fmt::join(first_words(), " "));
    text +=
        "    if (( CURRENT == 3 )); then\n        case $command in\n" +
        group_cases("            {}) known=({}) ;;\n") +
        "        esac\n"
        "        if (( ${#known} )); then\n            compadd -- $known\n            return\n        fi\n    fi\n"
        "    case \"$command $second\" in\n" +
        command_cases() + "    esac\n    case \"$command $before\" in\n" +
        choice_cases("        '{}') known=({}) ;;\n") +
        "    esac\n    if (( ${#known} )); then\n        compadd -- $known\n        return\n    fi\n"
        "    if [[ $given != -* ]]; then\n        _files\n        return\n    fi\n    case $command in\n" +
        option_cases("        '{}') known=({}) ;;\n");
    return text +
           "    esac\n    compadd -- $known\n}\n"
           "if [[ ${zsh_eval_context[-1]} == loadautofunc ]]; then _capstan \"$@\"; else compdef _capstan capstan; fi\n";
}

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
