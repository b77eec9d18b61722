#include "capstan/recording/recording_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "capstan/platform/files.h"
#include "capstan/platform/statistics.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"

namespace capstan {

namespace {

using nlohmann::ordered_json;

// As the reader takes it.
ordered_json value_or_range(double value, double spread) {
    if (spread == 0.0) return value;
    const double factor = std::exp(two_sided_95 * spread);
    return {value / factor, value * factor};
}

ordered_json nominal_json(const NominalBench& bench) {
    double length_m = 0.0;
    ordered_json profile = ordered_json::array();
    for (const CurvaturePiece& piece : bench.curvature) {
        ordered_json entry = {{"s0", length_m}, {"s1", length_m + piece.length_m}};
        if (std::isfinite(piece.bend_radius_m)) entry["R"] = piece.bend_radius_m;
        profile.push_back(entry);
        length_m += piece.length_m;
    }
    ordered_json nominal = {{"L", length_m},
                            {"R_profile", profile},
                            {"r_input", bench.motor_radius_m},
                            {"r_load", bench.load_radius_m},
                            {"EA", value_or_range(bench.axial_stiffness_N, bench.spread.stiffness)},
                            {"mu_d", value_or_range(bench.dynamic_friction, bench.spread.friction)},
                            {"mu_s", bench.static_friction}};
    if (bench.rotor_inertia_kg_m2 > 0.0) nominal["rotor_inertia"] = bench.rotor_inertia_kg_m2;
    if (bench.load_pulley_inertia_kg_m2 > 0.0)
        nominal["load_pulley_inertia"] = bench.load_pulley_inertia_kg_m2;
    return nominal;
}

ordered_json run_json(const RecordedRun& run, const NominalSpread& spread) {
    ordered_json entry = {{"run", run.number}};
    if (!run.protocol.empty()) entry["protocol"] = run.protocol;
    if (run.session_start_s > 0.0) entry["t_session_start"] = run.session_start_s;
    if (run.pretension_N) entry["T0"] = value_or_range(*run.pretension_N, spread.pretension);
    if (run.output != OutputKind::unknown)
        entry["output"] = run.output == OutputKind::locked ? "locked" : "handle";
    if (!run.conditions.empty()) entry["condition"] = run.conditions;
    entry["driven"] = run.driven;
    return entry;
}

}  // namespace

std::string samples_csv(const Recording& recording) {
    std::string text = "run,t";
    for (const Channel& channel : recording.channels) text += "," + channel.name;
    text += "\n";
    auto out = std::back_inserter(text);
    for (const RecordedRun& run : recording.runs) {
        for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
            fmt::format_to(out, "{},{}", run.number, run.time_s[sample]);
            for (const std::vector<double>& channel : run.values)
                fmt::format_to(out, ",{:.9g}", channel[sample]);
            text += "\n";
        }
    }
    return text;
}

std::string sidecar_text(const Recording& recording) {
    ordered_json sidecar = {{"case", recording.name},
                            {"schema", 1},
                            {"mode", mode_name(recording.mode)},
                            {"sample_rate_hz", recording.sample_rate_Hz}};
    sidecar["units"] = {{"t", "s"}};
    for (const Channel& channel : recording.channels) sidecar["units"][channel.name] = channel.unit;
    if (recording.nominal) sidecar["nominal"] = nominal_json(*recording.nominal);
    for (const Channel& channel : recording.channels) {
        if (channel.noise_std && *channel.noise_std > 0.0)
            sidecar["noise_std"][channel.name] = *channel.noise_std;
        if (channel.step) sidecar["encoder_step"][channel.name] = *channel.step;
    }
    for (const TensionSensor& sensor : recording.tension_sensors)
        sidecar["tension_sensors"].push_back({{"channel", sensor.channel},
                                              {"cable", sensor.cable == CableName::b ? "B" : "A"},
                                              {"s", sensor.position_m}});
    for (const RecordedRun& run : recording.runs)
        sidecar["runs"].push_back(
            run_json(run, recording.nominal ? recording.nominal->spread : NominalSpread{}));
    return sidecar.dump(2) + "\n";
}

void write_recording(const std::filesystem::path& path, const Recording& recording) {
    const RecordingPaths paths = recording_paths(path);
    AtomicFile samples(paths.samples);
    AtomicFile sidecar(paths.sidecar);
    samples.append(samples_csv(recording));
    sidecar.append(sidecar_text(recording));
    samples.finish();
    sidecar.finish();
}

}  // namespace capstan
