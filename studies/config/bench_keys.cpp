// The key table of a bench: one row per key. Defaults have their home here, as in config_keys.cpp.

#include "capstan/bench/bench_plan.h"
#include "capstan/config/config_cable_keys.h"
#include "capstan/config/config_effect_keys.h"

namespace capstan::config {

namespace {

using bench::BenchPlan;
using bench::LoadKind;
using bench::MotorDrive;
using bench::Waveform;
using bench::WaveformKind;
using BenchKey = ConfigKey<BenchPlan>;
using BenchKeys = std::vector<BenchKey>;
using Holds = std::function<bool(const BenchPlan&)>;

BenchKey only_with(const Holds& holds, std::string words, BenchKey key) {
    key.condition = {[holds](const BenchPlan& plan, int) { return holds(plan); }, std::move(words)};
    return key;
}

constexpr auto bench_cable = [](auto& plan) -> auto& {
    return plan.cable;
};

void add_bench_keys(BenchKeys& keys) {
    BenchKey kind{"", "kind", {ValueKind::choice, ""}};
    kind.allowed.names = {"bench"};
    kind.presence = Presence::required;
    kind.help = "Kind of this file: a bench to simulate. The file of a study does not have this key.";
    kind.read = [](const BenchPlan&, int) -> ConfigValue { return std::string("bench"); };
    kind.write = [](BenchPlan&, int, const ConfigValue&) {};
    keys.push_back(std::move(kind));
    keys.push_back(string<BenchPlan>(
        {"", "name", "", "Name of the bench on its page."}, std::string("bench"),
        [](auto& plan, int) -> auto& { return plan.name; }));
    keys.push_back(number<BenchPlan>(
        {"", "sample_rate_Hz", "Hz", "Samples per second; each is one quasi-static step."}, above_zero, 200.0,
        [](auto& plan, int) -> auto& { return plan.sample_rate_Hz; }));
    keys.push_back(number<BenchPlan>(
        {"", "duration_s", "s", "Duration of the simulation, which starts at rest."}, above_zero, 12.0,
        [](auto& plan, int) -> auto& { return plan.duration_s; }));
    add_cable_keys<BenchPlan>(
        keys, "cable",
        {100, 4.0,
         "Number of equal segments of each of the two cables. Friction at rest depends on their "
         "length; above about 100 segments the result changes by less than 1%."},
        bench_cable);
    keys.push_back(number<BenchPlan>(
        {"pulleys", "motor_radius_m", "m", "Radius of the motor pulley."}, above_zero, 0.02,
        [](auto& plan, int) -> auto& { return plan.pulleys.motor_radius_m; }));
    keys.push_back(number<BenchPlan>(
        {"pulleys", "load_radius_m", "m", "Radius of the load pulley."}, above_zero, 0.104,
        [](auto& plan, int) -> auto& { return plan.pulleys.load_radius_m; }));
}

// ---- the waveform of an input

/// A waveform in one unit, and the condition under which that unit applies.
struct WaveText {
    std::string section;
    Waveform BenchPlan::*wave;
    std::string unit_in_names;  ///< the suffix of a key: Nm
    std::string unit;           ///< N m
    Holds holds;
    std::string words;   ///< input = "torque"
    double usual = 0.0;  ///< typical size of the input, for defaults
};

void add_waveform_kind(BenchKeys& keys, const std::string& section, Waveform BenchPlan::*wave,
                       const Holds& moves, const std::string& words) {
    BenchKey kind = choice<WaveformKind, BenchPlan>(
        {section, "waveform", "",
         "Shape over time: \"constant\", \"sines\" (a sum of sines), \"ramps\" (from zero, back and "
         "forth between plus and minus the amplitude, with dwells) or \"steps\" (one level after the "
         "other, repeated)."},
        {{"constant", WaveformKind::constant},
         {"sines", WaveformKind::sines},
         {"ramps", WaveformKind::ramps},
         {"steps", WaveformKind::steps}},
        std::string("ramps"), [wave](auto& plan, int) -> auto& { return (plan.*wave).kind; });
    keys.push_back(moves ? only_with(moves, words, std::move(kind)) : std::move(kind));
}

class WaveKeys {
  public:
    WaveKeys(BenchKeys& keys, const WaveText& about) : keys_(keys), about_(about) {}

    void add_number(WaveformKind kind, const std::string& name, const std::string& per,
                    const std::string& help, Limits limits, double default_value, double Waveform::*field) {
        add(kind, number<BenchPlan>(
                      text(name, per, help), limits, default_value,
                      [ wave = about_.wave, field ](auto& plan, int) -> auto& { return plan.*wave.*field; }));
    }
    void add_numbers(WaveformKind kind, const std::string& name, const std::string& help,
                     std::vector<double> default_value, std::vector<double> Waveform::*field) {
        add(kind, number_list<BenchPlan>(
                      text(name, "", help), {}, std::move(default_value),
                      [ wave = about_.wave, field ](auto& plan, int) -> auto& { return plan.*wave.*field; }));
    }

  private:
    KeyText text(const std::string& name, const std::string& per, const std::string& help) const {
        return {about_.section, name + "_" + about_.unit_in_names + (per.empty() ? "" : "_per_" + per),
                about_.unit + (per.empty() ? "" : "/" + per), help};
    }
    void add(WaveformKind kind, BenchKey key) {
        static const char* const names[] = {"constant", "sines", "ramps", "steps"};
        const Holds holds = [about = about_, kind](const BenchPlan& plan) {
            return about.holds(plan) && (plan.*about.wave).kind == kind;
        };
        keys_.push_back(only_with(
            holds, std::string("waveform = \"") + names[static_cast<int>(kind)] + "\" and " + about_.words,
            std::move(key)));
    }

    BenchKeys& keys_;
    WaveText about_;
};

// The values of a waveform, in its unit.
void add_waveform_values(BenchKeys& keys, const WaveText& about) {
    WaveKeys add(keys, about);
    add.add_number(WaveformKind::constant, "level", "", "The constant value.", {}, 0.0, &Waveform::level);
    add.add_numbers(WaveformKind::sines, "amplitudes", "Amplitude of each sine.", {about.usual},
                    &Waveform::amplitudes);
    add.add_number(WaveformKind::ramps, "amplitude", "",
                   "Amplitude at which the ramps reverse, in both directions.", above_zero, about.usual,
                   &Waveform::ramp_amplitude);
    add.add_number(WaveformKind::ramps, "slope", "s", "Slope of the ramps.", above_zero, 0.8 * about.usual,
                   &Waveform::slope_per_s);
    add.add_numbers(WaveformKind::steps, "levels", "The levels in their order.", {0.0, about.usual},
                    &Waveform::levels);
}

// Keys that are the same in every unit.
void add_waveform_times(BenchKeys& keys, const std::string& section, Waveform BenchPlan::*wave,
                        const Holds& moves) {
    const auto with = [&](WaveformKind kind, const std::string& words, BenchKey key) {
        keys.push_back(only_with(
            [wave, kind, moves](const BenchPlan& plan) {
                return (!moves || moves(plan)) && (plan.*wave).kind == kind;
            },
            words, std::move(key)));
    };
    with(WaveformKind::sines, "waveform = \"sines\"",
         number_list<BenchPlan>(
             {section, "frequencies_Hz", "Hz", "Frequency of each sine."}, zero_or_more,
             {0.25}, [wave](auto& plan, int) -> auto& { return (plan.*wave).frequency_Hz; }));
    with(WaveformKind::sines, "waveform = \"sines\"",
         number_list<BenchPlan>(
             {section, "phases_rad", "rad", "Phase of each sine at time 0."}, {},
             {0.0}, [wave](auto& plan, int) -> auto& { return (plan.*wave).phase_rad; }));
    with(WaveformKind::ramps, "waveform = \"ramps\"",
         number<BenchPlan>(
             {section, "dwell_s", "s", "Dwell at each end of a ramp."}, zero_or_more,
             0.5, [wave](auto& plan, int) -> auto& { return (plan.*wave).dwell_s; }));
    with(WaveformKind::steps, "waveform = \"steps\"",
         number<BenchPlan>(
             {section, "hold_s", "s", "Duration of each level."}, above_zero,
             1.0, [wave](auto& plan, int) -> auto& { return (plan.*wave).hold_s; }));
}

void add_motor_keys(BenchKeys& keys) {
    keys.push_back(choice<MotorDrive, BenchPlan>(
        {"motor", "input", "",
         "Prescribed quantity at the motor: \"torque\" or \"angle\"; positive reels cable A in. A "
         "torque cannot be prescribed at both pulleys, because the angles would be undetermined."},
        {{"torque", MotorDrive::torque}, {"angle", MotorDrive::angle}}, std::string("torque"),
        [](auto& plan, int) -> auto& { return plan.motor_drive; }));
    add_waveform_kind(keys, "motor", &BenchPlan::motor, {}, "");
    const auto drive = [](MotorDrive wanted) -> Holds {
        return [wanted](const BenchPlan& plan) { return plan.motor_drive == wanted; };
    };
    // The paper's ramps; 0.5 rad of the motor pulley are 10 mm of cable.
    add_waveform_values(keys, {"motor", &BenchPlan::motor, "Nm", "N m", drive(MotorDrive::torque),
                               "input = \"torque\"", 0.125});
    add_waveform_values(
        keys, {"motor", &BenchPlan::motor, "rad", "rad", drive(MotorDrive::angle), "input = \"angle\"", 0.5});
    add_waveform_times(keys, "motor", &BenchPlan::motor, {});
}

void add_load_keys(BenchKeys& keys) {
    keys.push_back(choice<LoadKind, BenchPlan>(
        {"load", "input", "",
         "What acts on the load pulley: \"locked\" holds it; \"handle\" prescribes its angle; "
         "\"torque\" prescribes the torque taken from the transmission (zero is a free load); "
         "\"spring\" connects it to a wall that may move."},
        {{"locked", LoadKind::locked},
         {"handle", LoadKind::handle},
         {"torque", LoadKind::torque},
         {"spring", LoadKind::spring}},
        std::string("locked"), [](auto& plan, int) -> auto& { return plan.load_kind; }));
    const Holds moves = [](const BenchPlan& plan) { return plan.load_kind != LoadKind::locked; };
    const Holds springs = [](const BenchPlan& plan) { return plan.load_kind == LoadKind::spring; };
    keys.push_back(
        only_with(springs, "input = \"spring\"",
                  required(number<BenchPlan>(
                      {"load", "stiffness_Nm_per_rad", "N m/rad", "Stiffness of the spring."}, above_zero, {},
                      [](auto& plan, int) -> auto& { return plan.load_stiffness_Nm_per_rad; }))));
    add_waveform_kind(keys, "load", &BenchPlan::load, moves, "input = \"handle\", \"torque\" or \"spring\"");
    add_waveform_values(keys, {"load", &BenchPlan::load, "rad", "rad",
                               [](const BenchPlan& plan) {
                                   return plan.load_kind == LoadKind::handle ||
                                          plan.load_kind == LoadKind::spring;
                               },
                               "input = \"handle\" or \"spring\" (its wall)", 0.35});
    add_waveform_values(keys, {"load", &BenchPlan::load, "Nm", "N m",
                               [](const BenchPlan& plan) { return plan.load_kind == LoadKind::torque; },
                               "input = \"torque\"", 0.2});
    add_waveform_times(keys, "load", &BenchPlan::load, moves);
}

bool every_effect(const Effect&) {
    return true;
}

std::vector<ConfigSection<BenchPlan>> bench_sections() {
    std::vector<ConfigSection<BenchPlan>> sections = {
        {"", "The bench."},
        {"cable", "Each of the two cables in its conduit."},
        // 2.86 rad of wrap, which reproduces the paper's Exp. 1.
        curvature_section<BenchPlan>("cable.curvature", bench_cable,
                                     [](BenchPlan& plan) {
                                         plan.cable.curvature = {{2.0, 0.70}};
                                     }),
        {"pulleys", "The two pulleys that both cables run on."},
        {"motor", "What moves the motor pulley."},
        {"load", "What acts on the load pulley."},
        {"effect",
         "Effects that the ideal model omits. While every effect is absent, as by default, the "
         "closed-form step simulates the bench; otherwise the slower simulation with effects does."},
    };
    add_effect_sections(sections, "effect", every_effect);
    return sections;
}

BenchKeys bench_keys() {
    BenchKeys keys;
    add_bench_keys(keys);
    add_motor_keys(keys);
    add_load_keys(keys);
    add_effect_keys(
        keys, "effect", every_effect, [](auto& plan) -> auto& { return plan.effects; });
    return keys;
}

std::vector<KeyProblem> complete_bench(BenchPlan& plan, const KeyLines& lines,
                                       const std::optional<std::filesystem::path>&) {
    complete_static_friction(plan.cable, "cable", lines);
    return {};
}

}  // namespace

template <>
const ConfigSchema<BenchPlan>& config_schema<BenchPlan>() {
    static const ConfigSchema<BenchPlan> schema{
        "A bench for capstan: two cables between a motor pulley and a load pulley, and their inputs. "
        "Every key is listed with its default, which applies where the key is left out. Check a file "
        "with `capstan config check FILE`, run it with `capstan simulate FILE`.",
        bench_sections(), bench_keys(), complete_bench};
    return schema;
}

}  // namespace capstan::config
