#include "capstan/import/mapping.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/mapping_table.h"
#include "capstan/platform/files.h"
#include "capstan/recording/json_object.h"

namespace capstan::imports {

namespace {

std::string column_text(const MappingTable& table) {
    const toml::node* node = table.toml().get("column");
    if (node != nullptr && node->is_integer()) return std::to_string(*node->value<std::int64_t>());
    return table.text("column").value_or("");
}

TimeMapping time_of(const MappingTable& table) {
    table.knows({"column", "unit", "sample_rate_Hz"});
    TimeMapping time;
    time.column = column_text(table);
    time.unit = table.text("unit").value_or("");
    time.sample_rate_Hz = table.positive("sample_rate_Hz").value_or(0.0);
    if (time.sample_rate_Hz > 0.0 && !time.column.empty())
        table.problem("sample_rate_Hz", "is for files without times; leave it or the column out");
    if (!time.unit.empty()) {
        const auto unit = find_unit(time.unit);
        if (!unit || unit->quantity != Quantity::time)
            table.problem("unit", fmt::format("is \"{}\"; a time is in s, ms, us, ns or min", time.unit));
    }
    return time;
}

logs::TextFormat text_of(const MappingTable& table) {
    table.knows({"delimiter", "decimal_comma", "head_line", "comments"});
    logs::TextFormat format;
    if (const auto delimiter = table.text("delimiter")) {
        if (delimiter->size() == 1) {
            format.delimiter = delimiter->front();
        } else {
            table.problem("delimiter", "should be one character; \" \" stands for any number of blanks");
        }
    }
    format.decimal_comma = table.boolean("decimal_comma");
    if (const auto line = table.number("head_line")) {
        if (*line >= 0.0 && *line == std::floor(*line) && *line < 1e6) {
            format.head_line = static_cast<int>(*line);
        } else {
            table.problem("head_line", "should be the number of a line, from 1; 0: there is none");
        }
    }
    format.comments = table.text("comments");
    return format;
}

// The unit of a channel has to lead to the channel's own.
void check_unit(const MappingTable& table, const ChannelMapping& channel) {
    const auto unit = find_unit(channel.unit);
    if (!unit) {
        if (!channel.scale)
            table.problem(
                "unit", fmt::format("\"{}\" is not known; state `scale`, the SI units in one of them, or use "
                                    "one of {}",
                                    channel.unit, known_units()));
        return;
    }
    if (channel.scale) return;
    const bool is_angle = channel.name.ends_with("_angle");
    const bool is_torque = channel.name.ends_with("_torque");
    if (unit->quantity == Quantity::counts || unit->quantity == Quantity::plain) {
        if (is_angle && channel.counts_per_turn) return;
        table.problem("unit", fmt::format("\"{}\" alone says no size; state `{}`", channel.unit,
                                          is_angle ? "counts_per_turn" : "scale` (SI units in one of them)"));
        return;
    }
    const bool from_current = is_torque && unit->quantity == Quantity::current;
    if (from_current && !channel.torque_constant)
        table.problem("unit", "is a current; state `torque_constant_Nm_per_A`, with the gear in it");
    const Quantity wanted = is_angle                               ? Quantity::angle
                            : is_torque                            ? Quantity::torque
                            : channel.name.starts_with("tension_") ? Quantity::force
                            : channel.name == "friction_force"     ? Quantity::force
                            : channel.name == "displacement"       ? Quantity::length
                            : channel.name == "velocity"           ? Quantity::speed
                                                                   : unit->quantity;
    if (!from_current && unit->quantity != wanted)
        table.problem("unit",
                      fmt::format("\"{}\" is {}, {} is {}", channel.unit, quantity_words(unit->quantity),
                                  channel.name, quantity_words(wanted)));
}

ChannelMapping channel_of(const std::string& name, const MappingTable& table) {
    table.knows({"column", "table", "file", "unit", "scale", "counts_per_turn", "torque_constant_Nm_per_A",
                 "sign", "zero", "clock_offset_s", "wraps_at", "noise_std", "step"});
    ChannelMapping channel;
    channel.name = name;
    channel.from = {table.text("file").value_or(""), table.text("table").value_or(""), column_text(table)};
    channel.unit = table.text("unit").value_or("");
    channel.scale = table.number("scale");
    channel.counts_per_turn = table.positive("counts_per_turn");
    channel.torque_constant = table.number("torque_constant_Nm_per_A");
    channel.sign = table.number("sign").value_or(1.0);
    channel.zero = table.number("zero").value_or(0.0);
    channel.clock_offset_s = table.number("clock_offset_s");
    channel.wraps_at = table.positive("wraps_at");
    channel.noise_std = table.positive("noise_std");
    channel.step = table.positive("step");
    if (channel.from.column.empty()) table.problem("column", "is missing; name the column of the log");
    if (channel.sign != 1.0 && channel.sign != -1.0) table.problem("sign", "should be 1 or -1");
    if (channel.scale && *channel.scale == 0.0) table.problem("scale", "must not be 0");
    if (channel.unit.empty() && !channel.scale) {
        table.problem("unit", "is missing; state the unit of the column's numbers");
    } else {
        check_unit(table, channel);
    }
    return channel;
}

RunMapping run_mapping(const MappingTable& table) {
    RunMapping run;
    run.files = table.toml().contains("files") ? table.texts("files") : std::vector<std::string>{};
    if (const auto file = table.text("file")) run.files.push_back(*file);
    run.from_s = table.number("from_s");
    run.to_s = table.number("to_s");
    if (run.from_s && run.to_s && *run.to_s <= *run.from_s) table.problem("to_s", "must be after from_s");
    if (const toml::node* zero = table.toml().get("zero")) {
        if (const toml::table* zeros = zero->as_table()) {
            const MappingTable inside = table.inside(*zeros, table.path_of("zero"));
            for (const auto& [key, value] : *zeros) {
                const std::string channel(key.str());
                if (const auto number = inside.number(channel.c_str()))
                    run.zero.emplace_back(channel, *number);
            }
        } else {
            table.problem(*zero, "zero", "should name channels, { motor_torque = 338.56 }");
        }
    }
    run.conditions = json_of(table.toml());
    for (const char* key : {"file", "files", "from_s", "to_s", "zero"}) run.conditions.erase(key);
    return run;
}

// The tables of a list, in the order of the file.
template <class Read>
void for_each_table(const MappingTable& top, const char* key, const Read& read) {
    const toml::node* node = top.toml().get(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) {
        top.problem(*node, key, fmt::format("should be a list; write [[{}]]", key));
        return;
    }
    int number = 1;
    for (const toml::node& element : *list) {
        const std::string path = fmt::format("{}[{}].", key, number++);
        if (const toml::table* table = element.as_table()) {
            read(top.inside(*table, path));
        } else {
            top.problem(element, key, fmt::format("should be a list of tables; write [[{}]]", key));
        }
    }
}

template <class Read>
void if_table(const MappingTable& top, const char* key, const Read& read) {
    const toml::node* node = top.toml().get(key);
    if (node == nullptr) return;
    if (const toml::table* table = node->as_table()) {
        read(top.inside(*table, std::string(key) + "."));
    } else {
        top.problem(*node, key, fmt::format("should be a section; write [{}]", key));
    }
}

void read_channels(const MappingTable& channels, Mapping& mapping) {
    for (const std::string& name : keys_in_order(channels.toml())) {
        const toml::node& node = *channels.toml().get(name);
        if (name == "run" || name == "t") {
            channels.problem(node, name, "is not a channel; times are in [time], runs in [[runs]]");
        } else if (const toml::table* table = node.as_table()) {
            mapping.channels.push_back(channel_of(name, channels.inside(*table, channels.path_of(name))));
        } else {
            channels.problem(node, name,
                             "should say where it comes from, { column = \"...\", unit = \"...\" }");
        }
    }
}

Mapping mapping_of(const MappingTable& top) {
    top.knows({"time", "text", "sample_rate_Hz", "thinning", "run_column", "channels", "runs", "recording"});
    Mapping mapping;
    if_table(top, "time", [&](const MappingTable& table) { mapping.time = time_of(table); });
    if_table(top, "text", [&](const MappingTable& table) { mapping.text = text_of(table); });
    mapping.sample_rate_Hz = top.positive("sample_rate_Hz");
    if (const auto thinning = top.text("thinning")) {
        mapping.thinning = *thinning == "mean" ? Thinning::mean : Thinning::pick;
        if (*thinning != "mean" && *thinning != "pick")
            top.problem("thinning",
                        "should be \"pick\" (single readings) or \"mean\" (of a block of readings)");
    }
    mapping.run_column = top.text("run_column");
    if_table(top, "channels", [&](const MappingTable& table) { read_channels(table, mapping); });
    if (mapping.channels.empty())
        top.problem(
            "channels",
            "names no channel; write [channels] and a line such as "
            "motor_angle = { column = \"Motor\", unit = \"deg\" }, or let `capstan import --suggest` do it");
    for_each_table(top, "runs",
                   [&](const MappingTable& table) { mapping.runs.push_back(run_mapping(table)); });
    if_table(top, "recording", [&](const MappingTable& table) { mapping.recording = json_of(table.toml()); });
    return mapping;
}

}  // namespace

double ChannelMapping::factor() const {
    if (scale) return sign * *scale;
    const std::optional<Unit> known = find_unit(unit);
    double si = known ? known->si : 1.0;
    if (counts_per_turn &&
        (!known || known->quantity == Quantity::counts || known->quantity == Quantity::plain))
        si = find_unit("turn")->si / *counts_per_turn;
    if (torque_constant && known && known->quantity == Quantity::current) si *= *torque_constant;
    return sign * si;
}

Mapping parse_mapping(const std::string& text, const std::string& file) {
    ProblemList problems;
    try {
        const toml::table table = toml::parse(text, file);
        Mapping mapping = mapping_of(MappingTable(table, "", file, problems));
        problems.throw_if_any();
        mapping.file = file;
        return mapping;
    } catch (const toml::parse_error& error) {
        throw InvalidInput({fmt::format("{}:{}: {}", file, error.source().begin.line, error.description())});
    }
}

Mapping read_mapping(const std::filesystem::path& path) {
    return parse_mapping(read_input_file(path), path.string());
}

}  // namespace capstan::imports
