#include <algorithm>
#include <cstdio>

#include "capstan/cable/cable_cut.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

namespace {

std::string number_words(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

}  // namespace

std::vector<KeyProblem> problems_of_worlds(const StudyPlan& plan) {
    std::vector<KeyProblem> problems;
    if (plan.repetitions < 20)
        problems.push_back({"repetitions", "is " + std::to_string(plan.repetitions) +
                                               ", but a study with [uncertainty] needs at least 20 worlds"});
    if (plan.motion.proximal.kind != EndKind::position)
        problems.push_back(
            {"motion.proximal.kind",
             "must be \"position\" with [uncertainty]: the estimator knows the motor's position"});
    if (plan.motion.distal.kind == EndKind::tension)
        problems.push_back(
            {"motion.distal.kind",
             "must be \"position\" or \"spring\" with [uncertainty]: a person moves the far end"});
    if (plan.transmission.arrangement == CableArrangement::pull_pull) {
        if (plan.motion.distal.kind != EndKind::position)
            problems.push_back(
                {"motion.distal.kind",
                 "must be \"position\" with arrangement = \"pull_pull\": the load pulley is moved"});
    }
    if (plan.uncertainty.members % 8 != 0)
        problems.push_back({"uncertainty.members", "is " + std::to_string(plan.uncertainty.members) +
                                                       ", but must be a multiple of 8"});
    const std::size_t recorded = plan.uncertainty.far_end_samples_m.size();
    if (plan.uncertainty.far_end == FarEndKind::recorded &&
        recorded <= static_cast<std::size_t>(std::max(plan.motion.samples, 0)))
        problems.push_back(
            {"uncertainty.far_end",
             "\"recorded\" needs more than the " + std::to_string(plan.motion.samples) +
                 " samples of [motion], and there are " + std::to_string(recorded) +
                 "; give far_end_log, a file beside this one, or --far-end LOG, or far_end_samples_m"});
    const double cable_m = length_m(plan.transmission.cable.curvature);
    const auto check_place = [&](double place_m, const std::string& key) {
        if (place_m > cable_m * (1.0 + 1e-9))
            problems.push_back({key, number_words(place_m) + " m is beyond the cable, which is " +
                                         number_words(cable_m) + " m long"});
    };
    for (std::size_t row = 0; row < plan.sensors.size(); ++row) {
        for (const double place_m : plan.sensors[row].places_m)
            check_place(place_m, "sensor[" + std::to_string(row + 1) + "].places_m");
        const SensorErrors& errors = plan.sensors[row].errors;
        if (errors.multiplicative_ratio == 0.0 && errors.additive == 0.0)
            problems.push_back(
                {"sensor[" + std::to_string(row + 1) + "]",
                 "has no noise; every sensor has some: give noise_ratio or noise_N (an encoder: noise_m)"});
    }
    for (const double place_m : plan.placement.required_m) check_place(place_m, "placement.required_m");
    if (plan.placement.forbidden_m.size() % 2 != 0)
        problems.push_back(
            {"placement.forbidden_m", "has an odd number of places; give from and to of each stretch"});
    return problems;
}

}  // namespace capstan
