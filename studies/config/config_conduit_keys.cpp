// The conduit of a study stated otherwise than by its pieces, and what it becomes.
#include <utility>

#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

// The pieces that come of it are written out, so that a stored configuration needs nothing else.
StudyKey only_read(StudyKey key) {
    key.read = [](const StudyPlan&, int) { return ConfigValue{}; };
    return key;
}

const std::string bend_section = "transmission.bend";

StudyKey bend_number(KeyText about, Limits limits, double Bend::*field, double unit) {
    about.section = bend_section;
    StudyKey key = unbound_key<StudyPlan>(std::move(about), ValueKind::number, limits, {});
    key.write = [field, unit](StudyPlan& plan, int row, const ConfigValue& value) {
        plan.transmission.course.bends[static_cast<std::size_t>(row)].*field = unit * std::get<double>(value);
    };
    return only_read(required(std::move(key)));
}

std::vector<KeyProblem> in_section(const std::string& section, std::vector<KeyProblem> problems) {
    for (KeyProblem& problem : problems) problem.key = section + "." + problem.key;
    return problems;
}

}  // namespace

void add_conduit_keys(StudyKeys& keys) {
    keys.push_back(only_read(number(
        {"transmission", "length_m", "m",
         "Length of a conduit that is straight but for its [[transmission.bend]]s."},
        above_zero, {}, [](auto& plan, int) -> auto& { return plan.transmission.course.length_m; })));
    keys.push_back(bend_number(
        {"", "angle_deg", "degrees", "By how much the conduit turns; its length is angle times radius."},
        {0.0, false, 3600.0}, &Bend::angle_rad, rad_per_degree));
    keys.push_back(bend_number({"", "radius_m", "m", "Bend radius."}, above_zero, &Bend::radius_m, 1.0));
    keys.push_back(
        bend_number({"", "at_m", "m", "Where the bend begins, along the conduit from the proximal end."},
                    zero_or_more, &Bend::at_m, 1.0));
}

ConfigSection<StudyPlan> bend_section_of_conduit() {
    return {
        bend_section,
        "The bends of a conduit that is straight between them, in place of [[transmission.curvature]]; its length is "
        "transmission.length_m.",
        [](const StudyPlan& plan) { return static_cast<int>(plan.transmission.course.bends.size()); },
        [](StudyPlan& plan, int count) {
            plan.transmission.course.bends.assign(static_cast<std::size_t>(count), {});
        }};
}

std::vector<KeyProblem> make_pieces(StudyPlan& plan, const KeyLines& lines) {
    const ConduitCourse course = std::exchange(plan.transmission.course, {});
    const bool has_length = lines.contains("transmission.length_m");
    if (course.bends.empty() && !has_length) return {};
    const std::string stated = has_length ? "transmission.length_m" : bend_section;
    if (lines.contains("transmission.curvature"))
        return {
            {stated,
             "states the conduit beside [[transmission.curvature]]; state it in one way and remove the other"}};
    if (!has_length) return {{bend_section, "needs transmission.length_m, the length of the conduit"}};
    if (auto problems = problems_of(course.bends, course.length_m); !problems.empty())
        return in_section("transmission", std::move(problems));
    plan.transmission.cable.curvature = pieces_of(course.bends, course.length_m);
    return {};
}

}  // namespace capstan::config
