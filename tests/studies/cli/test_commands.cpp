#include <gtest/gtest.h>

#include "capstan/cli/command.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/help_text.h"

namespace capstan::cli {
namespace {

TEST(Commands, HelpNamesEveryOptionAndArgument) {
    for (const Command& command : commands()) {
        const std::string help = command_help(command);
        for (const Option& option : command.options) {
            EXPECT_NE(help.find("--" + std::string(option.name)), std::string::npos)
                << command.name << option.name;
            EXPECT_FALSE(option.meaning.empty()) << command.name << " --" << option.name;
        }
        for (const Argument& argument : command.arguments) {
            EXPECT_NE(help.find(argument.name), std::string::npos) << command.name;
        }
        EXPECT_NE(program_help().find(command.summary), std::string::npos) << command.name;
    }
}

TEST(Commands, AnOptionMeansTheSameEverywhere) {
    std::map<std::string_view, char> letters;
    for (const Command& command : commands()) {
        for (const Option& option : command.options) {
            const auto [known, is_new] = letters.emplace(option.name, option.letter);
            EXPECT_EQ(known->second, option.letter) << command.name << " --" << option.name;
        }
    }
}

TEST(CommandLine, FillsInDefaults) {
    const Invocation invocation = parse_command_line(*find_command("study run"), {"x.toml"});
    EXPECT_EQ(invocation.argument("CONFIG"), "x.toml");
    EXPECT_EQ(invocation.text("db"), "capstan.db");
    EXPECT_EQ(invocation.integer("jobs"), 0);
    EXPECT_FALSE(invocation.has("json"));
}

TEST(CommandLine, RejectsUnknownWords) {
    const Command& run = *find_command("study run");
    const std::vector<std::vector<std::string>> wrong = {
        {},                          // nothing to run
        {"a", "b"},                  // one too many
        {"a", "--jobs"},             // no value
        {"a", "--jobs", "-1"},       // out of range
        {"a", "--jobs", "two"},      // no number
        {"a", "--jo", "2"},          // an abbreviation: would change its meaning with the next option
        {"a", "--json=3"},           // a flag takes no value
        {"a", "--json", "--json"},   // twice
        {"a", "--progress", "loud"}  // no such choice
    };
    for (const auto& words : wrong) EXPECT_THROW(parse_command_line(run, words), UsageError);
}

}  // namespace
}  // namespace capstan::cli
