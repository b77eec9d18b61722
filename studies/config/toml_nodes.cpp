#include "capstan/config/toml_nodes.h"

namespace capstan::config {

toml::table parsed(std::string_view toml, const std::string& file) {
    return toml::parse(toml, file);
}

int line_of(const toml::node& node) {
    return static_cast<int>(node.source().begin.line);
}

std::string_view type_words(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::none:
            return "nothing";
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "an integer";
        case toml::node_type::floating_point:
            return "a number with a fraction";
        case toml::node_type::boolean:
            return "true or false";
        case toml::node_type::date:
            return "a date";
        case toml::node_type::time:
            return "a time";
        case toml::node_type::date_time:
            return "a date and time";
    }
    return "something else";
}

}  // namespace capstan::config
