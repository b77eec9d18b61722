// The conduit of a study stated otherwise than by its pieces, and what it becomes.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "capstan/cable/cable_cut.h"
#include "capstan/centre_line/centre_line.h"
#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"
#include "capstan/recording/centre_line_file.h"

namespace capstan::config {

namespace {

// 95% of a normal distribution lie within this many standard deviations.
constexpr double deviations_of_95 = 1.959963984540054;

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

std::vector<KeyProblem> pieces_of_bends(StudyPlan& plan, const ConduitCourse& course, const KeyLines& lines) {
    if (!lines.contains("transmission.length_m"))
        return {{bend_section, "needs transmission.length_m, the length of the conduit"}};
    if (auto problems = problems_of(course.bends, course.length_m); !problems.empty())
        return in_section("transmission", std::move(problems));
    plan.transmission.cable.curvature = pieces_of(course.bends, course.length_m);
    return {};
}

// "arm.csv: 200 points with a noise of 1 mm; 1.200 m, wrap angle 2.570 +- 0.110 rad (95%); bends: ..."
std::string note_of(const ConduitCourse& course, const CentreLine& line, const MeasuredConduit& conduit) {
    std::string bends;
    for (std::size_t k = 0; k < conduit.pieces.size(); ++k) {
        const CurvaturePiece& piece = conduit.pieces[k];
        if (piece.bend_radius_m == straight) continue;
        bends += fmt::format("{}{:.1f} +- {:.1f} degrees", bends.empty() ? "" : ", ",
                             piece.length_m / piece.bend_radius_m / rad_per_degree,
                             deviations_of_95 * conduit.wrap_deviation_rad[k] / rad_per_degree);
    }
    return fmt::format(
        "{}: {} points with a noise of {:g} mm; {:.3f} m, wrap angle {:.3f} +- {:.3f} rad (95%){}{}",
        course.centre_line, line.points_m.size(), 1e3 * line.noise_m, length_m(conduit.pieces),
        conduit.wrap_rad, deviations_of_95 * conduit.total_deviation_rad,
        bends.empty() ? ", no bend" : "; bends: ", bends);
}

// So that bends which are drawn independently make the total angle as uncertain as it was measured.
double wrap_fraction_of(const MeasuredConduit& conduit) {
    double squares = 0.0;
    for (const CurvaturePiece& piece : conduit.pieces)
        squares += std::pow(piece.length_m / piece.bend_radius_m, 2);
    return std::expm1(deviations_of_95 * conduit.total_deviation_rad / std::sqrt(squares));
}

std::vector<KeyProblem> pieces_of_centre_line(StudyPlan& plan, const ConduitCourse& course,
                                              const KeyLines& lines,
                                              const std::optional<std::filesystem::path>& folder) {
    const std::string key = "transmission.centre_line";
    if (!lines.contains(key))
        return {{key + "_noise_m", "has a meaning only with centre_line; remove it, or name the file"}};
    if (!lines.contains(key + "_noise_m"))
        return {{key, "needs centre_line_noise_m, the standard deviation of each coordinate of its points"}};
    if (!folder) return {{key, "names a file, which only a configuration in a file of its own may do"}};
    std::vector<KeyProblem> problems;
    try {
        const CentreLine line{read_points(*folder / course.centre_line), course.centre_line_noise_m};
        for (const KeyProblem& problem : problems_of(line))
            problems.push_back({key, (*folder / course.centre_line).string() + ": " + problem.text()});
        if (!problems.empty()) return problems;
        const MeasuredConduit conduit = measured_conduit(line);
        plan.transmission.cable.curvature = conduit.pieces;
        plan.transmission.conduit_note = note_of(course, line, conduit);
        if (plan.uncertainty.is_stated && !lines.contains("uncertainty.wrap_fraction") &&
            conduit.wrap_rad > 0.0)
            plan.uncertainty.wrap_fraction = wrap_fraction_of(conduit);
    } catch (const InvalidInput& error) {
        for (const std::string& problem : error.problems()) problems.push_back({key, problem});
    }
    return problems;
}

}  // namespace

void add_conduit_keys(StudyKeys& keys) {
    keys.push_back(only_read(number(
        {"transmission", "length_m", "m",
         "Length of a conduit that is straight but for its [[transmission.bend]]s."},
        above_zero, {}, [](auto& plan, int) -> auto& { return plan.transmission.course.length_m; })));
    keys.push_back(only_read(string(
        {"transmission", "centre_line", "",
         "A CSV file with points along the conduit's centre line in order from the proximal end: columns x_m, y_m, z_m "
         "below a header, relative to this file's folder. It is smoothed into pieces of constant radius. Unless "
         "uncertainty.wrap_fraction is stated, the uncertainty of the angles becomes it."},
        {}, [](auto& plan, int) -> auto& { return plan.transmission.course.centre_line; })));
    keys.push_back(only_read(number(
        {"transmission", "centre_line_noise_m", "m",
         "Standard deviation of each coordinate of those points: it decides what is a bend and what is noise."},
        above_zero, {},
        [](auto& plan, int) -> auto& { return plan.transmission.course.centre_line_noise_m; })));
    StudyKey note = string(
        {"transmission", "conduit_note", "",
         "Where the pieces of the conduit come from; it changes nothing."},
        {}, [](auto& plan, int) -> auto& { return plan.transmission.conduit_note; });
    note.read = [](const StudyPlan& plan, int) {
        return plan.transmission.conduit_note.empty() ? ConfigValue{}
                                                      : ConfigValue{plan.transmission.conduit_note};
    };
    keys.push_back(std::move(note));
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

std::vector<KeyProblem> make_pieces(StudyPlan& plan, const KeyLines& lines,
                                    const std::optional<std::filesystem::path>& folder) {
    const ConduitCourse course = std::exchange(plan.transmission.course, {});
    const auto has = [&](const char* key) { return lines.contains(std::string("transmission.") + key); };
    const bool has_bends = has("bend") || has("length_m");
    const bool has_line = has("centre_line") || has("centre_line_noise_m");
    if (has("curvature") + has_bends + has_line > 1)
        return {
            {has_line      ? "transmission.centre_line"
             : has("bend") ? bend_section
                           : "transmission.length_m",
             "states the conduit beside other keys; state it by [[transmission.curvature]], by length_m and "
             "[[transmission.bend]], or by centre_line"}};
    if (has_bends) return pieces_of_bends(plan, course, lines);
    return has_line ? pieces_of_centre_line(plan, course, lines, folder) : std::vector<KeyProblem>{};
}

}  // namespace capstan::config
