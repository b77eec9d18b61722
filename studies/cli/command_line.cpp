#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options.hpp>

#include "capstan/cli/command.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/platform/parsed_number.h"

namespace capstan::cli {

namespace {

namespace po = boost::program_options;

constexpr const char* positional = "positional arguments";  // no option that anyone could type

[[noreturn]] void refuse(const Command& command, const std::string& what) {
    throw UsageError(fmt::format("capstan {0}: {1}\nTry `capstan {0} --help`.", command.name, what));
}

po::options_description description_of(const Command& command) {
    po::options_description description;
    for (const Option& option : command.options) {
        std::string name(option.name);
        if (option.letter != '\0') name += fmt::format(",{}", option.letter);
        if (option.is_flag()) {
            description.add_options()(name.c_str(), "");
        } else {
            description.add_options()(name.c_str(), po::value<std::string>());
        }
    }
    description.add_options()(positional, po::value<std::vector<std::string>>());
    return description;
}

std::string nearest_option(const Command& command, std::string given) {
    given.resize(std::min(given.size(), given.find('=')));
    const std::string bare = given.substr(std::min(given.find_first_not_of('-'), given.size()));
    std::vector<std::string> known;
    for (const Option& option : command.options) known.emplace_back(option.name);
    const auto nearest = nearest_name(bare, known);
    return fmt::format("unknown option '{}'{}", given, nearest ? "; did you mean '--" + *nearest + "'?" : "");
}

po::variables_map parse(const Command& command, const std::vector<std::string>& arguments) {
    // Without guessing: an abbreviation that works today would change its meaning with the next option.
    constexpr int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::positional_options_description positions;
    positions.add(positional, -1);
    po::variables_map values;
    try {
        const po::options_description description = description_of(command);
        po::command_line_parser parser(arguments);
        po::store(parser.options(description).positional(positions).style(style).run(), values);
    } catch (const po::unknown_option& error) {
        refuse(command, nearest_option(command, error.get_option_name()));
    } catch (const po::multiple_occurrences& error) {
        refuse(command, fmt::format("option '{}' is given twice", error.get_option_name()));
    } catch (const po::invalid_command_line_syntax& error) {
        const bool extra = error.kind() == po::invalid_syntax::extra_parameter;
        refuse(command, fmt::format("option '{}' {}", error.get_option_name(),
                                    extra ? "takes no value" : "needs a value"));
    } catch (const po::error& error) {
        refuse(command, error.what());
    }
    return values;
}

void check_number(const Command& command, const Option& option, const std::string& text) {
    const bool is_integer = option.kind == OptionKind::integer;
    const std::optional<double> value =
        is_integer ? std::optional<double>(parsed_number<std::int64_t>(text)) : parsed_number<double>(text);
    if (!value)
        refuse(command, fmt::format("--{} is '{}', but must be {}", option.name, text,
                                    is_integer ? "an integer" : "a number"));
    const auto [low, high] = option.limits;
    if (*value >= low && *value <= high) return;
    const bool is_named = high < 1e7 || *value > high;
    const std::string above = is_named ? fmt::format(" and at most {:.12g}", high) : "";
    refuse(command, fmt::format("--{} is {}, but must be at least {}{}", option.name, text, low, above));
}

void check_value(const Command& command, const Option& option, const std::string& text) {
    if (option.kind != OptionKind::string) return check_number(command, option, text);
    if (text.empty()) refuse(command, fmt::format("--{} is empty", option.name));
    if (option.choices.empty()) return;
    if (std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end()) return;
    refuse(command,
           fmt::format("--{} is '{}', but must be {}", option.name, text, fmt::join(option.choices, ", ")));
}

}  // namespace

Invocation parse_command_line(const Command& command, const std::vector<std::string>& arguments) {
    const po::variables_map values = parse(command, arguments);

    std::map<std::string, std::string, std::less<>> options;
    for (const Option& option : command.options) {
        const std::string name(option.name);
        if (values.count(name) == 0) {
            if (!option.default_value.empty()) options[name] = option.default_value;
            continue;
        }
        const std::string text = option.is_flag() ? "yes" : values[name].as<std::string>();
        check_value(command, option, text);
        options[name] = text;
    }

    std::vector<std::string> given;
    if (values.count(positional) != 0) given = values[positional].as<std::vector<std::string>>();
    std::vector<std::string> repeated;
    const std::size_t places = command.arguments.size();
    if (places > 0 && command.arguments.back().need == ArgumentNeed::one_or_more && given.size() >= places) {
        repeated.assign(given.begin() + static_cast<std::ptrdiff_t>(places) - 1, given.end());
        given.resize(places);
    }
    if (given.size() > command.arguments.size()) {
        refuse(command, fmt::format("'{}' is one argument too many", given[command.arguments.size()]));
    }
    std::map<std::string, std::string, std::less<>> named;
    for (std::size_t k = 0; k < command.arguments.size(); ++k) {
        const Argument& argument = command.arguments[k];
        if (k < given.size()) {
            named[std::string(argument.name)] = given[k];
        } else if (!argument.default_value.empty()) {
            named[std::string(argument.name)] = argument.default_value;
        } else if (argument.need != ArgumentNeed::optional) {
            refuse(command, fmt::format("{} is missing", argument.name));
        }
    }
    return {command, std::move(options), std::move(named), std::move(repeated)};
}

}  // namespace capstan::cli
