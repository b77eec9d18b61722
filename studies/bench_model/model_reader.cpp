// The model of a bench from TOML.
#include <fmt/format.h>

#include <algorithm>

#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/model_keys.h"
#include "capstan/bench_model/table_reader.h"
#include "capstan/config/toml_nodes.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/recording/recording_keys.h"

namespace capstan::bench_model {

namespace {

using config::ConfigError;
using config::ConfigProblem;
using Range = TableReader::Range;

ModelOrigin origin_in(TableReader table) {
    ModelOrigin origin;
    origin.recording = table.text("recording");
    origin.runs = table.integers("runs");
    origin.program_version = table.text("program_version");
    table.reject_other_keys();
    return origin;
}

void read_description(TableReader table, BenchModel& model) {
    if (const auto mode = mode_named(table.text("recorded_mode")))
        model.recorded_mode = *mode;
    else if (table.has("recorded_mode"))
        table.add_problem("recorded_mode", "must be pull_pull, single_cable, lumped_drive or capstan_band");
    model.segments = table.integer("segments", 2, 1000);
    model.sample_rate_Hz = table.number_or("sample_rate_Hz", Range::zero_or_more, 0.0);
    model.tension_noise_N = table.number_or("tension_noise_N", Range::zero_or_more, 0.0);
    gap::BenchEquivalence& described = model.description;
    described.bench.motor_radius_m = table.number("motor_radius_m", Range::positive);
    described.bench.load_radius_m = table.number("load_radius_m", Range::positive);
    described.bench.dynamic_friction = table.number("dynamic_friction", Range::positive);
    described.bench.static_friction = table.number("static_friction", Range::positive);
    described.bench.axial_stiffness_N = table.number("axial_stiffness_N", Range::positive);
    described.bench.rotor_inertia_kg_m2 = table.number("rotor_inertia_kg_m2", Range::zero_or_more);
    described.bench.load_pulley_inertia_kg_m2 =
        table.number("load_pulley_inertia_kg_m2", Range::zero_or_more);
    described.bench.load_compliance_rad_per_Nm =
        table.number_or("load_compliance_rad_per_Nm", Range::positive, 0.0);
    described.bench.torque_constant_Nm_per_A =
        table.number_or("torque_constant_Nm_per_A", Range::positive, 0.0);
    described.pretension_N = table.number("pretension_N", Range::zero_or_more);
    described.pretension_over_stated_ratio =
        table.number_or("pretension_over_stated_ratio", Range::positive, 1.0);
    described.motion_sign = table.number_or("motion_sign", Range::finite, 1.0);
    described.motor_torque_sign = table.number_or("motor_torque_sign", Range::finite, 1.0);
    described.load_torque_sign = table.number_or("load_torque_sign", Range::finite, 1.0);
    for (TableReader& piece : table.rows("path")) {
        const double length_m = piece.number("length_m", Range::positive);
        described.bench.curvature.push_back({length_m, piece.number("bend_radius_m", Range::positive)});
        piece.reject_other_keys();
    }
    if (described.bench.curvature.empty())
        table.add_problem("path", "has no piece; write [{length_m = 1.0, bend_radius_m = 0.3}], for example");
    table.reject_other_keys();
}

std::vector<ModelEffect> effects_in(TableReader table) {
    std::vector<ModelEffect> effects;
    std::vector<std::string> known;
    for (const EffectNumbers& group : effect_numbers()) known.push_back(effect_key(group));
    for (const std::string& key : table.keys()) {
        const auto found = std::find(known.begin(), known.end(), key);
        if (found == known.end()) {
            table.add_problem(key, "is not an effect that this program knows" + suggestion(key, known));
            continue;
        }
        const EffectNumbers& group = effect_numbers()[static_cast<std::size_t>(found - known.begin())];
        TableReader numbers = table.table(key);
        ModelEffect effect{group.name, group.variant, {}};
        for (const EffectNumbers::Number& number : group.numbers)
            effect.numbers.push_back(numbers.fitted(number.name, number.unit, Range::finite));
        numbers.reject_other_keys();
        effects.push_back(std::move(effect));
    }
    return effects;
}

// "Nm" -> "N m"
std::string unit_in_words(const std::string& letters) {
    return letters == "Nm" ? "N m" : letters;
}

std::vector<ModelSensor> sensors_in(TableReader table) {
    std::vector<ModelSensor> sensors;
    for (const std::string& channel : table.keys()) {
        TableReader row = table.table(channel);
        ModelSensor sensor{channel, {}};
        for (const FaultKey& fault : fault_keys()) {
            const std::string begins = fault.name + "_";
            const Range range = fault.may_be_negative ? Range::finite : Range::zero_or_more;
            for (const std::string& key : row.keys()) {
                if (key.ends_with(interval_ending)) continue;
                if (fault.in_channel_unit && key.starts_with(begins))
                    sensor.faults.push_back(
                        row.fitted(fault.name, unit_in_words(key.substr(begins.size())), range));
                else if (key == key_with_unit(fault.name, fault.unit))
                    sensor.faults.push_back(row.fitted(fault.name, fault.unit, range));
            }
        }
        row.reject_other_keys();
        sensors.push_back(std::move(sensor));
    }
    return sensors;
}

std::string_view without_prefix(std::string_view key, std::string_view prefix) {
    return key.starts_with(prefix) ? key.substr(prefix.size()) : key;
}

std::vector<ModelFollowing> follows_in(TableReader& root) {
    std::vector<ModelFollowing> all;
    for (TableReader& row : root.rows("follows")) {
        ModelFollowing follows;
        follows.condition = row.text("condition");
        follows.middle = row.number("condition_middle", Range::finite);
        follows.half_range = row.number("condition_half_range", Range::positive);
        for (const std::string& key : row.keys()) {
            if (key.ends_with(interval_ending)) continue;
            const std::string_view what = without_prefix(key, squared_change);
            if (what == friction_change || what == pretension_change)
                follows.changes.push_back(row.fitted(key, "", Range::finite));
            // Behind the name of the channel stands its unit.
            const std::size_t last = key.rfind('_');
            if (what.starts_with(zero_change) && last >= std::string_view(zero_change).size())
                follows.changes.push_back(
                    row.fitted(key.substr(0, last), unit_in_words(key.substr(last + 1)), Range::finite));
        }
        row.reject_other_keys();
        all.push_back(std::move(follows));
    }
    return all;
}

void read_diagnosis(TableReader table, BenchModel& model) {
    model.origin.verdict = table.text("verdict");
    for (TableReader& row : table.rows("causes")) {
        ModelCause cause;
        cause.effect = row.text("effect");
        cause.variant = row.text_or("variant", "");
        cause.component = row.text_or("component", "");
        cause.end = row.text_or("end", "");
        cause.probability = row.number("present", Range::zero_or_more);
        row.reject_other_keys();
        model.causes.push_back(std::move(cause));
    }
    for (TableReader& row : table.rows("ranked")) {
        gap::RankedEffect ranked;
        ranked.effect = row.text("effect");
        ranked.probability = row.number("probability", Range::zero_or_more);
        ranked.present = row.number("present", Range::zero_or_more);
        ranked.varies = row.text_or("varies", "");
        row.reject_other_keys();
        model.ranked.push_back(std::move(ranked));
    }
    table.reject_other_keys();
}

residual_law::Feature feature_in(TableReader& row) {
    residual_law::Feature feature;
    feature.parameter = row.number("parameter", Range::finite);
    feature.times_load = row.boolean("times_load");
    const std::string kind = row.text("kind");
    try {
        if (!kind.empty()) feature.kind = residual_law::feature_kind_of(kind);
    } catch (const InvalidInput& error) {
        row.add_problem("kind", error.problems().front() + "; save the model again");
    }
    return feature;
}

void read_terms(TableReader& row, ModelLaw& left) {
    for (TableReader& each : row.rows("terms")) {
        residual_law::LawTerm term;
        term.words = each.text("words");
        term.size = each.number(key_with_unit("size", left.unit), Range::finite);
        term.half_width = each.number(key_with_unit("half_width_95", left.unit), Range::zero_or_more);
        for (TableReader& feature : each.rows("features")) {
            term.features.push_back(feature_in(feature));
            feature.reject_other_keys();
        }
        each.reject_other_keys();
        left.law.terms.push_back(std::move(term));
    }
    for (TableReader& weight : row.rows("weights")) {
        const residual_law::Feature feature = feature_in(weight);
        left.law.weights.push_back(
            {feature, weight.number(key_with_unit("weight", left.unit), Range::finite)});
        weight.reject_other_keys();
    }
}

ModelLaw law_in(TableReader& row) {
    ModelLaw left;
    left.sentence = row.text_or("sentence", "");
    left.channel = row.text("channel");
    left.unit = row.text("unit");
    left.motion = row.text("motion");
    left.motion_unit = row.text("motion_unit");
    left.load = row.text_or("load", "");
    left.load_unit = row.text("load_unit");
    residual_law::ResidualLaw& law = left.law;
    law.residual_rms = row.number(key_with_unit("rms", left.unit), Range::zero_or_more);
    law.left_out_rms = row.number(key_with_unit("rms_left_out", left.unit), Range::zero_or_more);
    law.band = row.number(key_with_unit("band_95", left.unit), Range::zero_or_more);
    const FittedNumber removed = row.fitted("removed_fraction", "", Range::finite);
    law.removed_fraction = removed.value;
    if (removed.interval) {
        law.removed_low = removed.interval->low;
        law.removed_high = removed.interval->high;
    }
    residual_law::FeatureScales& scales = law.scales;
    scales.motion_middle = row.number(key_with_unit("motion_middle", left.motion_unit), Range::finite);
    scales.motion_half_range =
        row.number(key_with_unit("motion_half_range", left.motion_unit), Range::zero_or_more);
    scales.speed = row.number(key_with_unit("speed", left.motion_unit + "/s"), Range::zero_or_more);
    scales.load = row.number(key_with_unit("load_scale", left.load_unit), Range::finite);
    scales.session_s = row.number("session_s", Range::finite);
    law.has_history_model = row.boolean("has_history_model");
    read_terms(row, left);
    row.reject_other_keys();
    return left;
}

toml::table parsed_model(std::string_view toml, const std::string& file) {
    constexpr const char* how_to_make_one = "`capstan diagnose LOG --save FILE` writes one";
    toml::table root;
    try {
        root = config::parsed(toml, file);
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw ConfigError(file, {{static_cast<int>(at.line), static_cast<int>(at.column), "",
                                  fmt::format("not valid TOML: {}; a model of a bench is TOML, {}",
                                              error.description(), how_to_make_one)}});
    }
    if (!root.contains(format_key))
        throw ConfigError(file, {{0, 0, "", fmt::format("is not a model of a bench; {}", how_to_make_one)}});
    return root;
}

}  // namespace

bool is_model(std::string_view toml) {
    try {
        parsed_model(toml, "");
        return true;
    } catch (const ConfigError&) {
        return false;
    }
}

BenchModel parse_model(std::string_view toml, const std::string& file) {
    const toml::table parsed = parsed_model(toml, file);
    std::vector<ConfigProblem> problems;
    TableReader root(parsed, "", problems);
    BenchModel model;
    root.integer(format_key, model_format, model_format);
    model.origin = origin_in(root.table("origin"));
    read_description(root.table("bench"), model);
    TableReader fitted = root.table("fitted");
    model.friction_ratio = fitted.fitted("friction_ratio", "", Range::positive);
    model.stiffness_ratio = fitted.fitted("stiffness_ratio", "", Range::positive);
    model.pretension_ratio = fitted.fitted("pretension_ratio", "", Range::positive);
    for (FittedNumber* of_drive :
         {&model.bend_at_motor_ratio, &model.bend_at_load_ratio, &model.load_radius_ratio}) {
        if (model.recorded_mode == BenchMode::lumped_drive && fitted.has(of_drive->name))
            *of_drive = fitted.fitted(of_drive->name, "", Range::positive);
    }
    fitted.reject_other_keys();
    model.effects = effects_in(root.table("effect"));
    model.sensors = sensors_in(root.table("sensor"));
    model.follows = follows_in(root);
    read_diagnosis(root.table("diagnosis"), model);
    for (TableReader& row : root.rows("left_over")) model.laws.push_back(law_in(row));
    root.reject_other_keys();
    if (!problems.empty()) throw ConfigError(file, std::move(problems));
    return model;
}

}  // namespace capstan::bench_model
