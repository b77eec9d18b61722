#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "capstan/cable/cable_cut.h"
#include "capstan/gap/next_experiment.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

constexpr double usual_turn_rad = 0.3;
constexpr double usual_torque_Nm = 0.05;
constexpr double more_pretension = 1.5;
constexpr double later_s = 900.0;
// Noise of a typical strain sensor, as a fraction of the pretension.
constexpr double usual_tension_noise = 0.005;

using Motion = std::function<double(double time_s)>;  // as a fraction of the amplitude

double triangle(double time_s, double period_s) {
    const double phase = std::fmod(time_s / period_s + 0.25, 1.0);
    return phase < 0.5 ? 4.0 * phase - 1.0 : 3.0 - 4.0 * phase;
}

double sine(double time_s, double frequency_Hz) {
    return std::sin(2.0 * std::numbers::pi * frequency_Hz * time_s);
}

// A new level every two seconds.
double steps(double time_s) {
    constexpr double levels[] = {0.5, 1.0, 0.5, 0.0, -0.5, -1.0, -0.5, 0.0};
    constexpr double rise_s = 0.2;
    constexpr double dwell_s = 2.0;
    const auto step = static_cast<std::size_t>(time_s / dwell_s);
    const double now = levels[step % std::size(levels)];
    const double before = step == 0 ? 0.0 : levels[(step - 1) % std::size(levels)];
    return std::lerp(before, now, std::min(1.0, (time_s - static_cast<double>(step) * dwell_s) / rise_s));
}

// Five seconds each at a slow, a medium and a fast sine.
double three_speeds(double time_s) {
    constexpr double each_s = 5.0;
    if (time_s < each_s) return sine(time_s, 0.2);
    return time_s < 2.0 * each_s ? sine(time_s, 0.6) : sine(time_s, 2.0);
}

// Largest departure of a channel from where a run begins.
double amplitude(const Recording& recording, const char* channel, double usual) {
    const auto index = recording.channel(channel);
    if (!index) return usual;
    double most = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& values = run.values[static_cast<std::size_t>(*index)];
        for (const double value : values) most = std::max(most, std::abs(value - values.front()));
    }
    constexpr double still = 0.05;
    return most > still * usual ? most : usual;
}

class Planner {
  public:
    explicit Planner(const Recording& recording)
        : recording_(recording),
          two_cables_(recording.mode == BenchMode::pull_pull),
          torque_driven_(recording.runs.front().drives(channel::motor_torque)),
          motor_amplitude_(torque_driven_ ? amplitude(recording, channel::motor_torque, usual_torque_Nm)
                                          : amplitude(recording, channel::motor_angle, usual_turn_rad)),
          load_amplitude_(amplitude(recording, channel::load_angle, usual_turn_rad)) {}

    std::vector<Experiment> all() {
        const std::string what = torque_driven_ ? "motor torque" : "motor angle";
        const auto slow = [](double t) { return triangle(t, 8.0); };
        const auto still = [](double) { return 0.0; };
        add("slow ramps", what + " up and down over 8 s, load locked", 16.0, slow, still);
        add("steps with dwells", what + " in eight steps, 2 s each, load locked", 16.0, steps, still);
        add("three speeds, load locked", what + " in sines of 0.2, 0.6 and 2 Hz, load locked", 15.0,
            three_speeds, still);
        if (two_cables_) {
            add(
                "moving hand, slow and fast", "load turned by hand at 0.2, 0.6 and 2 Hz, " + what + " held",
                15.0, [](double) { return 0.3; }, three_speeds);
            add("moving hand against ramps", "load turned by hand at 0.3 Hz while the " + what + " ramps",
                16.0, slow, [](double t) { return sine(t, 0.3); });
        }
        add("slow ramps, more pretension",
            fmt::format("{} up and down over 8 s at {} times the pretension", what, more_pretension), 16.0,
            slow, still);
        plans_.back().recording.runs.front().pretension_N =
            more_pretension * *plans_.back().recording.runs.front().pretension_N;
        add("slow ramps, later",
            fmt::format("{} up and down over 8 s, {:.0f} min later", what, later_s / 60.0), 16.0, slow,
            still);
        plans_.back().recording.runs.front().session_start_s += later_s;
        for (const CableName cable : {CableName::a, CableName::b}) {
            if (cable == CableName::b && !two_cables_) break;
            for (const double fraction : {0.05, 0.25, 0.5, 0.75, 0.95}) add_sensor(cable, fraction);
        }
        return plans_;
    }

  private:
    RecordedRun run_like(const RecordedRun& last) const {
        RecordedRun run;
        run.number = 1;
        run.session_start_s = last.session_start_s + last.time_s.back();
        run.pretension_N = last.pretension_N;
        run.driven = last.driven;
        return run;
    }

    void add(const std::string& name, const std::string& description, double duration_s, const Motion& motor,
             const Motion& load) {
        Experiment plan{"protocol", name, description, recording_};
        RecordedRun run = run_like(recording_.runs.back());
        run.protocol = name;
        const auto samples = static_cast<std::size_t>(duration_s * recording_.sample_rate_Hz);
        run.values.assign(recording_.channels.size(), std::vector<double>(samples, 0.0));
        bool hand_moves = false;
        for (std::size_t sample = 0; sample < samples; ++sample) {
            const double time_s = static_cast<double>(sample) / recording_.sample_rate_Hz;
            run.time_s.push_back(time_s);
            set(run, torque_driven_ ? channel::motor_torque : channel::motor_angle, sample,
                motor_amplitude_ * motor(time_s));
            set(run, channel::load_angle, sample, load_amplitude_ * load(time_s));
            hand_moves |= load(time_s) != 0.0;
        }
        run.output = hand_moves ? OutputKind::handle : OutputKind::locked;
        plan.recording.runs = {run};
        plans_.push_back(plan);
    }

    void set(RecordedRun& run, const std::string& channel, std::size_t sample, double value) const {
        if (run.drives(channel))
            run.values[static_cast<std::size_t>(*recording_.channel(channel))][sample] = value;
    }

    // The longest run again with one additional sensor.
    void add_sensor(CableName cable, double fraction) {
        const double length_m = capstan::length_m(recording_.nominal->curvature);
        const double position_m = fraction * length_m;
        constexpr double close_fraction = 0.08;
        for (const TensionSensor& sensor : recording_.tension_sensors) {
            if (sensor.cable == cable && std::abs(sensor.position_m - position_m) < close_fraction * length_m)
                return;
        }
        const char* letter = cable == CableName::a ? "A" : "B";
        Experiment plan{
            "sensor", fmt::format("tension sensor on cable {} at {:.2f} m", letter, position_m),
            fmt::format("the longest run again with a tension sensor on cable {}, {:.2f} m from the "
                        "motor",
                        letter, position_m),
            recording_};
        RecordedRun run = *std::max_element(
            recording_.runs.begin(), recording_.runs.end(),
            [](const RecordedRun& a, const RecordedRun& b) { return a.samples() < b.samples(); });
        const std::string channel = "proposed_tension";
        plan.recording.channels.push_back(
            {channel, "N", usual_tension_noise * run.pretension_N.value_or(1.0), std::nullopt});
        plan.recording.tension_sensors.push_back({channel, cable, position_m});
        run.values.emplace_back(static_cast<std::size_t>(run.samples()), 0.0);
        plan.recording.runs = {run};
        plans_.push_back(plan);
    }

    const Recording& recording_;
    bool two_cables_;
    bool torque_driven_;
    double motor_amplitude_;
    double load_amplitude_;
    std::vector<Experiment> plans_;
};

}  // namespace

std::vector<Experiment> possible_experiments(const Recording& recording) {
    return Planner(recording).all();
}

}  // namespace capstan::gap
