#include "capstan/gap/effects_twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// Predictions are clamped to this size, so that a simulation that diverges only makes a bad fit.
constexpr double max_prediction = 1e3;

// E72. A stranded cable loses 1 to 10% of what it stores (its loss factor) at the 5 to 10 Hz of a hand's fast
// motion: 3% at 10 Hz. What gives in a drive of unknown geometry may be no cable.
constexpr double usual_cable_loss_s = 0.5e-3;

// A step takes 2 to 10 iterations. A bench that takes far more over a run has numbers that no bench has, and
// its simulation ends there.
constexpr int usual_iterations = 20;
constexpr int spare_iterations = 3000;

// The friction of a bench that can be built: a search may ask for a number that follows a condition far
// beyond it.
double buildable_friction(const NominalBench& bench, double friction_ratio) {
    constexpr double below = 0.99;  // against rounding
    return std::min(friction_ratio * bench.dynamic_friction,
                    below * largest_friction_exponent / wrap_rad(bench.curvature));
}

// How well the places of the cables' ends are known. What is left of the noise of recorded angles moves a
// drive without a description to and fro. A described bench is moved by what smoothing makes of an encoder's
// steps.
double end_error_m(const Recording& recording, const RecordedRun& run) {
    constexpr double of_smoothed_steps_m = 0.5e-6;
    const bool is_held = run.output == OutputKind::locked;
    if (!recording.nominal->is_equivalent) return is_held ? 0.0 : of_smoothed_steps_m;
    return is_held && !run.drives(channel::motor_angle) ? 0.0 : usual_end_error_m;
}

BenchDescription description_of(const Recording& recording, const RecordedRun& run,
                                const BenchNumbers& numbers, int segments) {
    const NominalBench& bench = *recording.nominal;
    const bool load_is_held = run.output == OutputKind::locked;
    const CableSpecification cable =
        cable_specification(numbers.routing(bench.curvature),
                            {.dynamic_friction = buildable_friction(bench, numbers.friction_ratio),
                             .axial_stiffness_N = numbers.stiffness_ratio * bench.axial_stiffness_N,
                             .pretension_N = numbers.pretension_ratio * *run.pretension_N},
                            recording.mode == BenchMode::single_cable ? 2 * segments : segments);
    return {.cable = Cable(cable),
            .arrangement = recording.mode == BenchMode::pull_pull ? CableArrangement::pull_pull
                                                                  : CableArrangement::single,
            .pulleys = {bench.motor_radius_m, numbers.load_radius_ratio * bench.load_radius_m},
            .inertia = {bench.rotor_inertia_kg_m2, bench.load_pulley_inertia_kg_m2},
            .zeros = {numbers.zero_of(channel::motor_torque), numbers.zero_of(channel::load_torque)},
            .ends = {load_is_held, end_error_m(recording, run)},
            .cable_loss_s = bench.is_equivalent ? 0.0 : usual_cable_loss_s};
}

// Where nothing of the load but its motion is known.
bool holds_load_by_a_spring(const Recording& recording, const RecordedRun& run) {
    return recording.nominal->load_compliance_rad_per_Nm > 0.0 && !run.drives(channel::load_angle) &&
           !run.drives(channel::load_torque);
}

void check_driven(const Recording& recording) {
    if (recording.mode != BenchMode::pull_pull && recording.mode != BenchMode::single_cable)
        throw InvalidInput({recording.name +
                            ": the geometry of this bench is not known; effects can be distinguished on "
                            "pull_pull and single_cable benches"});
    for (const RecordedRun& run : recording.runs) {
        const bool motor = run.drives(channel::motor_angle) || run.drives(channel::motor_torque);
        const bool load = run.drives(channel::load_angle) || holds_load_by_a_spring(recording, run) ||
                          (run.drives(channel::load_torque) && run.drives(channel::motor_angle));
        if (!motor || (recording.mode == BenchMode::pull_pull && !load))
            throw InvalidInput(
                {recording.name + ": run " + std::to_string(run.number) +
                 ": the driven channels determine no motion; drive motor_torque or motor_angle, and load_angle"});
    }
}

// What drives a run, by its channels.
struct RunInputs {
    RunInputs(const Recording& recording, const RecordedRun& of_run, const DrivenInputs& driven)
        : run(of_run) {
        const auto values_of = [&](const char* channel) {
            return run.drives(channel) ? &driven.values[static_cast<std::size_t>(*recording.channel(channel))]
                                       : nullptr;
        };
        motor_angle = values_of(channel::motor_angle);
        motor_torque = values_of(channel::motor_torque);
        load_angle = values_of(channel::load_angle);
        load_torque = values_of(channel::load_torque);
        has_spring = holds_load_by_a_spring(recording, run);
        sample_rate_Hz = recording.sample_rate_Hz;
    }

    BenchInputs at(int sample, int step_samples) const {
        const auto k = static_cast<std::size_t>(sample);
        BenchInputs step{MotorAngle{0.0}, LoadAngle{0.0}, step_samples / sample_rate_Hz,
                         run.session_start_s + run.time_s[k]};
        if (motor_angle != nullptr) {
            step.motor = MotorAngle{(*motor_angle)[k]};
            step.motor_rad_per_s2 = acceleration(*motor_angle, sample, step_samples);
        } else {
            step.motor = MotorTorque{(*motor_torque)[k]};
        }
        if (load_angle != nullptr) {
            step.load = LoadAngle{(*load_angle)[k]};
            step.load_rad_per_s2 = acceleration(*load_angle, sample, step_samples);
        } else if (load_torque != nullptr) {
            step.load = LoadTorque{(*load_torque)[k]};
        } else if (has_spring) {
            step.load = LoadSpring{Backlash::contact_Nm_per_rad, 0.0};
        }
        return step;
    }

    // The central difference, at the ends of the run that of the nearest samples that have one.
    double acceleration(const std::vector<double>& angle_rad, int sample, int step_samples) const {
        const int last = static_cast<int>(angle_rad.size()) - 1;
        const int span = std::min(step_samples, last / 2);
        if (span == 0) return 0.0;
        const auto middle = angle_rad.begin() + std::clamp(sample, span, last - span);
        return (*(middle + span) - 2.0 * *middle + *(middle - span)) * std::pow(sample_rate_Hz / span, 2);
    }

    const RecordedRun& run;
    // Null where not driven.
    const std::vector<double>* motor_angle = nullptr;
    const std::vector<double>* motor_torque = nullptr;
    const std::vector<double>* load_angle = nullptr;
    const std::vector<double>* load_torque = nullptr;
    bool has_spring = false;
    double sample_rate_Hz = 0.0;
};

std::vector<int> all_samples(const RecordedRun& run) {
    std::vector<int> samples(static_cast<std::size_t>(run.samples()));
    std::iota(samples.begin(), samples.end(), 0);
    return samples;
}

}  // namespace

double BenchNumbers::Following::mean_change() const {
    double sum = 0.0;
    for (const auto& [run, change] : of_runs) sum += change;
    return sum / static_cast<double>(of_runs.size());
}

double BenchNumbers::Following::change_in(const RecordedRun& run) const {
    if (!of_runs.empty()) {
        const auto own = of_runs.find(run.number);
        return own != of_runs.end() ? own->second : mean_change();
    }
    const auto stated = run.conditions.find(condition);
    if (stated == run.conditions.end()) return 0.0;
    const double part = (stated->second - middle) / half_range;
    return part * (linear + part * squared);
}

void BenchNumbers::change(const Following& each, double by) {
    switch (each.what) {
        case Following::What::friction:
            friction_ratio *= std::exp(by);
            break;
        case Following::What::pretension:
            pretension_ratio *= std::exp(by);
            break;
        case Following::What::zero:
            sensor_faults[each.channel].offset += by;
            break;
    }
}

BenchNumbers BenchNumbers::in_run(const RecordedRun& run) const {
    BenchNumbers numbers = *this;
    numbers.follows.clear();
    for (const Following& each : follows) numbers.change(each, each.change_in(run));
    return numbers;
}

BenchNumbers BenchNumbers::in_other_runs() const {
    BenchNumbers numbers = *this;
    numbers.follows.clear();
    for (const Following& each : follows) {
        if (each.of_runs.empty())
            numbers.follows.push_back(each);
        else
            numbers.change(each, each.mean_change());
    }
    return numbers;
}

std::vector<CurvaturePiece> BenchNumbers::routing(const std::vector<CurvaturePiece>& described) const {
    if (bend_at_motor_ratio == 1.0 && bend_at_load_ratio == 1.0) return described;
    const double length_m = capstan::length_m(described);
    const double third_m = length_m / 3.0;
    const double middle_per_m =
        wrap_rad(described) / (third_m * (bend_at_motor_ratio + 1.0 + bend_at_load_ratio));
    return {{third_m, 1.0 / (bend_at_motor_ratio * middle_per_m)},
            {third_m, 1.0 / middle_per_m},
            {length_m - 2.0 * third_m, 1.0 / (bend_at_load_ratio * middle_per_m)}};
}

double BenchNumbers::zero_of(const std::string& channel) const {
    const auto fault = sensor_faults.find(channel);
    return fault == sensor_faults.end() ? 0.0 : fault->second.offset;
}

EffectsTwin::EffectsTwin(const Recording& recording, const EffectsTwinOptions& options)
    : recording_(recording), options_(options) {
    check_driven(recording);
    for (const RecordedRun& run : recording.runs) inputs_.push_back(driven_inputs(recording, run));
    find_stops();
}

EffectsTwin EffectsTwin::moved_by(std::vector<DrivenInputs> inputs) const {
    EffectsTwin twin = *this;
    twin.inputs_ = std::move(inputs);
    twin.find_stops();
    return twin;
}

int EffectsTwin::samples(std::size_t run) const {
    return (recording_.runs[run].samples() + options_.stride - 1) / options_.stride;
}

TwinRun EffectsTwin::run(std::size_t run_index, const BenchNumbers& numbers) const {
    const MovedBench of_run{run_index, numbers.in_run(recording_.runs[run_index])};
    return with_faults(run_index, run_each({&of_run, 1}).front(), of_run.numbers.sensor_faults);
}

std::vector<TwinRun> EffectsTwin::run_each(std::span<const MovedBench> moved) const {
    std::vector<BenchDescription> descriptions;
    std::vector<BenchEffects> effects;
    std::vector<TwinRun> twins(moved.size());
    const bool rings = std::any_of(moved.begin(), moved.end(),
                                   [](const MovedBench& bench) { return bench.numbers.rings(); });
    struct MovedRun {
        std::vector<Reader> readers;
        std::vector<int> stops;
        RunInputs inputs;
    };
    std::map<std::size_t, MovedRun> runs;
    std::vector<const MovedRun*> run_of;  // of each bench
    for (std::size_t bench = 0; bench < moved.size(); ++bench) {
        const auto& [run_index, numbers] = moved[bench];
        const RecordedRun& run = recording_.runs[run_index];
        descriptions.push_back(description_of(recording_, run, numbers, options_.segments));
        effects.push_back(numbers.effects);
        double& compliance = effects.back().of<EnvironmentCoupling>().compliance_rad_per_Nm;
        if (compliance == 0.0) compliance = recording_.nominal->load_compliance_rad_per_Nm;
        if (!runs.contains(run_index))
            runs.emplace(run_index, MovedRun{readers_of(run), rings ? all_samples(run) : stops_[run_index],
                                             RunInputs(recording_, run, inputs_[run_index])});
        run_of.push_back(&runs.at(run_index));
        twins[bench].values.resize(recording_.channels.size());
        for (const Reader& reader : run_of.back()->readers)
            twins[bench].values[reader.channel].reserve(static_cast<std::size_t>(samples(run_index)));
    }
    BenchSimulations benches(descriptions, effects);
    std::vector<BenchInputs> inputs(moved.size());
    std::array<long, bench_lanes> iterations{};
    long steps = 0;
    const std::size_t longest = std::max_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
                                    return a.second.stops.size() < b.second.stops.size();
                                })->second.stops.size();
    for (std::size_t stop = 0; stop < longest; ++stop) {
        for (std::size_t bench = 0; bench < moved.size(); ++bench) {
            const std::vector<int>& stops = run_of[bench]->stops;
            if (stop >= stops.size()) {
                benches.stop(static_cast<int>(bench));
            } else if (bench > 0 && run_of[bench] == run_of[bench - 1]) {
                inputs[bench] = inputs[bench - 1];
            } else {
                const int before = stop > 0 ? stops[stop - 1] : -(rings ? 1 : options_.stride);
                inputs[bench] = run_of[bench]->inputs.at(stops[stop], stops[stop] - before);
            }
        }
        const auto reports = benches.advance(inputs);
        ++steps;
        for (std::size_t bench = 0; bench < moved.size(); ++bench) {
            iterations[bench] += reports[bench].iterations;
            if (iterations[bench] > spare_iterations + usual_iterations * steps)
                benches.stop(static_cast<int>(bench));
        }
        for (std::size_t bench = 0; bench < moved.size(); ++bench) {
            const std::vector<int>& stops = run_of[bench]->stops;
            if (stop >= stops.size() || stops[stop] % options_.stride != 0) continue;
            if (!reports[bench].converged) ++twins[bench].unsolved_steps;
            if (options_.reports_sliding_fraction)
                twins[bench].sliding_fraction.push_back(
                    benches.cables().sliding_fraction(static_cast<int>(bench)));
            for (const Reader& reader : run_of[bench]->readers) {
                const double value = reader.read(benches, static_cast<int>(bench));
                twins[bench].values[reader.channel].push_back(
                    std::isfinite(value) ? std::clamp(value, -max_prediction, max_prediction)
                                         : max_prediction);
            }
        }
    }
    if (recording_.nominal_is_fitted) {
        for (std::size_t bench = 0; bench < moved.size(); ++bench)
            align_load_angle(moved[bench].run, twins[bench]);
    }
    return twins;
}

void EffectsTwin::find_stops() {
    stops_.clear();
    for (std::size_t run = 0; run < recording_.runs.size(); ++run) stops_.push_back(stops_of(run));
}

// Where a driven channel turns between two predicted samples, friction remembers how far it went. What lies
// within noise may be no turn.
std::vector<int> EffectsTwin::stops_of(std::size_t run_index) const {
    constexpr double clearly = 1.0;  // standard deviation; the inputs are smoothed
    const RecordedRun& run = recording_.runs[run_index];
    const int samples = run.samples();
    std::vector<int> stops;
    for (int sample = 0; sample < samples; sample += options_.stride) {
        stops.push_back(sample);
        const int next = sample + options_.stride;
        if (next >= samples) break;
        std::set<int> turns;
        for (std::size_t channel = 0; channel < recording_.channels.size(); ++channel) {
            if (!run.drives(recording_.channels[channel].name)) continue;
            const auto begin = inputs_[run_index].values[channel].begin();
            const auto [low, high] = std::minmax(begin[sample], begin[next]);
            const double noise = clearly * recording_.channels[channel].noise_std.value_or(0.0);
            const auto [lowest, highest] = std::minmax_element(begin + sample, begin + next + 1);
            if (*lowest < low - noise) turns.insert(static_cast<int>(lowest - begin));
            if (*highest > high + noise) turns.insert(static_cast<int>(highest - begin));
        }
        stops.insert(stops.end(), turns.begin(), turns.end());
    }
    return stops;
}

// The zero of the load angle is not known, so its mean is set to the measured one.
void EffectsTwin::align_load_angle(std::size_t run, TwinRun& twin) const {
    const auto channel = recording_.channel(channel::load_angle);
    if (!channel || twin.values[static_cast<std::size_t>(*channel)].empty()) return;
    std::vector<double>& predicted = twin.values[static_cast<std::size_t>(*channel)];
    const std::vector<double>& measured = recording_.runs[run].values[static_cast<std::size_t>(*channel)];
    double off = 0.0;
    for (std::size_t sample = 0; sample < predicted.size(); ++sample)
        off += measured[sample * static_cast<std::size_t>(options_.stride)] - predicted[sample];
    off /= static_cast<double>(predicted.size());
    for (double& value : predicted) value += off;
}

TwinRun EffectsTwin::with_faults(std::size_t run_index, const TwinRun& predicted,
                                 const std::map<std::string, SensorFaults>& faults) const {
    const RecordedRun& run = recording_.runs[run_index];
    TwinRun sensed_run = predicted;
    for (const auto& [channel, fault] : faults) {
        std::vector<double>& values =
            sensed_run.values[static_cast<std::size_t>(*recording_.channel(channel))];
        if (!values.empty())
            values = sensed(std::move(values), fault, options_.stride / recording_.sample_rate_Hz,
                            run.session_start_s + run.time_s.front());
    }
    return sensed_run;
}

// How each predicted channel is read off a bench.
std::vector<EffectsTwin::Reader> EffectsTwin::readers_of(const RecordedRun& run) const {
    std::vector<Reader> readers;
    for (std::size_t channel = 0; channel < recording_.channels.size(); ++channel) {
        const std::string& name = recording_.channels[channel].name;
        if (run.drives(name)) continue;
        const auto of_pulleys = [&](double (BenchPulleys::*value)() const) {
            readers.push_back({channel, [value](const BenchSimulations& benches, int bench) {
                                   return (benches.pulleys(bench).*value)();
                               }});
        };
        if (name == channel::motor_torque) of_pulleys(&BenchPulleys::motor_torque_Nm);
        if (name == channel::motor_angle) of_pulleys(&BenchPulleys::motor_angle_rad);
        if (name == channel::load_torque) of_pulleys(&BenchPulleys::load_torque_Nm);
        if (name == channel::load_angle &&
            (run.drives(channel::load_torque) || holds_load_by_a_spring(recording_, run)))
            of_pulleys(&BenchPulleys::load_angle_rad);
    }
    for (const TensionSensor& sensor : recording_.tension_sensors) {
        if (run.drives(sensor.channel)) continue;
        readers.push_back({static_cast<std::size_t>(*recording_.channel(sensor.channel)),
                           [cable = sensor.cable == CableName::a ? 0 : 1, at_m = sensor.position_m](
                               const BenchSimulations& benches, int bench) {
                               return benches.tension_at_N(bench, cable, at_m);
                           }});
    }
    return readers;
}

}  // namespace capstan::gap
