#include <fmt/format.h>

#include <cmath>
#include <map>

#include "capstan/recording/json_object.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan {

namespace {

constexpr double length_tolerance_m = 1e-6;

const std::map<std::string, BenchMode> modes = {{"pull_pull", BenchMode::pull_pull},
                                                {"single_cable", BenchMode::single_cable},
                                                {"lumped_drive", BenchMode::lumped_drive},
                                                {"capstan_band", BenchMode::capstan_band}};

// R_profile as the lengths of its pieces; a piece without an R is straight.
std::vector<CurvaturePiece> curvature_of(const JsonObject& nominal) {
    const double length_m = nominal.positive("L");
    std::vector<CurvaturePiece> pieces;
    double reached_m = 0.0;
    for (const JsonObject& piece : nominal.objects("R_profile")) {
        const double from_m = piece.number("s0");
        const double to_m = piece.number("s1");
        if (std::abs(from_m - reached_m) > length_tolerance_m)
            piece.add_problem("s0",
                              fmt::format("is {} m, but the pieces before end at {} m", from_m, reached_m));
        if (to_m <= from_m) piece.add_problem("s1", "must lie beyond s0");
        pieces.push_back({to_m - from_m, piece.has("R") ? piece.positive("R") : straight});
        reached_m = to_m;
    }
    if (std::abs(reached_m - length_m) > length_tolerance_m)
        nominal.add_problem("R_profile", fmt::format("ends at {} m, but L is {} m", reached_m, length_m));
    return pieces;
}

NominalBench nominal_of(const JsonObject& nominal) {
    NominalBench bench;
    bench.curvature = curvature_of(nominal);
    bench.motor_radius_m = nominal.positive("r_input");
    bench.load_radius_m = nominal.positive("r_load");
    bench.axial_stiffness_N = nominal.positive("K") * nominal.positive("L");  // K: N/m of the complete cable
    bench.dynamic_friction = nominal.number("mu_d");
    bench.static_friction = nominal.number("mu_s");
    bench.rotor_inertia_kg_m2 = nominal.optional_number("rotor_inertia").value_or(0.0);
    bench.load_pulley_inertia_kg_m2 = nominal.optional_number("load_pulley_inertia").value_or(0.0);
    if (bench.dynamic_friction < 0.0) nominal.add_problem("mu_d", "must not be negative");
    if (bench.static_friction < bench.dynamic_friction)
        nominal.add_problem("mu_s",
                            "is below mu_d; static friction holds at least as much as dynamic friction");
    return bench;
}

std::string si_unit_of(const std::string& channel) {
    static const std::map<std::string, std::string> units = {
        {"t", "s"},
        {channel::motor_torque, "N m"},
        {channel::load_torque, "N m"},
        {channel::motor_angle, "rad"},
        {channel::load_angle, "rad"},
        {"displacement", "m"},
        {"velocity", "m/s"},
        {"friction_force", "N"},
    };
    const auto found = units.find(channel);
    if (found != units.end()) return found->second;
    return channel.starts_with("tension_") ? "N" : "";
}

std::vector<Channel> channels_of(const JsonObject& sidecar) {
    const JsonObject units = sidecar.object("units");
    std::vector<Channel> channels;
    const auto stated = [&](const char* list, const std::string& channel) -> std::optional<double> {
        if (!sidecar.has(list)) return std::nullopt;
        const JsonObject values = sidecar.object(list);
        if (!values.has(channel.c_str())) return std::nullopt;
        return values.positive(channel.c_str());
    };
    for (const std::string& name : units.keys()) {
        const std::string unit = units.text(name.c_str());
        const std::string wanted = si_unit_of(name);
        if (!wanted.empty() && unit != wanted)
            units.add_problem(name,
                              fmt::format("is '{}'; recordings are read in SI units: convert the column to "
                                          "'{}'",
                                          unit, wanted));
        if (name == "t") continue;
        Channel channel{name, unit, stated("noise_std", name), stated("encoder_step", name)};
        if (name.ends_with("_torque") && !channel.step) channel.step = sidecar.optional_number("torque_step");
        channels.push_back(channel);
    }
    return channels;
}

std::vector<TensionSensor> sensors_of(const JsonObject& sidecar, double length_m) {
    std::vector<TensionSensor> sensors;
    if (!sidecar.has("tension_sensors")) return sensors;
    for (const JsonObject& sensor : sidecar.objects("tension_sensors")) {
        const std::string cable = sensor.text("cable");
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

RecordedRun run_of(const JsonObject& json) {
    RecordedRun run;
    run.number = json.integer("run");
    run.protocol = json.has("protocol") ? json.text("protocol")
                   : json.has("source") ? json.text("source")
                                        : "";
    run.session_start_s = json.optional_number("t_session_start").value_or(0.0);
    if (json.has("T0")) run.pretension_N = json.positive("T0");
    run.output = output_of(json);
    run.driven = json.texts("driven");
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
    if (known == 0) json.add_problem("driven", "names no channel; a model needs at least one input");
    if (known == recording.channels.size())
        json.add_problem("driven", "names every channel, so nothing is left to compare a model with");
}

}  // namespace

Recording read_sidecar(const std::filesystem::path& path, ProblemList& problems) {
    const nlohmann::json json = read_json_file(path);
    const JsonObject sidecar(json, path.string() + ": ", problems);
    Recording recording;
    recording.name = path.stem().string();
    const std::string mode = sidecar.text("mode");
    if (const auto found = modes.find(mode); found != modes.end()) {
        recording.mode = found->second;
    } else {
        sidecar.add_problem("mode",
                            fmt::format("is '{}'; known are pull_pull, single_cable, lumped_drive and "
                                        "capstan_band",
                                        mode));
    }
    recording.sample_rate_Hz = sidecar.positive("sample_rate_hz");
    recording.channels = channels_of(sidecar);
    const bool geometry_known =
        recording.mode == BenchMode::pull_pull || recording.mode == BenchMode::single_cable;
    double length_m = 0.0;
    if (geometry_known) {
        const JsonObject nominal = sidecar.object("nominal");
        recording.nominal = nominal_of(nominal);
        for (const CurvaturePiece& piece : recording.nominal->curvature) length_m += piece.length_m;
    }
    recording.tension_sensors = sensors_of(sidecar, length_m);
    for (const TensionSensor& sensor : recording.tension_sensors) {
        if (!recording.channel(sensor.channel))
            sidecar.add_problem("tension_sensors",
                                fmt::format("'{}' is not among the channels in `units`", sensor.channel));
    }
    for (const JsonObject& run : sidecar.objects("runs")) {
        recording.runs.push_back(run_of(run));
        check_driven(run, recording.runs.back(), recording);
        if (geometry_known && !recording.runs.back().pretension_N) run.add_problem("T0", "is missing");
    }
    if (recording.runs.empty()) sidecar.add_problem("runs", "lists no run");
    return recording;
}

}  // namespace capstan
