#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "capstan/gap_trial/trial_case.h"
#include "capstan/platform/files.h"
#include "capstan/recording/recording_keys.h"

namespace capstan::gap_trial {

namespace {

using nlohmann::ordered_json;

// As many digits as the instrument has.
int digits_of(const std::string& channel) {
    if (channel.ends_with("_torque")) return 5;
    return channel.ends_with("_angle") ? 6 : 3;
}

ordered_json nominal_json(const TrialBench& bench) {
    const NominalBench& nominal = bench.nominal;
    ordered_json profile = ordered_json::array();
    double reached_m = 0.0;
    for (const CurvaturePiece& piece : nominal.curvature) {
        profile.push_back(
            {{"s0", reached_m}, {"s1", reached_m + piece.length_m}, {"R", piece.bend_radius_m}});
        reached_m += piece.length_m;
    }
    ordered_json json = {{"L", bench.length_m()},
                         {"R_profile", profile},
                         {"r_input", nominal.motor_radius_m},
                         {"r_load", nominal.load_radius_m},
                         {"K", nominal.axial_stiffness_N / bench.length_m()},
                         {"mu_d", nominal.dynamic_friction},
                         {"mu_s", nominal.static_friction},
                         {"cable_mass_per_length", bench.cable_mass_kg_per_m}};
    if (bench.is_pair()) {
        json["rotor_inertia"] = nominal.rotor_inertia_kg_m2;
        json["load_pulley_inertia"] = nominal.load_pulley_inertia_kg_m2;
    }
    return json;
}

std::string_view mode_of(const TrialBench& bench) {
    const BenchMode mode = bench.is_drive()  ? BenchMode::lumped_drive
                           : bench.is_pair() ? BenchMode::pull_pull
                                             : BenchMode::single_cable;
    return mode_name(mode);
}

ordered_json bench_json(const std::string& name, const TrialBench& bench) {
    ordered_json units = {{"t", "s"}};
    for (const std::string& channel : bench.channels()) units[channel] = channel_unit(channel);
    ordered_json json = {{"case", name},
                         {"schema", 1},
                         {"mode", mode_of(bench)},
                         {"sample_rate_hz", bench.logged_rate_Hz},
                         {"units", units}};
    if (bench.is_drive()) {
        json["nominal"] = ordered_json::object();
        json["unknown"] = {"L", "R_profile", "r_input", "r_load", "K", "mu_d", "mu_s", "T0"};
        json["encoder_step"] = bench.encoder_step;
        return json;
    }
    json["nominal"] = nominal_json(bench);
    json["noise_std"] = bench.noise_std;
    json["encoder_step"] = bench.encoder_step;
    json["tension_sensors"] = ordered_json::array();
    for (const TensionSensor& sensor : bench.tension_sensors)
        json["tension_sensors"].push_back({{"channel", sensor.channel},
                                           {"cable", sensor.cable == CableName::b ? "B" : "A"},
                                           {"s", sensor.position_m}});
    return json;
}

ordered_json run_json(const TrialBench& bench, const TrialRun& run) {
    ordered_json json = {{"run", run.number},
                         {"protocol", run.protocol},
                         {"t_session_start", run.session_start_s},
                         {"duration", run.duration_s()}};
    if (!bench.is_drive()) {
        json["T0"] = run.pretension_N;
        json["output"] = run.output == OutputKind::locked ? "locked" : "handle";
    }
    if (!run.conditions.empty()) json["condition"] = run.conditions;
    json["driven"] = run.driven;
    return json;
}

std::string samples_csv(const TrialBench& bench, const std::vector<TrialRun>& runs,
                        const std::vector<SensedRun>& logged) {
    const std::vector<std::string> channels = bench.channels();
    std::string text = "run,t";
    for (const std::string& channel : channels) text += "," + channel;
    text += "\n";
    auto out = std::back_inserter(text);
    for (std::size_t run = 0; run < runs.size(); ++run) {
        for (std::size_t k = 0; k < logged[run].front().size(); ++k) {
            fmt::format_to(out, "{},{:.3f}", runs[run].number, static_cast<double>(k) / bench.logged_rate_Hz);
            for (std::size_t channel = 0; channel < channels.size(); ++channel)
                fmt::format_to(out, ",{:.{}f}", logged[run][channel][k], digits_of(channels[channel]));
            text += "\n";
        }
    }
    return text;
}

}  // namespace

void write_recording(const std::filesystem::path& folder, const std::string& name, const TrialBench& bench,
                     const std::vector<TrialRun>& runs, const std::vector<SensedRun>& logged) {
    write_file(folder / (name + ".csv"), samples_csv(bench, runs, logged));
    ordered_json sidecar = bench_json(name, bench);
    sidecar["runs"] = ordered_json::array();
    for (const TrialRun& run : runs) sidecar["runs"].push_back(run_json(bench, run));
    write_file(folder / (name + ".json"), sidecar.dump(2) + "\n");
}

}  // namespace capstan::gap_trial
