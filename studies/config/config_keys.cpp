// The key table of a study: one row per key. Defaults have their home here, and the reason for a default is
// in its help.

#include <numeric>

#include "capstan/config/config_cable_keys.h"
#include "capstan/config/config_study_keys.h"
#include "capstan/config/config_truth.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

// ---- keys before the first section

void add_study_keys(std::vector<StudyKey>& keys) {
    keys.push_back(string(
        {"", "name", "", "Name of the study in lists and reports."}, std::string("study"),
        [](auto& plan, int) -> auto& { return plan.name; }));
    keys.push_back(integer(
        {"", "seed", "", "Seed of all random numbers: the same seed gives the same bits."},
        {0, true, 9223372036854774784.0}, std::int64_t{1},
        [](auto& plan, int) -> auto& { return plan.seed; }));
    keys.push_back(integer(
        {"", "repetitions", "",
         "Number of sensor-noise draws per instant and noise level. Standard errors decrease with its "
         "square root; 2000 draws resolve differences of about 0.01 N."},
        {1, true, 1e7}, std::int64_t{2000}, [](auto& plan, int) -> auto& { return plan.repetitions; }));
    keys.push_back(boolean(
        {"", "compare_with_paper", "",
         "Show the paper's numbers beside ours. Valid only for the paper's own transmission, motion "
         "and instants."},
        false, [](auto& plan, int) -> auto& { return plan.compare_with_paper; }));
}

// ---- [transmission]

constexpr auto transmission_cable = [](auto& plan) -> auto& {
    return plan.transmission.cable;
};

bool same_rules(const ModelRules& a, const ModelRules& b) {
    return a.elongation == b.elongation && a.stiction == b.stiction && a.check == b.check;
}

void add_transmission_keys(std::vector<StudyKey>& keys) {
    const std::string at = "transmission";
    add_cable_keys<StudyPlan>(
        keys, at,
        {10, 10.0,
         "Number of segments of the cable. Nodes are their ends, numbered 1 (proximal, motor) "
         "to segments + 1 (distal, load). Sensors sit at nodes. Left out with [uncertainty]: the fewest whose friction "
         "keeps the discretisation error below a tenth of the stated errors, at most 63."},
        transmission_cable);
    StudyKey arrangement = choice<CableArrangement>(
        {at, "arrangement", "",
         "\"single\": one cable; \"pull_pull\": two such cables, A and B, between a motor pulley and a load pulley, of "
         "studies with [uncertainty]. Motions are then those of the ends of cable A, on the pulleys' rims; cable B "
         "moves by as much the other way. It is \"single\" if left out."},
        {{"single", CableArrangement::single}, {"pull_pull", CableArrangement::pull_pull}}, {},
        [](auto& plan, int) -> auto& { return plan.transmission.arrangement; });
    arrangement.read = [](const StudyPlan& plan, int) -> ConfigValue {
        if (plan.transmission.arrangement == CableArrangement::single) return {};
        return std::string("pull_pull");
    };
    keys.push_back(std::move(arrangement));
    StudyKey cut = choice<CableCut>(
        {at, "cut", "",
         "Where nodes lie: \"even\" cuts equal segments; \"at_bends\" puts nodes at both ends of every bend and at the "
         "places of the tension sensors, and spreads the others between them as evenly as possible; \"in_bends\" puts "
         "these others where the cable turns most between two nodes, as friction acts in bends alone. With "
         "[uncertainty] it is \"at_bends\", or \"in_bends\" where segments is left out too; else \"even\"."},
        {{"even", CableCut::even}, {"at_bends", CableCut::at_bends}, {"in_bends", CableCut::in_bends}}, {},
        [](auto& plan, int) -> auto& { return plan.transmission.cut; });
    keys.push_back(std::move(cut));
    add_conduit_keys(keys);
    keys.push_back(choice<ModelRules>(
        {at, "rules", "",
         "Interpretation of the model where the paper is silent or contradicts itself: \"consistent\" "
         "is our consistent interpretation, \"paper\" follows the paper literally."},
        {{"consistent", ModelRules::consistent()}, {"paper", ModelRules::paper()}}, std::string("consistent"),
        [](auto& plan, int) -> auto& { return plan.transmission.rules; }, same_rules));
}

// ---- [motion]

// Both ends have the same keys and differ only in their defaults.
struct EndText {
    std::string section;
    double default_amplitude_m;
    EndMotion TrueMotion::*end;
};

void add_end_keys(std::vector<StudyKey>& keys, const EndText& end) {
    const std::string& at = end.section;
    const auto motion = [member = end.end](auto& plan, int) -> auto& {
        return plan.motion.*member;
    };
    const auto kind = [member = end.end](const StudyPlan& plan) { return (plan.motion.*member).kind; };

    keys.push_back(choice<EndKind>(
        {at, "kind", "",
         "What is prescribed here: the cable's \"position\", its \"tension\", or a \"spring\" between "
         "the cable and a moving wall. A tension cannot be prescribed at both ends."},
        {{"position", EndKind::position}, {"tension", EndKind::tension}, {"spring", EndKind::spring}},
        std::string("position"), [motion](auto& plan, int row) -> auto& { return motion(plan, row).kind; }));

    const auto amplitude = [motion](auto& plan, int row) -> auto& {
        return motion(plan, row).amplitude;
    };
    StudyKey amplitude_m =
        number({at, "amplitude_m", "m",
                "Amplitude of the motion of the cable's end or of the spring's wall: rest + amplitude sin(2 "
                "pi frequency time + phase), positive towards the distal end. 0: blocked."},
               zero_or_more, end.default_amplitude_m, amplitude);
    amplitude_m.condition = {[kind](const StudyPlan& plan, int) { return kind(plan) != EndKind::tension; },
                             "kind = \"position\" or \"spring\""};
    keys.push_back(std::move(amplitude_m));

    StudyKey amplitude_N = number({at, "amplitude_N", "N", "Amplitude of the tension about the pretension."},
                                  zero_or_more, 0.0, amplitude);
    amplitude_N.condition = {[kind](const StudyPlan& plan, int) { return kind(plan) == EndKind::tension; },
                             "kind = \"tension\""};
    keys.push_back(std::move(amplitude_N));

    keys.push_back(number(
        {at, "frequency_Hz", "Hz", "Frequency of the motion."}, zero_or_more,
        1.0, [motion](auto& plan, int row) -> auto& { return motion(plan, row).frequency_Hz; }));
    keys.push_back(number(
        {at, "phase_rad", "rad", "Phase of the motion at time 0."}, {},
        0.0, [motion](auto& plan, int row) -> auto& { return motion(plan, row).phase_rad; }));
    keys.push_back(number(
        {at, "start_s", "s", "Start of the motion; the end is at rest before."}, zero_or_more,
        0.0, [motion](auto& plan, int row) -> auto& { return motion(plan, row).start_s; }));
    keys.push_back(number(
        {at, "stop_s", "s", "Stop of the motion; the end is at rest afterwards."}, above_zero,
        EndMotion{}.stop_s, [motion](auto& plan, int row) -> auto& { return motion(plan, row).stop_s; }));

    StudyKey stiffness = required(number(
        {at, "spring_stiffness_N_per_m", "N/m", "Stiffness of the spring."}, above_zero,
        {}, [motion](auto& plan, int row) -> auto& { return motion(plan, row).spring_stiffness_N_per_m; }));
    stiffness.condition = {[kind](const StudyPlan& plan, int) { return kind(plan) == EndKind::spring; },
                           "kind = \"spring\""};
    keys.push_back(std::move(stiffness));
}

void add_motion_keys(std::vector<StudyKey>& keys) {
    keys.push_back(number(
        {"motion", "sample_rate_Hz", "Hz",
         "Samples per second. Each sample is one quasi-static step; smaller steps follow the motion "
         "better."},
        above_zero, 100.0, [](auto& plan, int) -> auto& { return plan.motion.sample_rate_Hz; }));
    keys.push_back(integer(
        {"motion", "samples", "", "Number of simulated samples; sample 0 is the pretensioned cable at rest."},
        {1, true, 1e7}, std::int64_t{200}, [](auto& plan, int) -> auto& { return plan.motion.samples; }));
    add_end_keys(keys, {"motion.proximal", 0.01, &TrueMotion::proximal});
    add_end_keys(keys, {"motion.distal", 0.0, &TrueMotion::distal});
}

// ---- [[regime]], [[noise]]

void add_regime_keys(std::vector<StudyKey>& keys) {
    std::vector<Named<Regime>> regimes;
    for (const Regime regime : all_regimes) regimes.push_back({std::string(name_of(regime)), regime});
    keys.push_back(required(choice<Regime>(
        {"regime", "name", "",
         "Motion regime: the complete cable slides (mass), or nodes at the proximal end, the distal "
         "end or both ends move while others rest."},
        regimes, {}, [](auto& plan, int row) -> auto& { return plan.regimes[row].regime; })));

    StudyKey samples{"regime", "samples", {ValueKind::integers, "", {1, true, 1e7}}};
    samples.presence = Presence::required;
    samples.help =
        "Instants at which layouts are evaluated, as sample numbers of the motion; each must be in "
        "this regime. `capstan simulate CONFIG` shows the regime of each sample.";
    samples.read = [](const StudyPlan& plan, int row) -> ConfigValue {
        return std::vector<std::int64_t>(plan.regimes[row].samples.begin(), plan.regimes[row].samples.end());
    };
    samples.write = [](StudyPlan& plan, int row, const ConfigValue& value) {
        const auto& given = std::get<std::vector<std::int64_t>>(value);
        plan.regimes[row].samples.assign(given.begin(), given.end());
    };
    keys.push_back(std::move(samples));

    keys.push_back(required(number(
        {"regime", "duty_fraction", "",
         "Fraction of the working time in this regime, for the recommendation by duty cycle; "
         "the fractions of all regimes sum to 1."},
        {0, true, 1}, {}, [](auto& plan, int row) -> auto& { return plan.regimes[row].duty_fraction; })));
}

void add_noise_keys(std::vector<StudyKey>& keys) {
    keys.push_back(required(string(
        {"noise", "label", "", "Name of the noise level in tables and figures."}, {},
        [](auto& plan, int row) -> auto& { return plan.noise_levels[row].label; })));
    keys.push_back(number(
        {"noise", "multiplicative_ratio", "",
         "Standard deviation of the part of a reading's error that is proportional to the tension: "
         "0.1 is 10 %."},
        zero_or_more, 0.0,
        [](auto& plan, int row) -> auto& { return plan.noise_levels[row].level.multiplicative_ratio; }));
    keys.push_back(number(
        {"noise", "additive_N", "N",
         "Standard deviation of the part of a reading's error that does not depend on the tension."},
        zero_or_more, 0.0,
        [](auto& plan, int row) -> auto& { return plan.noise_levels[row].level.additive_N; }));
    keys.push_back(number(
        {"noise", "bias_N", "N",
         "Standard deviation of each sensor's offset, drawn once per repetition and the same at every "
         "instant."},
        zero_or_more, 0.0, [](auto& plan, int row) -> auto& { return plan.noise_levels[row].level.bias_N; }));
    keys.push_back(number(
        {"noise", "quantisation_N", "N",
         "Resolution of the converter, to which readings are rounded; 0: none."},
        zero_or_more, 0.0,
        [](auto& plan, int row) -> auto& { return plan.noise_levels[row].level.quantisation_N; }));
    keys.push_back(number(
        {"noise", "range_N", "N",
         "The largest tension that the sensor can read. Estimators on the feasible curve know that a "
         "reading at the end of the range stands for any larger tension."},
        above_zero, NoiseLevel{}.range_N,
        [](auto& plan, int row) -> auto& { return plan.noise_levels[row].level.range_N; }));
}

std::vector<StudyKey> all_keys() {
    std::vector<StudyKey> keys;
    add_study_keys(keys);
    add_transmission_keys(keys);
    add_motion_keys(keys);
    add_regime_keys(keys);
    add_noise_keys(keys);
    add_layout_keys(keys);
    add_estimation_keys(keys);
    keys.push_back(number(
        {"recommendation", "worthwhile_gain_N", "N",
         "One more sensor must lower the error by at least this much to be recommended."},
        zero_or_more, default_worthwhile_gain_N,
        [](auto& plan, int) -> auto& { return plan.worthwhile_gain_N; }));
    add_placement_keys(keys);
    add_uncertainty_keys(keys);
    add_sensitivity_keys(keys);
    add_sweep_keys(keys);
    for (StudyKey& key : truth_keys()) keys.push_back(std::move(key));
    return keys;
}

std::vector<ConfigSection<StudyPlan>> all_sections() {
    std::vector<ConfigSection<StudyPlan>> sections = {
        {"", "The study."},
        {"transmission", "The cable in its conduit."},
        // The paper's: 2 m of conduit at its bend radius.
        curvature_section<StudyPlan>("transmission.curvature", transmission_cable,
                                     [](StudyPlan& plan) {
                                         plan.transmission.cable.curvature = {{2.0, 0.28}};
                                     }),
        bend_section_of_conduit(),
        {"motion", "The true motion, which the estimators infer from the sensors."},
        {"motion.proximal", "The proximal end, where the motor is."},
        {"motion.distal", "The distal end, where the load is."},
        {"regime", "Instants at which layouts are evaluated, by motion regime. Each regime may appear once.",
         [](const StudyPlan& plan) { return static_cast<int>(plan.regimes.size()); },
         [](StudyPlan& plan, int count) { plan.regimes.assign(count, {}); },
         // The paper's: samples 112 and 142 of its motion.
         [](StudyPlan& plan) {
             plan.regimes = {{Regime::mass, {112, 142}, 1.0}};
         }},
        {"noise",
         "Noise levels: reading = T (1 + multiplicative_ratio e1) + additive_N e2 + bias_N e3, all e "
         "standard normal, then rounded to quantisation_N and limited to range_N.",
         [](const StudyPlan& plan) { return static_cast<int>(plan.noise_levels.size()); },
         [](StudyPlan& plan, int count) { plan.noise_levels.assign(count, {}); },
         // The paper's.
         [](StudyPlan& plan) {
             plan.noise_levels = {{"10 %", {.multiplicative_ratio = 0.1}}};
         }},
        {"layouts",
         "Candidate layouts of the sensors. Give families with counts, explicit layouts, or both."},
        {"estimation", "How tensions are estimated from readings."},
        {"recommendation", "When an additional sensor is worthwhile."},
        {"placement",
         "Objective and constraints of `capstan place`, which searches all layouts. Regimes, noise "
         "and methods are those above; [layouts] is not used."},
        {"sensitivity",
         "Ranges of the uncertain parameters for `capstan sensitivity`, which finds those that would "
         "change the advice. Constraints and objective are those of [placement]."},
        {"sweep",
         "Many studies from one file: one for every combination of the values below. `capstan study "
         "plan` estimates the cost, `capstan study submit` runs them on a cluster."},
    };
    for (ConfigSection<StudyPlan>& section : truth_sections()) sections.push_back(std::move(section));
    const auto has_instants = [](const StudyPlan& plan) { return !plan.uncertainty.is_stated; };
    for (ConfigSection<StudyPlan>& section : sections) {
        if (section.path == "regime" || section.path == "estimation") section.is_used = has_instants;
    }
    // Before [placement], whose keys depend on it.
    const auto placement = std::find_if(sections.begin(), sections.end(),
                                        [](const auto& section) { return section.path == "placement"; });
    auto uncertainty = uncertainty_sections();
    sections.insert(placement, std::make_move_iterator(uncertainty.begin()),
                    std::make_move_iterator(uncertainty.end()));
    return sections;
}

// The default of transmission.segments with [uncertainty]; "all" numbers of sensors follow.
void cut_by_rule(StudyPlan& plan, const KeyLines& lines) {
    plan.transmission.cable.segments = default_segments(plan);
    if (lines.contains("layouts.counts")) return;
    plan.sensor_counts.resize(static_cast<std::size_t>(plan.transmission.cable.segments) + 1);
    std::iota(plan.sensor_counts.begin(), plan.sensor_counts.end(), 1);
}

std::vector<KeyProblem> complete_study(StudyPlan& plan, const KeyLines& lines,
                                       const std::optional<std::filesystem::path>& folder) {
    std::vector<KeyProblem> problems = make_pieces(plan, lines, folder);
    const bool by_rule = plan.uncertainty.is_stated && !lines.contains("transmission.segments");
    if (!lines.contains("transmission.cut"))
        plan.transmission.cut = by_rule                      ? CableCut::in_bends
                                : plan.uncertainty.is_stated ? CableCut::at_bends
                                                             : CableCut::even;
    complete_static_friction(plan.transmission.cable, "transmission", lines);
    if (by_rule && problems.empty()) cut_by_rule(plan, lines);
    place_nodes(plan);
    return problems;
}

}  // namespace

template <>
const ConfigSchema<StudyPlan>& config_schema<StudyPlan>() {
    static const ConfigSchema<StudyPlan> schema{
        "A study for capstan: where to put tension sensors in a cable-conduit transmission. Every "
        "key is listed with its default, which applies where the key is left out. Check a file with "
        "`capstan config check FILE`, run it with `capstan study run FILE`.",
        all_sections(), all_keys(), complete_study};
    return schema;
}

}  // namespace capstan::config
