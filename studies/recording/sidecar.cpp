#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/cable/cable_cut.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/recording/json_object.h"
#include "capstan/recording/nominal_bench.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"

namespace capstan {

namespace {

Channel channel_of(const JsonObject& sidecar, const std::string& name, const std::string& unit) {
    const auto stated = [&](const char* list) -> std::optional<double> {
        if (!sidecar.has(list)) return std::nullopt;
        const JsonObject values = sidecar.object(list);
        if (!values.has(name.c_str())) return std::nullopt;
        return values.positive(name.c_str());
    };
    Channel channel{name, unit, stated("noise_std"), stated("encoder_step")};
    if (name.ends_with("_torque") && !channel.step) channel.step = sidecar.optional_number("torque_step");
    return channel;
}

std::vector<Channel> channels_of(const JsonObject& sidecar, const SampleTable& samples,
                                 Assumptions& assumptions) {
    std::vector<Channel> channels;
    if (!sidecar.has("units")) {
        std::string names;
        for (const std::string& column : samples.columns) {
            const std::string unit(channel_unit(column));
            if (column == "run" || column == "t" || unit.empty()) continue;
            channels.push_back(channel_of(sidecar, column, unit));
            names += fmt::format("{}{} in {}", names.empty() ? "" : ", ", column, unit);
        }
        assumptions.add("units", names.empty() ? "and no column has a known name" : "taken as " + names);
        return channels;
    }
    const JsonObject units = sidecar.object("units");
    for (const std::string& name : units.keys()) {
        const std::string unit = units.text(name.c_str());
        const std::string wanted(channel_unit(name));
        if (!wanted.empty() && unit != wanted)
            units.add_problem(name,
                              fmt::format("is '{}'; a recording is in SI units, here '{}'. `capstan import` "
                                          "converts it",
                                          unit, wanted));
        if (name != "t") channels.push_back(channel_of(sidecar, name, unit));
    }
    return channels;
}

std::vector<TensionSensor> sensors_of(const JsonObject& sidecar, double length_m) {
    std::vector<TensionSensor> sensors;
    if (!sidecar.has("tension_sensors")) return sensors;
    for (const JsonObject& sensor : sidecar.objects("tension_sensors")) {
        const std::string cable = sensor.has("cable") ? sensor.text("cable") : "A";
        if (cable != "A" && cable != "B") sensor.add_problem("cable", "should be \"A\" or \"B\"");
        const double position_m = sensor.number("s");
        if (position_m < 0.0 || position_m > length_m)
            sensor.add_problem("s", fmt::format("is {} m, outside the cable's {} m", position_m, length_m));
        sensors.push_back({sensor.text("channel"), cable == "B" ? CableName::b : CableName::a, position_m});
    }
    return sensors;
}

OutputKind output_of(const JsonObject& run) {
    if (!run.has("output")) return OutputKind::unknown;
    const std::string output = run.text("output");
    if (output == "locked") return OutputKind::locked;
    if (output == "handle") return OutputKind::handle;
    run.add_problem("output", fmt::format("is '{}'; known are 'locked' and 'handle'", output));
    return OutputKind::unknown;
}

std::map<std::string, double> conditions_of(const JsonObject& run) {
    std::map<std::string, double> conditions;
    if (!run.has("condition")) return conditions;
    if (!run.is_object("condition")) {
        run.add_problem("condition", "should be an object of numbers, such as {\"roll_deg\": -45}");
        return conditions;
    }
    const JsonObject stated = run.object("condition");
    for (const std::string& name : stated.keys()) {
        // Words and lists of values have no order that a number could follow.
        if (stated.is_number(name.c_str())) {
            conditions[name] = stated.number(name.c_str());
        } else {
            stated.add_problem(name, "should be one number; give each state a number, such as 0 and 1");
        }
    }
    return conditions;
}

// `pretension_spread` becomes at least that of the run.
RecordedRun run_of(const JsonObject& json, const std::vector<std::string>& usually_driven,
                   double& pretension_spread) {
    RecordedRun run;
    run.number = json.integer("run");
    run.protocol = json.has("protocol") ? json.text("protocol")
                   : json.has("source") ? json.text("source")
                                        : "";
    run.session_start_s = json.optional_number("t_session_start").value_or(0.0);
    if (json.has("T0")) {
        const StatedNumber pretension_N = value_or_range(json, "T0");
        check_size(json, "T0", pretension_N.value, {1e-4, 1e6}, "N");
        run.pretension_N = pretension_N.value;
        pretension_spread = std::max(pretension_spread, pretension_N.spread);
    }
    run.output = output_of(json);
    run.conditions = conditions_of(json);
    run.driven = json.has("driven") ? json.texts("driven") : usually_driven;
    return run;
}

void check_driven(const JsonObject& json, const RecordedRun& run, const Recording& recording) {
    std::size_t known = 0;
    for (const std::string& channel : run.driven) {
        if (recording.channel(channel)) {
            ++known;
        } else {
            json.add_problem("driven",
                             fmt::format("names '{}', which is not among the channels in `units`", channel));
        }
    }
    if (known == 0)
        json.add_problem(
            "driven",
            "has none of the channels, but a model needs at least one input: name those that drive the "
            "bench in this run, for example \"driven\": [\"motor_angle\", \"load_torque\"]");
    if (known == recording.channels.size())
        json.add_problem("driven", "names every channel, so nothing is left to compare a model with");
}

BenchMode mode_of(const JsonObject& sidecar) {
    const std::string name = sidecar.text("mode");
    if (const auto mode = mode_named(name)) return *mode;
    if (!name.empty()) {
        std::vector<std::string> known;
        for (int mode = 0; mode <= static_cast<int>(BenchMode::capstan_band); ++mode)
            known.emplace_back(mode_name(static_cast<BenchMode>(mode)));
        sidecar.add_problem("mode", fmt::format("is '{}'{}", name, suggestion(name, known)));
    }
    return BenchMode::lumped_drive;
}

std::vector<RecordedRun> runs_of(const JsonObject& sidecar, const Recording& recording,
                                 const SampleTable& samples, double& pretension_spread,
                                 Assumptions& assumptions) {
    std::vector<RecordedRun> runs;
    const std::vector<std::string> usual = usual_driven_channels(recording.mode, recording.channels);
    if (sidecar.has("runs")) {
        bool any_driven_is_taken = false;
        for (const JsonObject& run : sidecar.objects("runs")) {
            RecordedRun read = run_of(run, usual, pretension_spread);
            if (std::ranges::count(runs, read.number, &RecordedRun::number) > 0)
                run.add_problem("run", fmt::format("is {}, as of an earlier run", read.number));
            runs.push_back(std::move(read));
            any_driven_is_taken |= !run.has("driven");
            check_driven(run, runs.back(), recording);
        }
        if (runs.empty()) sidecar.add_problem("runs", "lists no run");
        if (any_driven_is_taken)
            assumptions.add("driven", fmt::format("taken as {}, where a run does not state it",
                                                  fmt::join(usual, " and ")));
        return runs;
    }
    for (const int number : samples.run_numbers) {
        RecordedRun& run = runs.emplace_back();
        run.number = number;
        run.driven = usual;
        check_driven(sidecar, run, recording);
    }
    assumptions.add("runs", fmt::format("taken as the {} of the column run, driven by {}", runs.size(),
                                        fmt::join(usual, " and ")));
    return runs;
}

// A key that is nearly one of ours was probably meant to be it. Others are a laboratory's own notes.
void note_misspelled(const JsonObject& object, std::string_view section, Assumptions& assumptions) {
    std::vector<std::string> known;
    for (const RecordingKey& key : recording_keys()) {
        if (key.section == section) known.emplace_back(key.name);
    }
    for (const std::string& key : object.keys()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        if (const auto nearest = nearest_name(key, known);
            nearest && key.size() > 2 && !object.has(nearest->c_str()))
            assumptions.add_sentence(
                fmt::format("the key {} is not known and was not used; did you mean {}?", key, *nearest));
    }
}

}  // namespace

Recording read_sidecar(const nlohmann::json& json, const std::filesystem::path& path,
                       const SampleTable& samples, ProblemList& problems) {
    const JsonObject sidecar(json, path.string() + ": ", problems);
    Recording recording;
    Assumptions assumptions(path.filename().string(), recording.assumptions);
    recording.name = path.stem().string();
    recording.mode = mode_of(sidecar);
    note_misspelled(sidecar, "", assumptions);
    if (sidecar.has("sample_rate_hz")) {
        recording.sample_rate_Hz = sidecar.positive("sample_rate_hz");
    } else if (samples.period_s > 0.0) {
        recording.sample_rate_Hz = 1.0 / samples.period_s;
        assumptions.add("sample_rate_hz",
                        fmt::format("taken as {:.6g} Hz, from the times", recording.sample_rate_Hz));
    } else {
        sidecar.add_problem("sample_rate_hz", "is missing; a number is needed");
    }
    recording.channels = channels_of(sidecar, samples, assumptions);
    const bool geometry_known =
        recording.mode == BenchMode::pull_pull || recording.mode == BenchMode::single_cable;
    double length_m = 0.0;
    if (geometry_known) {
        const JsonObject nominal = sidecar.object("nominal");
        note_misspelled(nominal, "nominal", assumptions);
        recording.nominal = nominal_of(nominal, assumptions);
        length_m = capstan::length_m(recording.nominal->curvature);
    }
    if (geometry_known) recording.tension_sensors = sensors_of(sidecar, length_m);
    for (const TensionSensor& sensor : recording.tension_sensors) {
        if (!recording.channel(sensor.channel))
            sidecar.add_problem("tension_sensors",
                                fmt::format("'{}' is not among the channels in `units`", sensor.channel));
    }
    double pretension_spread = 0.0;
    recording.runs = runs_of(sidecar, recording, samples, pretension_spread, assumptions);
    if (recording.nominal) {
        recording.nominal->spread.pretension = pretension_spread;
        complete_pretensions(sidecar, recording, assumptions);
    }
    return recording;
}

}  // namespace capstan
