#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

StudyKey fraction(std::string name, const std::string& what, double Uncertainty::*field) {
    return number(
        {"uncertainty", std::move(name), "", what}, {0.0, true, 5.0},
        Uncertainty{}.*field, [field](auto& plan, int) -> auto& { return plan.uncertainty.*field; });
}

SensorRow& sensor_of(StudyPlan& plan, int row) {
    return plan.sensors[static_cast<std::size_t>(row)];
}
const SensorRow& sensor_of(const StudyPlan& plan, int row) {
    return plan.sensors[static_cast<std::size_t>(row)];
}

KeyCondition<StudyPlan> of_kind(bool tension) {
    return {[tension](const StudyPlan& plan, int row) {
                return measures_tension(sensor_of(plan, row).kind) == tension;
            },
            tension ? "a kind that measures tension" : "kind = \"load_displacement\""};
}

StudyKey sensor_error(KeyText about, double SensorErrors::*field) {
    about.section = "sensor";
    return number(
        std::move(about), zero_or_more,
        0.0, [field](auto& plan, int row) -> auto& { return sensor_of(plan, row).errors.*field; });
}

const KeyCondition<StudyPlan> with_recorded_far_end{
    [](const StudyPlan& plan, int) {
        return plan.uncertainty.is_stated && plan.uncertainty.far_end == FarEndKind::recorded;
    },
    "far_end = \"recorded\""};

StudyKey only(StudyKey key, KeyCondition<StudyPlan> condition) {
    key.condition = std::move(condition);
    return key;
}

StudyKey list_of_places(KeyText about, std::vector<double> PlacementPlan::*field) {
    StudyKey key = number_list<StudyPlan>(
        std::move(about), zero_or_more,
        {}, [field](auto& plan, int) -> auto& { return plan.placement.*field; });
    key.allowed.may_be_empty = true;
    return only(std::move(key), with_worlds);
}

StudyKey known_effects() {
    StudyKey key{"uncertainty", "known_effects", {ValueKind::names}};
    key.help =
        "Effects of [truth] that the estimator knows, with the values stated there; of the others it knows nothing. Where "
        "it knows any, it takes static friction as dynamic friction.";
    key.allowed.names.assign(std::begin(estimator_effects), std::end(estimator_effects));
    key.default_value = std::vector<std::string>{};
    key.read = [](const StudyPlan& plan, int) -> ConfigValue { return plan.uncertainty.known_effects; };
    key.write = [](StudyPlan& plan, int, const ConfigValue& value) {
        plan.uncertainty.known_effects = std::get<std::vector<std::string>>(value);
    };
    return key;
}

void add_sensor_keys(StudyKeys& keys) {
    std::vector<Named<SensorKind>> kinds;
    for (const SensorKind kind : all_sensor_kinds) kinds.push_back({std::string(name_of(kind)), kind});
    keys.push_back(required(choice<SensorKind>(
        {"sensor", "kind", "",
         "What it measures: \"tension\" of the cable, anywhere along it; the tension at an end as \"motor_torque\" or "
         "\"load_torque\" shows it; \"load_displacement\", an encoder at the far end. Of a pull-pull pair a torque is the "
         "difference of both cables' tensions there, so that its noise_N is a torque over the pulley's radius."},
        kinds, {}, [](auto& plan, int row) -> auto& { return sensor_of(plan, row).kind; })));
    StudyKey places = number_list<StudyPlan>(
        {"sensor", "places_m", "m", "Where it fits, from the motor along the cable; empty: at every node."},
        zero_or_more, {}, [](auto& plan, int row) -> auto& { return sensor_of(plan, row).places_m; });
    places.allowed.may_be_empty = true;
    keys.push_back(only(std::move(places), {[](const StudyPlan& plan, int row) {
                                                return sensor_of(plan, row).kind == SensorKind::tension;
                                            },
                                            "kind = \"tension\""}));
    keys.push_back(only(
        choice<OfferedOn>(
            {"sensor", "cable", "",
             "On which cable of a pull-pull pair it can be had: \"A\", \"B\", or \"both\", on each of them."},
            {{"both", OfferedOn::both}, {"A", OfferedOn::cable_a}, {"B", OfferedOn::cable_b}},
            std::string("both"), [](auto& plan, int row) -> auto& { return sensor_of(plan, row).cable; }),
        {[](const StudyPlan& plan, int row) {
             return plan.transmission.arrangement == CableArrangement::pull_pull &&
                    sensor_of(plan, row).kind == SensorKind::tension;
         },
         "kind = \"tension\" and transmission.arrangement = \"pull_pull\""}));
    keys.push_back(
        sensor_error({"", "noise_ratio", "",
                      "Standard deviation of the part of each reading's error that is proportional to what "
                      "is measured."},
                     &SensorErrors::multiplicative_ratio));
    keys.push_back(
        only(sensor_error({"", "noise_N", "N", "Standard deviation of the rest of each reading's error."},
                          &SensorErrors::additive),
             of_kind(true)));
    keys.push_back(
        only(sensor_error({"", "noise_m", "m", "Standard deviation of the rest of each reading's error."},
                          &SensorErrors::additive),
             of_kind(false)));
    keys.push_back(
        only(sensor_error({"", "zero_N", "N", "Standard deviation of the sensor's zero, which stays."},
                          &SensorErrors::zero),
             of_kind(true)));
    keys.push_back(
        only(sensor_error({"", "zero_m", "m", "Standard deviation of the sensor's zero, which stays."},
                          &SensorErrors::zero),
             of_kind(false)));
    keys.push_back(sensor_error(
        {"", "gain_ratio", "", "Standard deviation of the sensor's gain about 1, which stays: 0.02 is 2 %."},
        &SensorErrors::gain_ratio));
    keys.push_back(number(
        {"sensor", "price", "", "Price of one, in any unit; [placement] budget has the same unit."},
        zero_or_more, 1.0, [](auto& plan, int row) -> auto& { return sensor_of(plan, row).price; }));
}

void add_search_keys(StudyKeys& keys) {
    const std::string at = "placement";
    const PlacementPlan standard;
    keys.push_back(only(
        choice<ComparedSets>(
            {at, "search", "",
             "Which sets of sensors are compared: the \"named\" ones of [layouts], each with every "
             "selection of the sensors of other kinds, or \"all\" sets. A \"greedy\" search adds the sensor that "
             "helps most, one after another, and proves how much better another set could be; of more than 200000 "
             "sets, \"all\" does the same."},
            {{"named", ComparedSets::named}, {"all", ComparedSets::all}, {"greedy", ComparedSets::greedy}},
            std::string("named"), [](auto& plan, int) -> auto& { return plan.placement.search; }),
        with_worlds));
    keys.push_back(
        list_of_places({at, "forbidden_m", "m",
                        "Stretches of the cable where no tension sensor fits: from, to, from, to, ..."},
                       &PlacementPlan::forbidden_m));
    keys.push_back(list_of_places({at, "required_m", "m", "Places that must carry a tension sensor."},
                                  &PlacementPlan::required_m));
    keys.push_back(
        only(number(
                 {at, "minimum_spacing_m", "m", "Minimum distance between tension sensors."}, zero_or_more,
                 0.0, [](auto& plan, int) -> auto& { return plan.placement.minimum_spacing_m; }),
             with_worlds));
    keys.push_back(
        only(number(
                 {at, "resolution_N", "N",
                  "Sets whose errors differ by less than this are not distinguished by more worlds."},
                 above_zero, standard.resolution_N,
                 [](auto& plan, int) -> auto& { return plan.placement.resolution_N; }),
             with_worlds));
    keys.push_back(
        only(number(
                 {at, "target_error_N", "N", "The cheapest set with a lower error is named; 0: no target."},
                 zero_or_more, 0.0, [](auto& plan, int) -> auto& { return plan.placement.target_error_N; }),
             with_worlds));
}

}  // namespace

void add_uncertainty_keys(StudyKeys& keys) {
    const std::string at = "uncertainty";
    const Uncertainty standard;
    StudyKey drawn = boolean(
        {at, "draw_worlds", "",
         "Each repetition draws a cable, a motion of the far end and sensors of its own, a world, "
         "and simulates all of [motion] in it. It is true where this section is in the file."},
        false, [](auto& plan, int) -> auto& { return plan.uncertainty.is_stated; });
    drawn.default_value = std::monostate{};
    keys.push_back(std::move(drawn));
    StudyKeys own;
    own.push_back(choice<FactorDistribution>(
        {at, "distribution", "",
         "How the cables lie about the nominal values: \"normal\", 95 % within the fractions below, or \"uniform\", evenly "
         "within them."},
        {{"normal", FactorDistribution::normal}, {"uniform", FactorDistribution::uniform}},
        std::string("normal"), [](auto& plan, int) -> auto& { return plan.uncertainty.distribution; }));
    own.push_back(fraction("friction_fraction", "Uncertainty of both friction coefficients: 0.2 is 20 %.",
                           &Uncertainty::friction_fraction));
    own.push_back(fraction("wrap_fraction", "Uncertainty of the angle of each bend, on its own.",
                           &Uncertainty::wrap_fraction));
    own.push_back(fraction("stiffness_fraction", "Uncertainty of the axial stiffness.",
                           &Uncertainty::stiffness_fraction));
    own.push_back(
        fraction("pretension_fraction", "Uncertainty of the pretension.", &Uncertainty::pretension_fraction));
    own.push_back(choice<FarEndKind>(
        {at, "far_end", "",
         "What moves the far end (of a spring: its wall): \"random\", a new motion in each world with the range and "
         "bandwidth below, \"prescribed\", that of [motion.distal], or \"recorded\", in each world another stretch of a "
         "log. The estimator knows the range and bandwidth, not the motion."},
        {{"random", FarEndKind::random},
         {"prescribed", FarEndKind::prescribed},
         {"recorded", FarEndKind::recorded}},
        std::string("random"), [](auto& plan, int) -> auto& { return plan.uncertainty.far_end; }));
    own.push_back(only(
        string(
            {at, "far_end_log", "",
             "CSV file beside the configuration with the columns time_s and displacement_m. Range and bandwidth are then "
             "those of the log unless they are stated."},
            std::string(), [](auto& plan, int) -> auto& { return plan.uncertainty.far_end_log; }),
        with_recorded_far_end));
    StudyKey samples = number_list<StudyPlan>(
        {at, "far_end_samples_m", "m",
         "The samples of the log at motion.sample_rate_Hz; a stored study holds them, and then does not need the file."},
        {}, {}, [](auto& plan, int) -> auto& { return plan.uncertainty.far_end_samples_m; });
    samples.allowed.may_be_empty = true;
    own.push_back(only(std::move(samples), with_recorded_far_end));
    own.push_back(number(
        {at, "far_end_range_m", "m",
         "Range of that motion: 95 % of the time within plus and minus this. 0: the amplitude of "
         "[motion.distal]."},
        zero_or_more, 0.0, [](auto& plan, int) -> auto& { return plan.uncertainty.far_end_range_m; }));
    own.push_back(number(
        {at, "far_end_bandwidth_Hz", "Hz", "Bandwidth of that motion: 95 % of its power lies below."},
        above_zero, standard.far_end_bandwidth_Hz,
        [](auto& plan, int) -> auto& { return plan.uncertainty.far_end_bandwidth_Hz; }));
    own.push_back(number(
        {at, "truth_probability", "",
         "Probability that a world is as [truth] says; the others lie about the nominal cable."},
        {0.0, true, 1.0}, standard.truth_probability,
        [](auto& plan, int) -> auto& { return plan.uncertainty.truth_probability; }));
    own.push_back(known_effects());
    own.push_back(integer(
        {at, "members", "", "Cables in the estimator's ensemble, a multiple of 8."}, {16, true, 1024},
        std::int64_t{standard.members}, [](auto& plan, int) -> auto& { return plan.uncertainty.members; }));
    for (StudyKey& key : own) {
        if (!key.condition.holds) key.condition = with_worlds;
        keys.push_back(std::move(key));
    }
    add_sensor_keys(keys);
    add_search_keys(keys);
}

std::vector<ConfigSection<StudyPlan>> uncertainty_sections() {
    ConfigSection<StudyPlan> uncertainty{
        "uncertainty",
        "What is not known of the transmission that the sensors will be fitted to. With this section a study is "
        "over worlds: the estimator believes the nominal model and these uncertainties, and has what a device has: "
        "the motor's position, the sensors and its own last estimate. [[regime]] and [estimation] have no "
        "meaning then."};
    uncertainty.note_present = [](StudyPlan& plan) { plan.uncertainty.is_stated = true; };
    uncertainty.is_used = [](const StudyPlan& plan) { return plan.uncertainty.is_stated; };
    ConfigSection<StudyPlan> sensor{
        "sensor",
        "Sensors that can be bought, of studies with [uncertainty]. Without any: a tension sensor at every node, with "
        "the errors of the first [[noise]].",
        [](const StudyPlan& plan) { return static_cast<int>(plan.sensors.size()); },
        [](StudyPlan& plan, int count) { plan.sensors.assign(static_cast<std::size_t>(count), {}); }};
    sensor.is_used = uncertainty.is_used;
    return {std::move(uncertainty), std::move(sensor)};
}

}  // namespace capstan::config
