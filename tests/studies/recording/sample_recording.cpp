#include "sample_recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

namespace capstan::gap {

namespace {

constexpr double sample_rate_Hz = 100.0;
constexpr double run_s = 6.0;
enum ChannelIndex : std::size_t { motor_torque, motor_angle, load_angle, load_torque, tension };

RecordedRun empty_run(int number, double pretension_N, OutputKind output) {
    RecordedRun run;
    run.number = number;
    run.protocol = output == OutputKind::locked ? "ramp_locked" : "tunnel";
    run.session_start_s = (number - 1) * (run_s + 1.0);
    run.pretension_N = pretension_N;
    run.output = output;
    run.driven = {"motor_torque", "load_angle"};
    run.values.resize(5);
    for (int sample = 0; sample < run_s * sample_rate_Hz; ++sample)
        run.time_s.push_back(sample / sample_rate_Hz);
    return run;
}

double triangle(double phase) {
    return 2.0 / std::numbers::pi * std::asin(std::sin(2.0 * std::numbers::pi * phase));
}

}  // namespace

Recording driven_session() {
    Recording recording;
    recording.name = "bench";
    recording.mode = BenchMode::pull_pull;
    recording.sample_rate_Hz = sample_rate_Hz;
    recording.channels = {{"motor_torque", "N m", 0.0003, {}},
                          {"motor_angle", "rad", {}, 7.85e-4},
                          {"load_angle", "rad", {}, 1.57e-4},
                          {"load_torque", "N m", 0.01, {}},
                          {"tension_1", "N", 0.25, {}}};
    recording.tension_sensors = {{"tension_1", CableName::b, 1.0}};
    recording.nominal = NominalBench{{{0.5, straight}, {1.5, 0.6}}, 0.02, 0.1, 4000.0, 0.2, 0.4};
    recording.runs = {empty_run(1, 4.0, OutputKind::locked), empty_run(2, 6.0, OutputKind::handle)};
    for (const double time_s : recording.runs[0].time_s) {
        recording.runs[0].values[motor_torque].push_back(0.12 * triangle(0.35 * time_s));
        recording.runs[0].values[load_angle].push_back(0.0);
    }
    for (const double time_s : recording.runs[1].time_s) {
        const double angle = 0.3 * std::sin(2.0 * std::numbers::pi * 0.5 * time_s);
        recording.runs[1].values[load_angle].push_back(angle);
        recording.runs[1].values[motor_torque].push_back(-0.3 * angle);
    }
    return recording;
}

Recording measured_session(const std::vector<double>& parameters) {
    Recording recording = driven_session();
    std::mt19937_64 random(20260101);
    std::normal_distribution<double> normal;
    const auto twin = make_twin(recording);
    for (std::size_t index = 0; index < recording.runs.size(); ++index) {
        TwinRun truth = twin->run(index, parameters);
        for (const std::size_t channel : {motor_angle, load_torque, tension}) {
            const Channel& described = recording.channels[channel];
            for (double& value : truth.values[channel]) {
                if (described.noise_std) value += *described.noise_std * normal(random);
                if (described.step) value = *described.step * std::round(value / *described.step);
            }
            recording.runs[index].values[channel] = truth.values[channel];
        }
    }
    return recording;
}

RecordingFiles as_files(const Recording& recording) {
    std::ostringstream csv;
    csv.precision(10);
    csv << "run,t";
    for (const Channel& channel : recording.channels) csv << ',' << channel.name;
    csv << '\n';
    for (const RecordedRun& run : recording.runs) {
        for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
            csv << run.number << ',' << run.time_s[sample];
            for (const auto& channel : run.values) csv << ',' << channel[sample];
            csv << '\n';
        }
    }
    // The session of driven_session() as its laboratory would describe it.
    return {csv.str(), R"({
 "case": "bench", "mode": "pull_pull", "sample_rate_hz": 100,
 "units": {"t": "s", "motor_torque": "N m", "motor_angle": "rad", "load_angle": "rad", "load_torque": "N m",
           "tension_1": "N"},
 "nominal": {"L": 2.0, "R_profile": [{"s0": 0, "s1": 0.5}, {"s0": 0.5, "s1": 2.0, "R": 0.6}],
             "r_input": 0.02, "r_load": 0.1, "K": 2000.0, "mu_d": 0.2, "mu_s": 0.4},
 "noise_std": {"motor_torque": 0.0003, "load_torque": 0.01, "tension_1": 0.25},
 "encoder_step": {"motor_angle": 7.85e-4, "load_angle": 1.57e-4},
 "tension_sensors": [{"channel": "tension_1", "cable": "B", "s": 1.0}],
 "runs": [
  {"run": 1, "protocol": "ramp_locked", "t_session_start": 0.0, "T0": 4.0, "output": "locked",
   "driven": ["motor_torque", "load_angle"]},
  {"run": 2, "protocol": "tunnel", "t_session_start": 7.0, "T0": 6.0, "output": "handle",
   "driven": ["motor_torque", "load_angle"]}
 ]
})"};
}

TemporaryFolder::TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("capstan_") + test->name() + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(const RecordingFiles& files, const std::string& name) const {
    std::ofstream(path_ / (name + ".csv"), std::ios::binary) << files.samples_csv;
    std::ofstream(path_ / (name + ".json"), std::ios::binary) << files.sidecar_json;
    return path_ / (name + ".csv");
}

}  // namespace capstan::gap
