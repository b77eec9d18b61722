// A model of a bench as TOML.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "capstan/bench_model/effect_numbers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/model_keys.h"
#include "capstan/config/config_writer.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/recording/recording_keys.h"

namespace capstan::bench_model {

namespace {

using config::toml_number;
using config::toml_string;

// In quotes unless every letter may stand without.
std::string key_text(const std::string& key) {
    const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char letter) {
        return std::isalnum(letter) != 0 || letter == '_' || letter == '-';
    });
    return is_bare ? key : toml_string(key);
}

class ModelText {
  public:
    void comment(const std::string& words) {
        constexpr std::size_t columns = 100;
        text_ += wrapped(words, columns, "# ", "# ") + "\n";
    }
    void section(const std::string& name, const std::string& meaning) {
        text_ += "\n";
        comment(meaning);
        text_ += "[" + name + "]\n";
    }
    void row_of(const std::string& list) { text_ += "\n[[" + list + "]]\n"; }
    void value(const std::string& key, double number) {
        text_ += key_text(key) + " = " + toml_number(number) + "\n";
    }
    void value(const std::string& key, int number) {
        text_ += fmt::format("{} = {}\n", key_text(key), number);
    }
    void value(const std::string& key, const std::string& words) {
        text_ += key_text(key) + " = " + toml_string(words) + "\n";
    }
    void value(const std::string& key, bool is_true) {
        text_ += fmt::format("{} = {}\n", key_text(key), is_true ? "true" : "false");
    }
    void value(const std::string& key, const std::vector<int>& numbers) {
        text_ += fmt::format("{} = [{}]\n", key_text(key), fmt::join(numbers, ", "));
    }
    void value_if_any(const std::string& key, const std::string& words) {
        if (!words.empty()) value(key, words);
    }
    void number(const FittedNumber& fitted) {
        const std::string key = key_with_unit(fitted.name, fitted.unit);
        value(key, fitted.value);
        if (fitted.interval)
            text_ += fmt::format("{} = [{}, {}]\n", key_text(key + interval_ending),
                                 toml_number(fitted.interval->low), toml_number(fitted.interval->high));
    }
    void rows(const std::string& key, const std::vector<std::string>& inline_tables) {
        text_ += key + " = [\n";
        for (const std::string& each : inline_tables) text_ += "    {" + each + "},\n";
        text_ += "]\n";
    }

    std::string take() { return std::move(text_); }

  private:
    std::string text_;
};

void write_head(ModelText& text, const BenchModel& model) {
    text.comment(
        fmt::format("A model of the bench that was recorded in {}, as `capstan diagnose --save` found it.",
                    model.origin.recording));
    text.comment(model.origin.verdict);
    text.comment(
        "To judge it on other runs: capstan simulate LOG --model THIS_FILE. Keys end in their unit; a key without one "
        "is a ratio, a count or a sign. A number with `_interval_95` was fitted, and lies in that interval with a "
        "probability of 95%.");
    text.value(format_key, model_format);
    text.section("origin", "The recording and the runs that the model was fitted to.");
    text.value("recording", model.origin.recording);
    text.value("runs", model.origin.runs);
    text.value("program_version", model.origin.program_version);
}

void write_description(ModelText& text, const BenchModel& model) {
    const gap::BenchEquivalence& described = model.description;
    text.section(
        "bench",
        model.is_of_unknown_geometry()
            ? "The bench before the diagnosis. Its geometry is not known: this is an equivalent bench "
              "with signs, friction, stiffness and pretension as the recording shows them."
            : "The bench before the diagnosis, as the recording's sidecar states it.");
    text.value("recorded_mode", std::string(mode_name(model.recorded_mode)));
    text.value("segments", model.segments);
    text.value("sample_rate_Hz", model.sample_rate_Hz);
    text.comment(
        "Standard deviation of a tension reading, as the recording's sensors show it; 0: not known.");
    text.value("tension_noise_N", model.tension_noise_N);
    text.value("motor_radius_m", described.bench.motor_radius_m);
    text.value("load_radius_m", described.bench.load_radius_m);
    text.value("dynamic_friction", described.bench.dynamic_friction);
    text.value("static_friction", described.bench.static_friction);
    text.value("axial_stiffness_N", described.bench.axial_stiffness_N);
    text.value("rotor_inertia_kg_m2", described.bench.rotor_inertia_kg_m2);
    text.value("load_pulley_inertia_kg_m2", described.bench.load_pulley_inertia_kg_m2);
    if (described.bench.load_compliance_rad_per_Nm > 0.0)
        text.value("load_compliance_rad_per_Nm", described.bench.load_compliance_rad_per_Nm);
    if (described.bench.torque_constant_Nm_per_A > 0.0)
        text.value("torque_constant_Nm_per_A", described.bench.torque_constant_Nm_per_A);
    text.comment("Of runs that state no pretension.");
    text.value("pretension_N", described.pretension_N);
    if (model.is_of_unknown_geometry()) {
        text.value("pretension_over_stated_ratio", described.pretension_over_stated_ratio);
        text.value("motion_sign", described.motion_sign);
        text.value("motor_torque_sign", described.motor_torque_sign);
        text.value("load_torque_sign", described.load_torque_sign);
    }
    text.comment("The cable's path from the motor end. A radius of inf is straight.");
    std::vector<std::string> pieces;
    for (const CurvaturePiece& piece : described.bench.curvature)
        pieces.push_back(fmt::format("length_m = {}, bend_radius_m = {}", toml_number(piece.length_m),
                                     toml_number(piece.bend_radius_m)));
    text.rows("path", pieces);
}

void write_fitted(ModelText& text, const BenchModel& model) {
    text.section("fitted",
                 "What the diagnosis fitted, in parts of what [bench] says; pretension_ratio in parts of "
                 "each run's pretension.");
    for (const FittedNumber* ratio : {&model.friction_ratio, &model.stiffness_ratio, &model.pretension_ratio})
        text.number(*ratio);
    if (model.recorded_mode == BenchMode::lumped_drive) {
        text.comment(
            "The curvature of the first and the last third of the path in parts of the middle third's.");
        text.number(model.bend_at_motor_ratio);
        text.number(model.bend_at_load_ratio);
        text.comment("The load pulley's radius in parts of what [bench] says.");
        text.number(model.load_radius_ratio);
    }
    for (const ModelEffect& effect : model.effects) {
        const EffectNumbers& group = *find_effect(effect.name, effect.variant);
        text.section("effect." + effect_key(group), group.title + ": " + group.meaning + ".");
        for (const FittedNumber& number : effect.numbers) text.number(number);
    }
    for (const ModelSensor& sensor : model.sensors) {
        text.section("sensor." + key_text(sensor.channel), "What is wrong with the sensor of this channel.");
        for (const FittedNumber& fault : sensor.faults) text.number(fault);
    }
    if (!model.follows.empty())
        text.comment(
            "Numbers that follow a condition of the runs: `friction_log`, "
            "`pretension_log` and zeros change by so much from the middle to the end of its range, "
            "which are in the condition's own unit; those with `squared_` by so much to either end.");
    for (const ModelFollowing& follows : model.follows) {
        text.row_of("follows");
        text.value("condition", follows.condition);
        text.value("condition_middle", follows.middle);
        text.value("condition_half_range", follows.half_range);
        for (const FittedNumber& change : follows.changes) text.number(change);
    }
}

std::string pair_if_any(const std::string& key, const std::string& words) {
    return words.empty() ? "" : fmt::format(", {} = {}", key, toml_string(words));
}

void write_diagnosis(ModelText& text, const BenchModel& model) {
    text.section("diagnosis",
                 "The causes that the verdict names, with the probability that each is present, and the "
                 "probabilities of all causes; `probability` sums to 1 over them.");
    text.value("verdict", model.origin.verdict);
    std::vector<std::string> causes;
    for (const ModelCause& cause : model.causes)
        causes.push_back(fmt::format("effect = {}{}{}{}, present = {}", toml_string(cause.effect),
                                     pair_if_any("variant", cause.variant),
                                     pair_if_any("component", cause.component), pair_if_any("end", cause.end),
                                     toml_number(cause.probability)));
    text.rows("causes", causes);
    std::vector<std::string> ranked;
    for (const gap::RankedEffect& each : model.ranked)
        ranked.push_back(fmt::format("effect = {}, probability = {}, present = {}{}",
                                     toml_string(each.effect), toml_number(each.probability),
                                     toml_number(each.present), pair_if_any("varies", each.varies)));
    text.rows("ranked", ranked);
}

std::string feature_words(const residual_law::Feature& feature) {
    return fmt::format("kind = {}, parameter = {}, times_load = {}", toml_string(name_of(feature.kind)),
                       toml_number(feature.parameter), feature.times_load ? "true" : "false");
}

void write_law(ModelText& text, const ModelLaw& left) {
    const residual_law::ResidualLaw& law = left.law;
    text.row_of("left_over");
    text.value_if_any("sentence", left.sentence);
    text.value("channel", left.channel);
    text.value("unit", left.unit);
    text.value("motion", left.motion);
    text.value("motion_unit", left.motion_unit);
    text.value_if_any("load", left.load);
    text.value("load_unit", left.load_unit);
    const auto in_unit = [&](const std::string& name, double value) {
        text.value(key_with_unit(name, left.unit), value);
    };
    in_unit("rms", law.residual_rms);
    in_unit("rms_left_out", law.left_out_rms);
    in_unit("band_95", law.band);
    text.number({"removed_fraction", "", law.removed_fraction,
                 law.removed_low ? std::optional(FittedInterval{*law.removed_low, *law.removed_high})
                                 : std::nullopt});
    text.value(key_with_unit("motion_middle", left.motion_unit), law.scales.motion_middle);
    text.value(key_with_unit("motion_half_range", left.motion_unit), law.scales.motion_half_range);
    text.value(key_with_unit("speed", left.motion_unit + "/s"), law.scales.speed);
    text.value(key_with_unit("load_scale", left.load_unit), law.scales.load);
    text.value("session_s", law.scales.session_s);
    text.value("has_history_model", law.has_history_model);
    std::vector<std::string> terms;
    for (const residual_law::LawTerm& term : law.terms) {
        std::string features;
        for (const residual_law::Feature& feature : term.features)
            features += (features.empty() ? "{" : ", {") + feature_words(feature) + "}";
        terms.push_back(fmt::format("words = {}, {} = {}, {} = {}, features = [{}]", toml_string(term.words),
                                    key_with_unit("size", left.unit), toml_number(term.size),
                                    key_with_unit("half_width_95", left.unit), toml_number(term.half_width),
                                    features));
    }
    text.rows("terms", terms);
    std::vector<std::string> weights;
    for (const residual_law::WeightedFeature& each : law.weights)
        weights.push_back(fmt::format("{}, {} = {}", feature_words(each.feature),
                                      key_with_unit("weight", left.unit), toml_number(each.weight)));
    text.rows("weights", weights);
}

}  // namespace

std::string model_text(const BenchModel& model) {
    ModelText text;
    write_head(text, model);
    write_description(text, model);
    write_fitted(text, model);
    write_diagnosis(text, model);
    for (const ModelLaw& law : model.laws) write_law(text, law);
    return text.take();
}

}  // namespace capstan::bench_model
