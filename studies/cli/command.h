#pragma once

#include <cassert>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

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

/// Of a command that stores nothing before its end.
inline constexpr std::string_view stores_nothing =
    "stopped by Ctrl-C or a request to terminate; nothing is stored";
inline constexpr std::string_view can_be_resumed = exit_code_meanings[4].meaning;

class Invocation;

enum class OptionKind { string, integer, number };

/// The values of a number that are allowed, both ends included.
struct Limits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// One option of a command: everything that parsing and explaining it need.
struct Option {
    std::string_view name;  ///< without dashes
    char letter = '\0';     ///< short form; '\0': none
    OptionKind kind = OptionKind::string;
    std::string_view value{};  ///< what to give, in capitals; empty: one of the choices, or a flag
    std::string_view meaning{};
    std::string_view default_value{};  ///< empty: none
    std::vector<std::string> choices{};
    Limits limits{};  ///< of numbers
    /// Throws where the option's value cannot be used. Called before the command begins, so that no work is
    /// lost by it; null: nothing to check.
    void (*check)(const Invocation&, const Option&) = nullptr;

    bool is_flag() const { return value.empty() && choices.empty(); }
};

enum class ArgumentNeed { required, optional, one_or_more };  ///< the last only for a command's last argument

struct Argument {
    std::string_view name;
    std::string_view meaning;
    ArgumentNeed need = ArgumentNeed::required;
    std::string_view default_value{};
};

/// One command. Dispatch, --help, completion and man page all read the table of these.
struct Command {
    std::string_view name;  ///< "study run"
    std::string_view summary;
    std::string_view description;
    std::vector<Argument> arguments{};
    std::vector<Option> options{};
    std::vector<std::string_view> examples{};
    ExitCode (*run)(const Invocation&);
    std::string_view time = "Less than 2 s.";  ///< how long it takes, on a machine with two cores of 2023
    std::string_view when_stopped{};  ///< the meaning of ExitCode::stopped; empty: it does not return it
};

/// The exit codes that a command can return, each with its meaning.
std::vector<ExitCodeMeaning> exit_codes_of(const Command& command);

/// What was asked of a command: checked values, defaults filled in.
class Invocation {
  public:
    Invocation(const Command& command, std::map<std::string, std::string, std::less<>> options,
               std::map<std::string, std::string, std::less<>> arguments,
               std::vector<std::string> repeated_argument = {})
        : command_(&command),
          options_(std::move(options)),
          arguments_(std::move(arguments)),
          repeated_argument_(std::move(repeated_argument)) {}

    const Command& command() const { return *command_; }
    /// Given, or has a default.
    bool has(std::string_view option) const { return options_.find(option) != options_.end(); }
    /// Of an option that was given or has a default; asking for any other is an error of the program.
    const std::string& text(std::string_view option) const { return value_of(options_, option); }
    std::int64_t integer(std::string_view option) const { return std::stoll(text(option)); }
    /// An integer whose limits an int holds.
    int count(std::string_view option) const { return static_cast<int>(integer(option)); }
    double number(std::string_view option) const { return std::stod(text(option)); }
    /// Assigns the value of an option that was given or has a default; otherwise `value` stays as it is.
    template <typename Value>
    void take(std::string_view option, Value& value) const {
        if (!has(option)) return;
        if constexpr (std::is_integral_v<Value>)
            value = static_cast<Value>(integer(option));
        else if constexpr (std::is_floating_point_v<Value>)
            value = number(option);
        else
            value = text(option);
    }
    template <typename Value>
    void take(std::string_view option, std::optional<Value>& value) const {
        if (has(option)) take(option, value.emplace());
    }

    bool has_argument(std::string_view name) const { return arguments_.find(name) != arguments_.end(); }
    const std::string& argument(std::string_view name) const { return value_of(arguments_, name); }
    /// All values of the argument that may be given more than once; at least one.
    const std::vector<std::string>& repeated_argument() const { return repeated_argument_; }

  private:
    using Values = std::map<std::string, std::string, std::less<>>;

    static const std::string& value_of(const Values& values, std::string_view name) {
        const auto found = values.find(name);
        assert(found != values.end());
        if (found == values.end()) throw std::logic_error("the command has no value of " + std::string(name));
        return found->second;
    }

    const Command* command_;
    Values options_;
    Values arguments_;
    std::vector<std::string> repeated_argument_;
};

/// What follows a command's name, checked against the command. Throws UsageError.
Invocation parse_command_line(const Command& command, const std::vector<std::string>& arguments);

/// A command line, a configuration or a query that cannot be followed; says what to try.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace capstan::cli
